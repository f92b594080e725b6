#include "dreampm/play/model/save.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "dreampm/base/file.h"
#include "dreampm/error.h"
#include "dreampm/model/scene.h"

namespace dreampm::play {
namespace {

/// s
constexpr double longest_film = 600;

}  // namespace

void save_scene(const std::filesystem::path& file, const SavedAs& as, const Simulation& simulation,
                const Vec3d& gravity, const ToolSet& tools) {
  if (file.extension() != ".yaml") throw InputError(fmt::format("save: {} must end in .yaml", file.string()));
  if (!file.parent_path().empty()) make_folder(file.parent_path());
  check_replaceable(file);
  model::Scene now = simulation.scene().model();
  now.name = file.stem().string();
  now.output.folder = "out/" + now.name;
  now.gravity = gravity;
  now.bodies.clear();
  // Time goes on where it is.
  const int more = as.seconds ? static_cast<int>(std::lround(*as.seconds * now.time.fps)) : now.time.frames - 1;
  now.time.frames = simulation.frame() + std::max(more, 1);
  if (as.seen) {
    model::Camera& camera = now.render.camera;
    camera.fit_basin = false, camera.from = as.seen->from, camera.to = as.seen->to, camera.fov = as.seen->fov;
  }
  if (as.finer) {
    // The walls stay where they were rounded to.
    now.space.max = now.space.end();
    now.space.spacing /= 2;
    for (model::Emitter& emitter : now.emitters) emitter.pool *= 8;
  }
  std::filesystem::path moment = file;
  moment.replace_extension(".start.h5");
  for (const auto& tool : tools) tool->save(simulation, now);
  // Beside the scene, which is looked in first.
  now.start = moment.filename().string();
  if (as.finer)
    simulation.save_moment(moment, Scene(now, moment.string()));
  else
    simulation.save_moment(moment);
  replace_file_text(file, Scene(std::move(now), file.string()).yaml());
}

SavedAs finer_scene(const Action& action) {
  SavedAs as;
  as.finer = true, as.seconds = 2;
  if (action.words.size() > 1) as.seconds = action.number(1);
  if (!(*as.seconds > 0 && *as.seconds <= longest_film))
    throw InputError(fmt::format("{}: {} seconds; above 0 and up to {} work", action.verb, *as.seconds, longest_film));
  if (action.words.size() > 2) {
    const auto vector = [&](std::size_t at) {
      return Vec3d{action.number(at), action.number(at + 1), action.number(at + 2)};
    };
    as.seen = SavedAs::Seen{vector(2), vector(5), action.number(8)};
  }
  return as;
}

}  // namespace dreampm::play

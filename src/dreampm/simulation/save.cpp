// Writes a simulation as a scene that goes on from its moment.
#include <algorithm>

#include "dreampm/base/error.h"
#include "dreampm/base/file.h"
#include "dreampm/import/asset.h"
#include "dreampm/scene/emit.h"
#include "dreampm/scene/files.h"
#include "dreampm/scene/sections.h"
#include "dreampm/setup/start.h"
#include "dreampm/simulation/simulation_impl.h"

namespace dreampm {

void Simulation::save(const std::filesystem::path& file) const {
  if (file.extension() != ".yaml") fail_input("save: {} must end in .yaml", file.string());
  SceneDescription now = scene().description();
  now.name = file.stem().string();
  if (!scene::good_name(now.name))
    fail_input("save: {}: the scene's name, '{}', must be {}", file.string(), now.name, scene::good_name_rule);
  now.output.folder = "out/" + now.name;
  now.bodies.clear();
  now.start.clear();
  now.time.frames = std::max(now.time.frames, frame());
  scene::each_model(now, [](std::string& path) {
    if (!is_asset(path)) path = std::filesystem::absolute(path).string();
  });
  if (!file.parent_path().empty()) make_folder(file.parent_path());
  check_replaceable(file);
  std::filesystem::path moment = file;
  moment.replace_extension(".start.h5");
  impl_->settle();
  impl_->with_engine([&](auto& engine) {
    engine.download(MatterFields::all);
    const auto& world = engine.world();
    for (std::size_t f = now.fields.size(); f < world.fields.size(); ++f) {
      const std::string& name = world.fields[f].name;
      if (!scene::good_name(name))
        fail_input("save: the brush '{}' becomes a field of the scene, whose name must be {}", name,
                   scene::good_name_rule);
      now.fields.push_back({world.fields[f], {}});
    }
    // The motion that a program set is in the moment; a scene has no word for it.
    for (std::size_t c = 0; c < world.colliders.size(); ++c)
      if (!world.colliders[c].path) now.colliders.at(c).motion.reset();
    write_start(moment, world, engine.motion(), impl_->state.expected);
  });
  // Beside the scene, where it is looked for first.
  now.start = moment.filename().string();
  replace_file_text(file, scene::emit_scene(now));
}

}  // namespace dreampm

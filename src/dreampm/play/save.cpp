// Writes what the playground holds as a scene that `dreampm make` runs.
#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <numbers>

#include "dreampm/base/file.h"
#include "dreampm/error.h"
#include "dreampm/play/playground_impl.h"
#include "dreampm/scene/description.h"
#include "dreampm/simulation/frames.h"
#include "dreampm/simulation/simulation_impl.h"

namespace dreampm::play {
namespace {

/// Spacings.
constexpr double just_outside = 0.02;
/// s
constexpr double longest_film = 600;

Quaternion rotation_of(const Shape& shape) {
  const double angle = shape.rotate_angle * std::numbers::pi / 180;
  return angle == 0 ? Quaternion{} : Quaternion::about(normalized(shape.rotate_axis) * angle);
}

/// Stands where the body does now.
void place(Shape& shape, const Vec3d& middle, const Pose& pose) {
  const Quaternion turned = (pose.rotation * rotation_of(shape)).normalized();
  const Vec3d axis{turned.x, turned.y, turned.z};
  shape.center = pose(middle);
  shape.rotate_angle = 2 * std::atan2(length(axis), turned.w) * 180 / std::numbers::pi;
  shape.rotate_axis = length(axis) > 0 ? normalized(axis) : Vec3d{0, 1, 0};
}

/// Each particle becomes eight, in the middles of the eighths of the cube that it takes.
ParticleFrame finer(const ParticleFrame& coarse, const scene::Space& space) {
  ParticleFrame fine;
  const auto quarter = static_cast<float>(space.spacing / 4);
  // The eighths of one that lies at a wall stay before it.
  const double margin = just_outside * space.spacing;
  const Vec3d inside{margin, margin, margin};
  for (std::size_t i = 0; i < coarse.size(); ++i)
    for (int part = 0; part < 8; ++part) {
      const Vec3f off{part & 1 ? quarter : -quarter, part & 2 ? quarter : -quarter, part & 4 ? quarter : -quarter};
      const Vec3d at = static_cast<Vec3d>(coarse.position[i] + off);
      fine.position.push_back(static_cast<Vec3f>(max(space.min + inside, min(space.max - inside, at))));
      fine.velocity.push_back(coarse.velocity[i]);
      fine.material.push_back(coarse.material[i]);
    }
  return fine;
}

}  // namespace

void Playground::Impl::save(const std::filesystem::path& file, const SavedAs& as) {
  if (file.extension() != ".yaml") throw InputError(fmt::format("save: {} must end in .yaml", file.string()));
  if (!file.parent_path().empty()) make_folder(file.parent_path());
  check_replaceable(file);
  scene::SceneDescription now = simulation->scene().description();
  now.name = file.stem().string();
  now.output.folder = "out/" + now.name;
  now.gravity = {settings.gravity_x, settings.gravity_y, settings.gravity_z};
  now.bodies.clear();
  if (as.seconds) now.time.frames = static_cast<int>(std::lround(*as.seconds * now.time.fps)) + 1;
  if (as.seen) {
    scene::Camera& camera = now.render.camera;
    camera.fit_basin = false, camera.from = as.seen->from, camera.to = as.seen->to, camera.fov = as.seen->fov;
  }
  const ParticleFrame all = simulation->impl().with_engine([&](auto& engine) {
    engine.download(MatterFields::id | MatterFields::position | MatterFields::motion);
    ParticleFrame frame = particle_frame(engine.world(), engine.motion(), {}, {"velocity"}, {});
    if (as.finer) frame = finer(frame, now.space);
    // What contact leaves just inside of a surface a scene would refuse.
    for (const Collider& c : engine.world().colliders) {
      if (c.holds) continue;
      for (Vec3f& x : frame.position)
        if (const Vec3d at = static_cast<Vec3d>(x); c.distance(at) < 0)
          x = static_cast<Vec3f>(at + c.normal(at) * (just_outside * stage.scene.spacing() - c.distance(at)));
    }
    return frame;
  });
  if (as.finer) {
    now.space.spacing /= 2;
    for (scene::Emitter& emitter : now.emitters) emitter.pool *= 8;
  }
  for (std::size_t m = 0; m < now.materials.size(); ++m) {
    ParticleFrame own;
    own.material_names = {now.materials[m].name};
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (all.material[i] != m) continue;
      own.position.push_back(all.position[i]), own.velocity.push_back(all.velocity[i]);
      own.id.push_back(static_cast<std::int32_t>(own.id.size())), own.material.push_back(0);
    }
    if (own.position.empty()) continue;
    std::filesystem::path points = file;
    points.replace_filename(fmt::format("{}-{}.ply", now.name, now.materials[m].name));
    write_particles(points, own);
    scene::Body body;
    body.name = now.materials[m].name;
    body.material = static_cast<int>(m);
    body.shape.form = PointsShape{points.filename().string()};
    now.bodies.push_back(std::move(body));
  }
  for (scene::Collider& c : now.colliders) {
    if (!c.rigid) continue;
    const ColliderState state = simulation->collider(c.name);
    const Vec3d middle = simulation->impl().with_engine(
        [&](auto& engine) { return Simulation::Impl::collider(engine.world(), c.name).shape->bounds().center(); });
    place(c.shape, c.shape.center.value_or(middle), state.pose);
    c.rigid->velocity = state.twist.velocity, c.rigid->spin = state.twist.spin;
  }
  replace_file_text(file, Scene(std::move(now), file.string()).yaml());
  say(fmt::format("saved {}: run it with dreampm make", file.string()));
}

void Playground::Impl::render(const Action& action, bool goes_on) {
  if (options.program.empty()) throw InputError(action.verb + ": no command dreampm that could make a film is known");
  if (rendering && rendering->look().state == RenderStatus::State::running)
    throw InputError(action.verb + ": a film is under way; render off ends it");
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
  save(action.word(0), as);
  rendering.reset();
  rendering.emplace(options.program, action.word(0), goes_on);
}

}  // namespace dreampm::play

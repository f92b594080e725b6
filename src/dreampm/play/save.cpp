// Writes what the playground holds as a scene that `dreampm make` runs.
#include <fmt/format.h>

#include <algorithm>
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

}  // namespace

void Playground::Impl::save_wall(std::size_t side, scene::SceneDescription& scene) const {
  const auto named = [&](const std::string& name) {
    return std::find_if(scene.colliders.begin(), scene.colliders.end(), [&](const auto& c) { return c.name == name; });
  };
  const auto slab = named(wall_name(side));
  const std::string old = slab->name;
  const scene::Look look = scene.render.looks.at(old);
  scene.render.looks.erase(old);
  Box3d block{scene.space.min, scene.space.max};
  const int axis = static_cast<int>(side) / 2;
  (side % 2 ? block.min : block.max)[axis] = wall_at(side);
  if (!(block.size()[axis] > 0)) {
    scene.colliders.erase(slab);
    return;
  }
  int number = 1;
  const auto name = [&] { return fmt::format("moved-{}-{}", scene::wall_names.at(side), number); };
  while (named(name()) != scene.colliders.end()) ++number;
  slab->name = name();
  slab->shape.form = BoxShape{block.size()};
  slab->shape.center = block.center();
  scene.render.looks.emplace(slab->name, look);
}

void Playground::Impl::save(const std::filesystem::path& file) {
  if (file.extension() != ".yaml") throw InputError(fmt::format("save: {} must end in .yaml", file.string()));
  if (!file.parent_path().empty()) make_folder(file.parent_path());
  scene::SceneDescription now = simulation->scene().description();
  now.name = file.stem().string();
  now.output.folder = "out/" + now.name;
  now.gravity = {settings.gravity_x, settings.gravity_y, settings.gravity_z};
  now.bodies.clear();
  const ParticleFrame all = simulation->impl().with_engine([&](auto& engine) {
    engine.download(MatterFields::id | MatterFields::position | MatterFields::motion);
    ParticleFrame frame = particle_frame(engine.world(), engine.motion(), {}, {"velocity"}, {});
    // What contact leaves just inside of a surface a scene would refuse.
    for (const Collider& c : engine.world().colliders) {
      if (c.holds) continue;
      for (Vec3f& x : frame.position)
        if (const Vec3d at = static_cast<Vec3d>(x); c.distance(at) < 0)
          x = static_cast<Vec3f>(at + c.normal(at) * (just_outside * stage.scene.spacing() - c.distance(at)));
    }
    return frame;
  });
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
  for (std::size_t side = 0; side < 6; ++side)
    if (has_slab(side)) save_wall(side, now);
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

}  // namespace dreampm::play

#include "dreampm/setup/expected_speed.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace dreampm {
namespace {

/// The speed of free fall [m/s] from the highest point to the lowest floor along `gravity`.
double fall_speed(const Vec3d& gravity, const model::Scene& scene, const std::vector<Filling>& fillings) {
  const double g = length(gravity);
  if (g == 0) return 0;
  const Vec3d up = gravity / -g;
  double top = -1e30, bottom = 1e30;
  for (const Filling& f : fillings)
    for (const Vec3d& p : f.points) top = std::max(top, dot(p, up));
  const Vec3d end = scene.space.end();
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3d p{corner & 1 ? end.x : scene.space.min.x, corner & 2 ? end.y : scene.space.min.y,
                  corner & 4 ? end.z : scene.space.min.z};
    bottom = std::min(bottom, dot(p, up));
  }
  return std::sqrt(2 * g * std::max(0.0, top - bottom));
}

/// The part of the scene that the field acts in, and what of it matter comes from. A field's own
/// box may be entered at any side, and so may the space along periodic axes.
Passage passage_of(const model::ForceField& field, const model::Space& space, const Box3d& matter) {
  const Vec3d end = space.end();
  Passage p{matter, {space.min, end}, space.periodic};
  for (int a = 0; a < 3; ++a)
    if (p.endless[static_cast<std::size_t>(a)]) p.from.min[a] = space.min[a], p.from.max[a] = end[a];
  if (field.box) {
    p.within = {max(space.min, field.box->min), min(end, field.box->max)};
    p.from = p.within;
  }
  return p;
}

}  // namespace

ExpectedSpeed expected_speed(const model::Scene& scene, std::vector<Filling> fillings, const World<double>& world) {
  double thrown = 0, head = 0;
  for (const model::Body& b : scene.bodies) thrown = std::max(thrown, length(b.velocity));
  for (const Filling& f : fillings)
    for (const Vec3d& v : f.velocities) thrown = std::max(thrown, length(v));
  for (const Emitter& e : world.emitters) {
    const Box3d box = e.shape->bounds();
    thrown = std::max(thrown, e.fastest(0, std::numeric_limits<double>::infinity()));
    fillings.push_back({nullptr, {box.min, box.max}, {}, {}});
    if (e.path)
      for (const PoseKey& key : e.path->keys) {
        const Pose pose = e.path->pose_at(key.t);
        fillings.push_back({nullptr, {pose(box.min), pose(box.max)}, {}, {}});
      }
  }
  double fall = fall_speed(scene.gravity, scene, fillings);
  for (const Key<Vec3d>& k : scene.gravity_keys) fall = std::max(fall, fall_speed(k.value, scene, fillings));

  Box3d matter;
  for (const Filling& f : fillings)
    for (const Vec3d& p : f.points) matter.add(p);
  ExpectedSpeed out;
  const auto report = [&](const std::string& what, double speed) {
    if (speed > 0) out.sources += fmt::format("{} {} {:.3g} m/s", out.sources.empty() ? ":" : ",", what, speed);
  };
  report("fall", fall);
  for (const model::ForceField& f : scene.fields) {
    const Passage passage = passage_of(f, scene.space, matter);
    const double gives =
        passage.within.empty() ? 0 : std::visit([&](const auto& field) { return field.head(passage); }, make_field(f));
    report("field " + f.name, std::sqrt(2 * gives));
    head += gives;
  }
  double pushed = 0;
  for (const Collider& c : world.colliders)
    if (c.path || c.changing)
      pushed = std::max(pushed, c.fastest(world.domain(), 0, std::numeric_limits<double>::max()));
  report("bodies", thrown);
  report("colliders", pushed);
  if (head == 0 && pushed == 0) out.sources.clear();
  out.speed = (head > 0 ? std::sqrt(fall * fall + 2 * head) : fall) + std::max(thrown, pushed);
  return out;
}

}  // namespace dreampm

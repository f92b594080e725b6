#include "dreampm/setup/filling.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "dreampm/import/point_cloud.h"
#include "dreampm/setup/colliders.h"
#include "dreampm/setup/place.h"

namespace dreampm {
namespace {

/// The volume of a's points inside b.
double volume_in(const Filling& a, const Filling& b, const World<double>& world, double spacing) {
  if (!b.region) return 0;
  const Box3d bounds = b.region->bounds();
  std::vector<Vec3d> inside;
  for (const Vec3d& p : a.points)
    if (bounds.contains(p) && b.region->distance(p) < 0) inside.push_back(p);
  const std::vector<bool> cut = are_inside(inside, world, b.cut);
  return static_cast<double>(std::count(cut.begin(), cut.end(), false)) * spacing * spacing * spacing;
}

}  // namespace

Filling fill(const model::Body& body, const model::Scene& scene, const Meshes& meshes, const Sampling& sampling) {
  const double spacing = scene.space.spacing;
  if (const auto* cloud = std::get_if<PointsShape>(&body.shape.form)) {
    MovingCloud read = read_moving_cloud(cloud->path, cloud->scale);
    Filling f{nullptr, std::move(read.points), std::move(read.velocities), {}};
    if (body.shape.center || body.shape.rotate_angle != 0) {
      Box3d bounds;
      for (const Vec3d& p : f.points) bounds.add(p);
      const Vec3d axis = normalized(body.shape.rotate_axis), middle = bounds.center();
      const double angle = body.shape.rotate_angle * M_PI / 180, c = std::cos(angle), s = std::sin(angle);
      const auto turned = [&](const Vec3d& r) { return r * c + cross(axis, r) * s + axis * (dot(axis, r) * (1 - c)); };
      for (Vec3d& p : f.points) p = turned(p - middle) + body.shape.center.value_or(middle);
      for (Vec3d& v : f.velocities) v = turned(v);
    }
    return f;
  }
  Filling f{body_region(body.shape, spacing, sampling, meshes), {}, {}, {}};
  f.points = sample_region(*f.region, spacing, sampling.pattern, sampling.seed);
  return f;
}

std::optional<std::string> cut_out(Filling& filling, const model::Scene& scene, std::size_t b,
                                   const World<double>& world, const std::string& file) {
  const model::Body& body = scene.bodies[b];
  for (std::size_t c = 0; c < world.colliders.size(); ++c)
    if (std::find(body.cut.begin(), body.cut.end(), world.colliders[c].name) != body.cut.end())
      filling.cut.push_back(c);
  if (filling.cut.empty() || filling.points.empty()) return std::nullopt;
  const std::vector<bool> out = are_inside(filling.points, world, filling.cut);
  const auto keep_others = [&](std::vector<Vec3d>& list) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < list.size(); ++i)
      if (!out[i]) list[kept++] = list[i];
    list.resize(kept);
  };
  keep_others(filling.points);
  if (!filling.velocities.empty()) keep_others(filling.velocities);
  if (!filling.points.empty()) return std::nullopt;
  return fmt::format("{}: error: body {} lies wholly inside of what is cut out of it, {}", place(file, scene, body),
                     body.name, fmt::join(body.cut, " and "));
}

double common_volume(const Filling& a, const Filling& b, const World<double>& world, double spacing) {
  return std::max(volume_in(a, b, world, spacing), volume_in(b, a, world, spacing));
}

}  // namespace dreampm

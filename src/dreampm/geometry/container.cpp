#include "dreampm/geometry/container.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <queue>
#include <utility>

#include "dreampm/base/error.h"

namespace dreampm {
namespace {

using Op = BooleanShape::Op;
using Made = std::shared_ptr<const Region>;

/// All within a distance of a region.
class Grown final : public Region {
 public:
  Grown(Made of, double by) : of_(std::move(of)), by_(by) {}
  double distance(const Vec3d& p) const override { return of_->distance(p) - by_; }
  void distances(const PointColumns& points, double* to) const override {
    of_->distances(points, to);
    for (std::size_t i = 0; i < points.count; ++i) to[i] -= by_;
  }
  Vec3d normal(const Vec3d& p) const override { return of_->normal(p); }
  Box3d bounds() const override {
    Box3d box = of_->bounds();
    const Vec3d all{by_, by_, by_};
    box.min -= all, box.max += all;
    return box;
  }

 private:
  Made of_;
  double by_;
};

/// The solid of a container, with the space around it.
class Container final : public Region {
 public:
  Container(Made solid, PlacedHollow hollow) : solid_(std::move(solid)), hollow_(std::move(hollow)) {}
  double distance(const Vec3d& p) const override { return solid_->distance(p); }
  void distances(const PointColumns& points, double* to) const override { solid_->distances(points, to); }
  Vec3d normal(const Vec3d& p) const override { return solid_->normal(p); }
  Box3d bounds() const override { return solid_->bounds(); }
  const PlacedHollow& hollow() const { return hollow_; }

 private:
  Made solid_;
  PlacedHollow hollow_;
};

/// Returns the reach of the region along an axis [m], looking towards `sign`. Boxes are halved,
/// those that may reach farthest first. A distance is at most the true one, so that the ball about
/// a point inside is inside, and a box around a point that is farther outside than its corners
/// holds nothing. -1e30 where nothing is found.
double reach_along(const Region& region, const Box3d& bounds, int axis, double sign, double tolerance) {
  struct Piece {
    double most;
    Vec3d middle, half;
    bool operator<(const Piece& other) const { return most < other.most; }
  };
  constexpr double slack = 1.05;  // distances of meshes are sampled
  std::priority_queue<Piece> parts;
  const auto add = [&](const Vec3d& middle, const Vec3d& half) {
    parts.push({sign * middle[axis] + half[axis], middle, half});
  };
  double found = -1e30;
  Vec3d best{};
  const auto look = [&](const Vec3d& p, double d) {
    if (!(d < 0) || sign * p[axis] - d <= found) return false;
    found = sign * p[axis] - d, best = p;
    return true;
  };
  add(bounds.center(), bounds.size() * 0.5);
  while (!parts.empty() && parts.top().most > found + tolerance) {
    const Piece part = parts.top();
    parts.pop();
    const double d = region.distance(part.middle), corner = length(part.half);
    look(part.middle, d);
    if (d > slack * corner || corner < 0.5 * tolerance) continue;
    int longest = 0;
    for (int a = 1; a < 3; ++a)
      if (part.half[a] > part.half[longest]) longest = a;
    Vec3d half = part.half, step{};
    half[longest] *= 0.5;
    step[longest] = half[longest];
    add(part.middle - step, half);
    add(part.middle + step, half);
  }
  if (found == -1e30) return found;
  // From there it climbs to the very end, by steps that get shorter where none leads on.
  for (double step = tolerance; step > 1e-5 * tolerance;) {
    bool higher = false;
    for (int a = 0; a < 3; ++a)
      for (const double way : {-step, step}) {
        Vec3d p = best;
        p[a] += way;
        higher = look(p, region.distance(p)) || higher;
      }
    if (!higher) step *= 0.5;
  }
  return std::min(found, sign * (sign > 0 ? bounds.max : bounds.min)[axis]);
}

Made cuboid(const Box3d& box) {
  Shape shape;
  shape.form = BoxShape{box.size()};
  shape.center = box.center();
  return make_region(shape, 1, {});
}

/// The area [m^2] of the region's section at the upper side of the box.
double section(const Region& region, const Box3d& box, double voxel) {
  const Vec3d size = box.size();
  const double level = box.max.y,
               step = std::clamp(0.5 * voxel, std::max(size.x, size.z) / 2000, std::max(size.x, size.z) / 200);
  const auto nx = static_cast<int>(std::ceil(size.x / step)), nz = static_cast<int>(std::ceil(size.z / step));
  std::size_t inside = 0;
  // Parts that end flush with the plane are open there.
  const double flush = 1e-3 * step;
  for (int k = 0; k < nz; ++k)
    for (int i = 0; i < nx; ++i) {
      const Vec3d p{box.min.x + (i + 0.5) * size.x / nx, level, box.min.z + (k + 0.5) * size.z / nz};
      inside += region.distance(p) < flush;
    }
  return static_cast<double>(inside) * size.x / nx * size.z / nz;
}

/// The hollow the right way up.
Made turned(const ContainerShape& c, double voxel, const MeshRegions& meshes, double reach) {
  if (c.hollow.size() != 1) fail_input("a container wants one shape that is hollow");
  Made inner = make_region(c.hollow[0], voxel, meshes, reach);
  const Box3d bounds = inner->bounds();
  if (!is_finite(bounds.min) || !is_finite(bounds.max)) fail_input("the hollow of a container must end somewhere");
  const Vec3d up = normalized(c.up), axis = cross(up, Vec3d{0, 1, 0});
  Shape turn;
  if (up.y < 0 && length(axis) < 1e-12)
    turn.rotate_axis = {1, 0, 0}, turn.rotate_angle = 180;
  else if (length(axis) > 0)
    turn.rotate_axis = axis, turn.rotate_angle = std::atan2(length(axis), up.y) * 180 / std::numbers::pi;
  return placed(std::move(inner), turn, bounds.center());
}

}  // namespace

Box3d tight_bounds(const Region& region, double tolerance) {
  const Box3d bounds = region.bounds();
  if (bounds.empty()) return bounds;
  Box3d tight;
  const double same = 0.05 * tolerance;
  for (int a = 0; a < 3; ++a) {
    const double high = reach_along(region, bounds, a, 1, tolerance);
    if (high == -1e30) return {};
    tight.max[a] = high, tight.min[a] = -reach_along(region, bounds, a, -1, tolerance);
    if (bounds.max[a] - tight.max[a] <= same) tight.max[a] = bounds.max[a];
    if (tight.min[a] - bounds.min[a] <= same) tight.min[a] = bounds.min[a];
  }
  return tight;
}

ContainerParts container_parts(const ContainerShape& c, double voxel, const MeshRegions& meshes, double reach) {
  if (!(c.wall > 0) || !std::isfinite(c.wall))
    fail_input("the wall of a container is {}: a length above 0 m is wanted", c.wall);
  if (!is_finite(c.up) || length2(c.up) == 0) fail_input("`up` of a container wants a direction");
  if (!(voxel > 0) || !std::isfinite(voxel)) fail_input("a voxel of {} m: a length above 0 is wanted", voxel);
  const bool shell = c.form == ContainerShape::Form::shell;
  // The outer side of a shell must be known, and some of what lies beyond.
  const Made inner = turned(c, voxel, meshes, shell ? std::max(reach, c.wall + 3 * voxel) : reach);
  const Box3d inside = tight_bounds(*inner, 0.25 * voxel);
  if (inside.empty()) fail_input("the hollow of a container encloses nothing");
  const double height = inside.max.y - inside.min.y, cut = c.cut.value_or(default_cut * height);
  if (!(cut >= 0) || !(cut < height))
    fail_input("a cut of {:.4g} m leaves nothing of a hollow that is {:.4g} m high: give less", cut, height);
  Box3d open = inside;
  open.max.y -= cut;
  ContainerParts out;
  const Vec3d wall{c.wall, c.wall, c.wall};
  out.box = {open.min - wall, open.max + wall};
  out.box.max.y = open.max.y;
  const Vec3d size = out.box.size();
  out.mouth = section(*inner, open, voxel);
  constexpr double least_mouth = 1e-3;
  if (out.mouth < least_mouth * size.x * size.z)
    fail_input(
        "its opening is closed: {:.4g} m below its highest point the section of the hollow is {:.2g} m^2, less than a "
        "thousandth of the floor of {:.2g} m^2; give a larger `cut` (of {:.4g} m in all), or another `up`",
        cut, out.mouth, size.x * size.z, height);
  const double same = flush * voxel;
  out.hollow = combined(Op::intersection, {inner, cuboid(open)}, same);
  Made outer = cuboid(out.box);
  if (shell) outer = combined(Op::intersection, {std::make_shared<Grown>(inner, c.wall), std::move(outer)}, same);
  const Vec3d middle = out.box.center();
  out.solid = with_hollow(combined(Op::difference, {std::move(outer), inner}, same),
                          {out.hollow, {middle.x, out.box.max.y, middle.z}, {0, 1, 0}, out.mouth});
  return out;
}

const PlacedHollow* hollow_of(const Region& region) {
  const auto* container = dynamic_cast<const Container*>(&region);
  return container ? &container->hollow() : nullptr;
}

std::shared_ptr<const Region> with_hollow(std::shared_ptr<const Region> solid, PlacedHollow hollow) {
  return std::make_shared<Container>(std::move(solid), std::move(hollow));
}

}  // namespace dreampm

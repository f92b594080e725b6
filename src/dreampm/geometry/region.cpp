#include "dreampm/geometry/region.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>
#include <utility>

#include "dreampm/base/error.h"
#include "dreampm/base/parallel.h"
#include "dreampm/geometry/cell_fraction.h"
#include "dreampm/geometry/container.h"
#include "dreampm/math/mat3.h"

namespace dreampm {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

Box3d box_of(const Vec3d& low, const Vec3d& high) {
  Box3d box;
  box.min = low, box.max = high;
  return box;
}
bool finite(const Box3d& box) { return is_finite(box.min) && is_finite(box.max); }

/// Calls that the compiler makes vectors of.
template <class Distance>
void for_points(const PointColumns& points, double* to, const Distance& distance) {
  const double *const x = points.at[0], *const y = points.at[1], *const z = points.at[2];
  for (std::size_t i = 0; i < points.count; ++i) to[i] = distance(Vec3d{x[i], y[i], z[i]});
}
/// Calls body(points of a part, where it begins) for parts as long as `work_length`.
constexpr std::size_t work_length = 64;
template <class Body>
void for_parts(const PointColumns& points, const Body& body) {
  for (std::size_t begin = 0; begin < points.count; begin += work_length)
    body(PointColumns{{points.at[0] + begin, points.at[1] + begin, points.at[2] + begin},
                      std::min(work_length, points.count - begin)},
         begin);
}

class Ball final : public Region {
 public:
  explicit Ball(double radius) : radius_(radius) {}
  double distance(const Vec3d& p) const override { return length(p) - radius_; }
  void distances(const PointColumns& points, double* to) const override {
    for_points(points, to, [r = radius_](const Vec3d& p) { return length(p) - r; });
  }
  Vec3d normal(const Vec3d& p) const override { return length2(p) > 0 ? normalized(p) : Vec3d{0, 1, 0}; }
  Box3d bounds() const override { return box_of({-radius_, -radius_, -radius_}, {radius_, radius_, radius_}); }

 private:
  double radius_;
};

/// Region::normal's differences over this, on either side [m]: rounding and curvature both stay far
/// below what friction or the eye resolves.
constexpr double normal_step = 1e-6;
Vec3d unit_gradient(const Vec3d& g) { return length2(g) > 0 ? normalized(g) : Vec3d{0, 1, 0}; }

class Cuboid final : public Region {
 public:
  explicit Cuboid(const Vec3d& size) : half_(size * 0.5) {}
  double distance(const Vec3d& p) const override { return from(half_, p); }
  void distances(const PointColumns& points, double* to) const override {
    for_points(points, to, [half = half_](const Vec3d& p) { return from(half, p); });
  }
  /// Returns the normal, with the bits of Region::normal, which asks six times.
  Vec3d normal(const Vec3d& p) const override {
    constexpr double h = normal_step;
    const Vec3d q{std::abs(p.x) - half_.x, std::abs(p.y) - half_.y, std::abs(p.z) - half_.z};
    // The nearest face decides alone where it is nearer than all others by more than the step.
    const int a = q.x >= q.y && q.x >= q.z ? 0 : q.y >= q.z ? 1 : 2;
    const double others = std::max(q[(a + 1) % 3], q[(a + 2) % 3]), least = std::min(q[a], 0.0);
    const bool alone = others < least - 4 * h;
    Vec3d g;
    for (int k = 0; k < 3; ++k) {
      if (alone && k != a) continue;
      Vec3d step;
      step[k] = h;
      g[k] = Cuboid::distance(p + step) - Cuboid::distance(p - step);
    }
    return unit_gradient(g);
  }
  Box3d bounds() const override { return box_of(-half_, half_); }

 private:
  static double from(const Vec3d& half, const Vec3d& p) {
    const Vec3d q{std::abs(p.x) - half.x, std::abs(p.y) - half.y, std::abs(p.z) - half.z};
    const double inside = std::min(std::max(std::max(q.x, q.y), q.z), 0.0);
    return length(max(q, Vec3d{})) + inside;
  }
  Vec3d half_;
};

class Cylinder final : public Region {
 public:
  Cylinder(double radius, double height) : radius_(radius), half_(height * 0.5) {}
  double distance(const Vec3d& p) const override {
    const double side = std::sqrt(p.x * p.x + p.z * p.z) - radius_, end = std::abs(p.y) - half_;
    const double a = std::max(side, 0.0), b = std::max(end, 0.0);
    return std::sqrt(a * a + b * b) + std::min(std::max(side, end), 0.0);
  }
  Box3d bounds() const override { return box_of({-radius_, -half_, -radius_}, {radius_, half_, radius_}); }

 private:
  double radius_, half_;
};

class HalfSpace final : public Region {
 public:
  HalfSpace(const Vec3d& point, const Vec3d& normal) : point_(point), normal_(normalized(normal)) {}
  double distance(const Vec3d& p) const override { return dot(p - point_, normal_); }
  Vec3d normal(const Vec3d&) const override { return normal_; }
  Box3d bounds() const override { return box_of({-infinity, -infinity, -infinity}, {infinity, infinity, infinity}); }

 private:
  Vec3d point_, normal_;
};

/// x = R (y - from) + to for a point y of the part.
class Moved final : public Region {
 public:
  Moved(std::shared_ptr<const Region> part, const Mat3d& rotation, const Vec3d& from, const Vec3d& to)
      : part_(std::move(part)),
        rotation_(rotation),
        back_(transpose(rotation)),
        from_(from),
        to_(to),
        turned_(turns(rotation)) {}
  double distance(const Vec3d& p) const override { return part_->distance(local(p)); }
  void distances(const PointColumns& points, double* to) const override {
    for_parts(points, [&](const PointColumns& some, std::size_t begin) {
      std::array<double, work_length> x, y, z;
      for (std::size_t i = 0; i < some.count; ++i) {
        const Vec3d p = local({some.at[0][i], some.at[1][i], some.at[2][i]});
        x[i] = p.x, y[i] = p.y, z[i] = p.z;
      }
      part_->distances({{x.data(), y.data(), z.data()}, some.count}, to + begin);
    });
  }
  Vec3d normal(const Vec3d& p) const override { return rotation_ * part_->normal(local(p)); }
  Box3d bounds() const override {
    const Box3d box = part_->bounds();
    if (!finite(box) || box.empty()) return box;
    const Vec3d half = box.size() * 0.5, c = rotation_ * (box.center() - from_) + to_;
    Vec3d reach;
    for (int i = 0; i < 3; ++i)
      reach[i] =
          std::abs(rotation_(i, 0)) * half.x + std::abs(rotation_(i, 1)) * half.y + std::abs(rotation_(i, 2)) * half.z;
    return box_of(c - reach, c + reach);
  }

 private:
  static bool turns(const Mat3d& rotation) {
    const Mat3d none = Mat3d::identity();
    return !std::equal(std::begin(rotation.m), std::end(rotation.m), std::begin(none.m));
  }
  Vec3d local(const Vec3d& p) const { return turned_ ? back_ * (p - to_) + from_ : p - to_ + from_; }
  std::shared_ptr<const Region> part_;
  Mat3d rotation_, back_;
  Vec3d from_, to_;
  bool turned_;
};

void want_positive(double value, const char* what) {
  if (!(value > 0) || !std::isfinite(value)) fail_input("{} is {}: a length above 0 m is wanted", what, value);
}

struct MakeForm {
  double voxel;
  const MeshRegions& meshes;
  double reach;
  using Made = std::shared_ptr<const Region>;

  Made operator()(const BoxShape& s) const {
    for (int i = 0; i < 3; ++i) want_positive(s.size[i], "a side of a box");
    return std::make_shared<Cuboid>(s.size);
  }
  Made operator()(const SphereShape& s) const {
    want_positive(s.radius, "the radius of a sphere");
    return std::make_shared<Ball>(s.radius);
  }
  Made operator()(const CylinderShape& s) const {
    want_positive(s.radius, "the radius of a cylinder");
    want_positive(s.height, "the height of a cylinder");
    return std::make_shared<Cylinder>(s.radius, s.height);
  }
  Made operator()(const PlaneShape& s) const {
    if (!is_finite(s.normal) || !is_finite(s.point) || length2(s.normal) == 0)
      fail_input("a plane wants a point and a normal other than 0");
    return std::make_shared<HalfSpace>(s.point, s.normal);
  }
  Made operator()(const MeshShape& s) const {
    if (!meshes) fail_input("{}: this build has no meshes (it was made with DM_CORE_ONLY)", s.path);
    return meshes(s, voxel, reach);
  }
  Made operator()(const PointsShape& s) const {
    fail_input("{}: a point cloud encloses nothing; it can be a body, but neither a collider nor a part of one",
               s.path);
  }
  Made operator()(const BooleanShape& s) const {
    if (s.parts.empty()) fail_input("a union, difference or intersection wants at least one part");
    std::vector<Made> parts;
    for (const Shape& part : s.parts) parts.push_back(make_region(part, voxel, meshes, reach));
    return combined(s.op, std::move(parts), flush * voxel);
  }
  Made operator()(const ContainerShape& s) const { return container_parts(s, voxel, meshes, reach).solid; }
};

}  // namespace

Mat3d rotation_about(const Vec3d& axis, double degrees) {
  const Vec3d u = normalized(axis);
  double c = std::cos(degrees * std::numbers::pi / 180), s = std::sin(degrees * std::numbers::pi / 180);
  if (std::fmod(degrees, 90.0) == 0) c = std::round(c), s = std::round(s);
  const Mat3d skew{{0, -u.z, u.y, u.z, 0, -u.x, -u.y, u.x, 0}};
  return Mat3d::identity() * c + skew * s + outer(u, u) * (1 - c);
}

void Region::distances(const PointColumns& points, double* to) const {
  for (std::size_t i = 0; i < points.count; ++i) to[i] = distance({points.at[0][i], points.at[1][i], points.at[2][i]});
}

Vec3d Region::normal(const Vec3d& p) const {
  constexpr double h = normal_step;
  const Vec3d g{distance(p + Vec3d{h, 0, 0}) - distance(p - Vec3d{h, 0, 0}),
                distance(p + Vec3d{0, h, 0}) - distance(p - Vec3d{0, h, 0}),
                distance(p + Vec3d{0, 0, h}) - distance(p - Vec3d{0, 0, h})};
  return unit_gradient(g);
}

std::shared_ptr<const Region> placed(std::shared_ptr<const Region> form, const Shape& shape, const Vec3d& own) {
  if (shape.rotate_angle == 0 && !shape.center) return form;
  const Mat3d rotation =
      shape.rotate_angle == 0 ? Mat3d::identity() : rotation_about(shape.rotate_axis, shape.rotate_angle);
  const Vec3d to = shape.center.value_or(own);
  const auto moved = [&](std::shared_ptr<const Region> part) {
    return std::make_shared<Moved>(std::move(part), rotation, own, to);
  };
  if (const PlacedHollow* h = hollow_of(*form))
    return with_hollow(moved(form),
                       {moved(h->region), rotation * (h->mouth - own) + to, rotation * h->normal, h->area});
  return moved(std::move(form));
}

std::shared_ptr<const Region> make_region(const Shape& shape, double voxel, const MeshRegions& meshes, double reach) {
  auto form = std::visit(MakeForm{voxel, meshes, reach}, shape.form);
  if (!std::isfinite(shape.rotate_angle) || !is_finite(shape.rotate_axis) ||
      (shape.rotate_angle != 0 && length2(shape.rotate_axis) == 0))
    fail_input("a rotation wants a finite angle in degrees and an axis other than 0");
  if (shape.center && !is_finite(*shape.center)) fail_input("a center wants three finite numbers");
  Vec3d own;  // an unbounded union turns about the origin
  if (const auto* plane = std::get_if<PlaneShape>(&shape.form))
    own = plane->point;
  else if (const Box3d box = form->bounds(); finite(box) && !box.empty())
    own = box.center();
  return placed(std::move(form), shape, own);
}

double region_volume(const Region& region, double voxel) {
  if (!(voxel > 0) || !std::isfinite(voxel)) fail_input("a voxel of {} m: a length above 0 is wanted", voxel);
  const Box3d box = region.bounds();
  if (box.empty()) return 0;
  if (!finite(box)) fail_input("an unbounded shape has no volume");
  const Vec3d size = box.size();
  std::size_t n[3];
  for (int i = 0; i < 3; ++i) {
    const double count = std::ceil(size[i] / voxel);
    if (count > 1e5) fail_input("a voxel of {} m is too fine for a shape of {} m", voxel, size[i]);
    n[i] = static_cast<std::size_t>(count) + 2;  // the smoothing reaches half a cell out
  }
  const Vec3d low = box.center() - Vec3d{double(n[0]), double(n[1]), double(n[2])} * (0.5 * voxel);
  std::vector<double> slices(n[2]);
  parallel_for(n[2], 1, [&](std::size_t k) {
    double sum = 0;
    for (std::size_t j = 0; j < n[1]; ++j)
      for (std::size_t i = 0; i < n[0]; ++i) {
        const Vec3d p = low + Vec3d{double(i) + 0.5, double(j) + 0.5, double(k) + 0.5} * voxel;
        const double d = region.distance(p) / voxel;
        if (d < -0.9)  // half a cell's diagonal is 0.87
          sum += 1;
        else if (d < 0.9)
          sum += cell_fraction(d, region.normal(p));
      }
    slices[k] = sum;
  });
  double total = 0;
  for (const double s : slices) total += s;
  return total * voxel * voxel * voxel;
}

}  // namespace dreampm

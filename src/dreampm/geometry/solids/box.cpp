#include <algorithm>
#include <cmath>

#include "dreampm/geometry/solids/facets.h"
#include "dreampm/geometry/solids/region_parts.h"
#include "dreampm/geometry/solids/solid.h"

namespace dreampm {
namespace {

class BoxRegion final : public Region {
 public:
  explicit BoxRegion(const Vec3d& size) : half_(size * 0.5) {}
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
      g[k] = BoxRegion::distance(p + step) - BoxRegion::distance(p - step);
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

TriMesh box_mesh(const Vec3d& size) {
  TriMesh mesh;
  const Vec3d h = size * 0.5;
  for (int axis = 0; axis < 3; ++axis)
    for (const int sign : {-1, 1}) {
      const int u = (axis + 1) % 3, v = (axis + 2) % 3;
      std::vector<Vec3d> corners(4);
      for (std::size_t k = 0; k < 4; ++k) {
        corners[k][axis] = sign * h[axis];
        corners[k][u] = (k == 1 || k == 2 ? 1 : -1) * h[u];
        corners[k][v] = (k >= 2 ? 1 : -1) * h[v];
      }
      if (sign < 0) std::reverse(corners.begin(), corners.end());
      add_polygon(mesh, corners);
    }
  return mesh;
}

class Box final : public Solid {
 public:
  explicit Box(const BoxShape& form) : form_(form) {}
  std::shared_ptr<const Region> region() const override { return std::make_shared<BoxRegion>(form_.size); }
  double volume() const override { return form_.size.x * form_.size.y * form_.size.z; }
  TriMesh mesh() const override { return box_mesh(form_.size); }
  std::vector<Vec3d> corners() const override {
    std::vector<Vec3d> points;
    for (int n = 0; n < 8; ++n)
      points.push_back(form_.size * Vec3d{n & 4 ? 0.5 : -0.5, n & 2 ? 0.5 : -0.5, n & 1 ? 0.5 : -0.5});
    return points;
  }

 private:
  BoxShape form_;
};

}  // namespace

std::unique_ptr<const Solid> solid(const BoxShape& form) {
  for (int i = 0; i < 3; ++i) want_positive(form.size[i], "a side of a box");
  return std::make_unique<Box>(form);
}

}  // namespace dreampm

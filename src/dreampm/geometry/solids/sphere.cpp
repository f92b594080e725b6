#include <cmath>
#include <numbers>

#include "dreampm/geometry/solids/facets.h"
#include "dreampm/geometry/solids/region_parts.h"
#include "dreampm/geometry/solids/solid.h"

namespace dreampm {
namespace {

class SphereRegion final : public Region {
 public:
  explicit SphereRegion(double radius) : radius_(radius) {}
  double distance(const Vec3d& p) const override { return length(p) - radius_; }
  void distances(const PointColumns& points, double* to) const override {
    for_points(points, to, [r = radius_](const Vec3d& p) { return length(p) - r; });
  }
  Vec3d normal(const Vec3d& p) const override { return length2(p) > 0 ? normalized(p) : Vec3d{0, 1, 0}; }
  Box3d bounds() const override { return box_of({-radius_, -radius_, -radius_}, {radius_, radius_, radius_}); }

 private:
  double radius_;
};

TriMesh sphere_mesh(double radius) {
  constexpr std::uint32_t rows = around / 2;
  TriMesh mesh;
  for (std::uint32_t j = 0; j <= rows; ++j)
    for (std::uint32_t i = 0; i < around; ++i) {
      const double t = std::numbers::pi * j / rows;
      mesh.vertices.push_back(static_cast<Vec3f>((on_circle(i) * std::sin(t) + Vec3d{0, std::cos(t), 0}) * radius));
    }
  for (std::uint32_t j = 0; j < rows; ++j)
    for (std::uint32_t i = 0; i < around; ++i) {
      const std::uint32_t a = j * around + i, b = j * around + (i + 1) % around;
      if (j > 0) mesh.triangles.push_back({a, b + around, b});
      if (j + 1 < rows) mesh.triangles.push_back({a, a + around, b + around});
    }
  return mesh;
}

class Sphere final : public Solid {
 public:
  explicit Sphere(const SphereShape& form) : form_(form) {}
  std::shared_ptr<const Region> region() const override { return std::make_shared<SphereRegion>(form_.radius); }
  double volume() const override { return 4.0 / 3 * std::numbers::pi * form_.radius * form_.radius * form_.radius; }
  TriMesh mesh() const override { return sphere_mesh(form_.radius); }
  std::vector<Vec3d> corners() const override {
    return {Vec3d{}};  // with the radius as a margin
  }

 private:
  SphereShape form_;
};

}  // namespace

std::unique_ptr<const Solid> solid(const SphereShape& form) {
  want_positive(form.radius, "the radius of a sphere");
  return std::make_unique<Sphere>(form);
}

}  // namespace dreampm

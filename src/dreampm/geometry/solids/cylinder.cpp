#include <cmath>
#include <numbers>

#include "dreampm/geometry/solids/facets.h"
#include "dreampm/geometry/solids/region_parts.h"
#include "dreampm/geometry/solids/solid.h"

namespace dreampm {
namespace {

class CylinderRegion final : public Region {
 public:
  CylinderRegion(double radius, double height) : radius_(radius), half_(height * 0.5) {}
  double distance(const Vec3d& p) const override {
    const double side = std::sqrt(p.x * p.x + p.z * p.z) - radius_, end = std::abs(p.y) - half_;
    const double a = std::max(side, 0.0), b = std::max(end, 0.0);
    return std::sqrt(a * a + b * b) + std::min(std::max(side, end), 0.0);
  }
  Box3d bounds() const override { return box_of({-radius_, -half_, -radius_}, {radius_, half_, radius_}); }

 private:
  double radius_, half_;
};

TriMesh cylinder_mesh(double radius, double height) {
  TriMesh mesh;
  const Vec3d up{0, 0.5 * height, 0};
  for (const int end : {-1, 1})
    for (std::uint32_t i = 0; i < around; ++i)
      mesh.vertices.push_back(static_cast<Vec3f>(on_circle(i) * radius + up * end));
  for (std::uint32_t i = 0; i < around; ++i) {
    const std::uint32_t j = (i + 1) % around;
    mesh.triangles.push_back({i, j, around + j});
    mesh.triangles.push_back({i, around + j, around + i});
  }
  std::vector<Vec3d> top, bottom;
  for (std::uint32_t i = 0; i < around; ++i) {
    top.push_back(on_circle(i) * radius + up);
    bottom.push_back(on_circle(around - i) * radius - up);
  }
  add_polygon(mesh, top);
  add_polygon(mesh, bottom);
  return mesh;
}

/// Of each end.
constexpr int rim_points = 24;

class Cylinder final : public Solid {
 public:
  explicit Cylinder(const CylinderShape& form) : form_(form) {}
  std::shared_ptr<const Region> region() const override {
    return std::make_shared<CylinderRegion>(form_.radius, form_.height);
  }
  double volume() const override { return std::numbers::pi * form_.radius * form_.radius * form_.height; }
  TriMesh mesh() const override { return cylinder_mesh(form_.radius, form_.height); }
  std::vector<Vec3d> corners() const override {
    std::vector<Vec3d> points;
    for (int n = 0; n < 2 * rim_points; ++n) {
      const double angle = std::numbers::pi * (n / 2) / (rim_points / 2);
      points.push_back({form_.radius * std::cos(angle), (n % 2 - 0.5) * form_.height, form_.radius * std::sin(angle)});
    }
    return points;
  }

 private:
  CylinderShape form_;
};

}  // namespace

std::unique_ptr<const Solid> solid(const CylinderShape& form) {
  want_positive(form.radius, "the radius of a cylinder");
  want_positive(form.height, "the height of a cylinder");
  return std::make_unique<Cylinder>(form);
}

}  // namespace dreampm

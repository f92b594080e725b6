#include "dreampm/pipeline/body_checks.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "dreampm/geometry/sample.h"

namespace dreampm {
namespace {

/// The volume that the particles of a shape should have.
double shape_volume(const Shape& shape, const Region& region, double spacing, const Meshes& meshes) {
  if (const auto* b = std::get_if<BoxShape>(&shape.form)) return b->size.x * b->size.y * b->size.z;
  if (const auto* s = std::get_if<SphereShape>(&shape.form))
    return 4.0 / 3 * std::numbers::pi * s->radius * s->radius * s->radius;
  if (const auto* c = std::get_if<CylinderShape>(&shape.form))
    return std::numbers::pi * c->radius * c->radius * c->height;
  if (const auto* m = std::get_if<MeshShape>(&shape.form)) {
    const MeshLook look = meshes.look(*m);
    return look.volume ? *look.volume : level_set_volume(*meshes.regions()(*m, spacing));
  }
  return region_volume(region, spacing);
}

/// The first of some finer spacings, of two digits, at which cells fill a shape's volume; none where trying costs too
/// much.
std::optional<double> tried_spacing(const Shape& shape, const Region& region, double spacing, const Meshes& meshes) {
  constexpr double most_cells = 4e6, finer = 0.8;
  const Vec3d size = region.bounds().size();
  for (double s = spacing * finer; size.x * size.y * size.z / (s * s * s) < most_cells; s *= finer) {
    const double two_digits = spacing_for(2 * s), cell = two_digits * two_digits * two_digits;
    const std::size_t points = sample_region(region, two_digits, Pattern::jitter, 0).size();
    if (points == 0) continue;
    const double should = shape_volume(shape, region, two_digits, meshes);
    if (std::abs(static_cast<double>(points) * cell / should - 1) < volume_slack / 2) return two_digits;
  }
  return std::nullopt;
}

}  // namespace

Box3d shape_bounds(const Shape& shape, double spacing, const Meshes& meshes) {
  return make_region(shape, spacing, meshes.boxes())->bounds();
}

std::string finer_spacing(const Shape& shape, const Region& region, double spacing, const Meshes& meshes) {
  if (const auto* m = std::get_if<MeshShape>(&shape.form)) {
    const std::optional<double> thickness = meshes.look(*m).thickness;
    if (!thickness) return "";
    const double would_do = std::min(spacing_for(*thickness), spacing_for(spacing));
    return fmt::format("; it is about {:.2g} m thick: a spacing of {:.2g} m would do", *thickness, would_do);
  }
  const auto would_do = tried_spacing(shape, region, spacing, meshes);
  return would_do ? fmt::format("; a spacing of {:.2g} m would do", *would_do) : std::string();
}

void VolumeCheck::add(const std::string& name, const Shape& shape, const Region& region, std::size_t particles) {
  const double holds = static_cast<double>(particles) * spacing_ * spacing_ * spacing_,
               should = shape_volume(shape, region, spacing_, meshes_);
  if (!(should > 0) || std::abs(holds / should - 1) <= volume_slack) return;
  constexpr std::size_t told = 3;  // looking for better spacings costs time
  off_.push_back({name, off_.size() < told ? finer_spacing(shape, region, spacing_, meshes_) : "", holds, should});
}

std::vector<std::string> VolumeCheck::warnings() const {
  constexpr std::size_t few = 3;
  std::vector<std::string> lines;
  if (off_.size() > few) {
    const auto worst = std::max_element(off_.begin(), off_.end(), [](const Off& a, const Off& b) {
      return std::abs(a.holds / a.should - 1) < std::abs(b.holds / b.should - 1);
    });
    lines.push_back(
        fmt::format("the particles of {} bodies hold more or less than their shapes, by over {:.0f} % at a spacing of "
                    "{:.4g} m; the worst is {}: {:+.0f} %",
                    off_.size(), 100 * volume_slack, spacing_, worst->name, 100 * (worst->holds / worst->should - 1)));
    return lines;
  }
  for (const Off& o : off_)
    lines.push_back(fmt::format("the particles of {} hold {:.4g} m^3, its shape {:.4g} m^3 ({:+.0f} %){}", o.name,
                                o.holds, o.should, 100 * (o.holds / o.should - 1), o.advice));
  return lines;
}

}  // namespace dreampm

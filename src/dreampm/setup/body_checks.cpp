#include "dreampm/setup/body_checks.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "dreampm/geometry/solids/solid.h"
#include "dreampm/setup/place.h"
#include "dreampm/setup/round_down.h"

namespace dreampm {
namespace {

/// The volume that the particles of a shape should have; 0 where it would take too long to find.
double shape_volume(const Shape& shape, const Region& region, double spacing, const Meshes& meshes) {
  if (const auto solid = solid_of(shape)) return solid->volume();
  if (const auto* m = std::get_if<MeshShape>(&shape.form)) {
    const MeshLook look = meshes.look(*m);
    return look.volume ? *look.volume : level_set_volume(*meshes.regions()(*m, spacing, 0));
  }
  constexpr double most_along = 1e5;  // cells that region_volume takes
  const Vec3d size = region.bounds().size();
  return std::max({size.x, size.y, size.z}) < most_along * spacing ? region_volume(region, spacing) : 0;
}

/// True if particles of that spacing hold the volume of the shape, with a margin.
bool shows(const Shape& shape, double spacing, const Sampling& sampling, const Meshes& meshes) {
  try {
    const auto region = make_region(shape, spacing, meshes.regions());
    const std::size_t points = sample_region(*region, spacing, sampling.pattern, sampling.seed).size();
    if (points == 0) return false;
    const double holds = static_cast<double>(points) * spacing * spacing * spacing;
    return std::abs(holds / shape_volume(shape, *region, spacing, meshes) - 1) < 0.7 * volume_slack;
  } catch (const EnclosesNothing&) {
    return false;
  }
}

/// Returns the part of its volume by which particles may be off before a figure means anything. In
/// a lump of up to six rows along each axis rows are whole, so that half a row may be too many or
/// too few; thin bodies are no lumps.
double slack_of(double holds, double should, const Vec3d& size, double spacing) {
  constexpr double few = 216, lump = 0.3;  // particles; the least part of the bounds, of which a ball fills 0.52
  const double particle = spacing * spacing * spacing;
  const bool small = std::max(holds, should) < few * particle && std::min({size.x, size.y, size.z}) >= 2 * spacing &&
                     should >= lump * size.x * size.y * size.z;
  return small ? std::max(volume_slack, 1.5 * std::cbrt(particle / should)) : volume_slack;
}

bool has_mesh(const Shape& shape) {
  if (const auto* b = std::get_if<BooleanShape>(&shape.form))
    return std::any_of(b->parts.begin(), b->parts.end(), has_mesh);
  if (const auto* c = std::get_if<ContainerShape>(&shape.form))
    return std::any_of(c->hollow.begin(), c->hollow.end(), has_mesh);
  return std::holds_alternative<MeshShape>(shape.form);
}

/// Returns the work of a try, in cells that are asked for a distance: for a mesh those in a band
/// along its area, since its field has to be made first; for other shapes those of the bounds.
double work_of(const Shape& shape, double spacing, const Meshes& meshes) {
  if (const auto* m = std::get_if<MeshShape>(&shape.form)) return 8 * meshes.look(*m).area / (spacing * spacing);
  const Vec3d size = shape_bounds(shape, spacing, meshes).size();
  double cells = 1;
  for (int a = 0; a < 3; ++a) cells *= std::max(size[a] / spacing, 1.0);
  return cells;
}

/// The first of some spacings, from `first` down, that shows the shape; none where trying costs too
/// much.
std::optional<double> tried_spacing(const Shape& shape, double first, const Sampling& sampling, const Meshes& meshes) {
  constexpr double most_work = 6e6, finer = 0.93;
  double work = 0;
  for (double s = first;; s *= finer) {
    work += work_of(shape, s, meshes);
    if (!(work < most_work)) return std::nullopt;
    if (shows(shape, two_digits(s), sampling, meshes)) return two_digits(s);
  }
}

}  // namespace

Box3d shape_bounds(const Shape& shape, double spacing, const Meshes& meshes) {
  return make_region(shape, spacing, meshes.boxes())->bounds();
}

std::shared_ptr<const Region> body_region(const Shape& shape, double spacing, const Sampling& sampling,
                                          const Meshes& meshes) {
  const bool combined =
      std::holds_alternative<BooleanShape>(shape.form) || std::holds_alternative<ContainerShape>(shape.form);
  try {
    return make_region(shape, spacing, combined ? meshes.fine_regions() : meshes.regions());
  } catch (const EnclosesNothing& e) {
    throw EnclosesNothing(e.what() + finer_spacing(shape, spacing, sampling, meshes));
  }
}

std::string finer_spacing(const Shape& shape, double spacing, const Sampling& sampling, const Meshes& meshes) {
  constexpr double finer = 0.85;
  const auto* mesh = std::get_if<MeshShape>(&shape.form);
  if (!mesh) {
    if (has_mesh(shape) || shape_bounds(shape, spacing, meshes).empty()) return "";
    const auto would_do = tried_spacing(shape, finer * spacing, sampling, meshes);
    return would_do ? fmt::format("; a spacing of {:.2g} m would do", *would_do) : std::string();
  }
  constexpr std::size_t most_triangles = 200000;  // beyond, a field takes seconds however coarse
  const MeshLook look = meshes.look(*mesh);
  if (!look.thickness || !(*look.thickness > 1e-6 * length(look.bounds.size()))) return "";
  const auto would_do = look.triangles > most_triangles
                            ? std::nullopt
                            : tried_spacing(shape, std::min(finer * spacing, *look.thickness / 2), sampling, meshes);
  return fmt::format("; it is about {:.2g} m thick: {}", *look.thickness,
                     would_do ? fmt::format("a spacing of {:.2g} m would do", *would_do)
                              : std::string("use a spacing of a quarter of that or less"));
}

std::vector<std::string> outside_walls(const model::Body& body, const std::vector<Vec3d>& points,
                                       const model::Scene& scene, const std::string& file) {
  const model::Space& space = scene.space;
  std::vector<std::string> errors;
  // Points exactly on a wall are of a body that lies flush against it.
  const double slack = 1e-6 * space.dx();
  const Vec3d end = space.end();
  for (int axis = 0; axis < 3; ++axis) {
    if (!space.periodic[static_cast<std::size_t>(axis)]) continue;
    double low = 1e30, high = -1e30;
    for (const Vec3d& p : points) low = std::min(low, p[axis]), high = std::max(high, p[axis]);
    const double period = end[axis] - space.min[axis];
    if (high - low > period + slack)
      errors.push_back(fmt::format(
          "{}: error: body {} is {:.4g} m long along {}, more than the period of {:.4g} m: it would overlap itself",
          place(file, scene, body), body.name, high - low, "xyz"[axis], period));
  }
  for (int side = 0; side < 6; ++side) {
    if (space.walls[static_cast<std::size_t>(side)].type == WallType::open) continue;
    const int axis = side / 2;
    double beyond = 0;
    for (const Vec3d& p : points) beyond = std::max(beyond, side % 2 ? p[axis] - end[axis] : space.min[axis] - p[axis]);
    if (beyond > slack)
      errors.push_back(
          fmt::format("{}: error: body {} reaches {:.4g} m outside the wall {}; move it, or make space larger",
                      place(file, scene, body), body.name, beyond, side_names[static_cast<std::size_t>(side)]));
  }
  return errors;
}

std::optional<std::string> beyond_open_sides(const model::Body& body, const std::vector<Vec3d>& points,
                                             const model::Scene& scene, const std::string& file,
                                             std::vector<std::string>& warnings) {
  const model::Space& space = scene.space;
  const double slack = 1e-6 * space.dx();
  const Vec3d end = space.end();
  std::size_t lost = 0;
  std::array<std::size_t, 6> by_side{};
  for (const Vec3d& p : points) {
    bool out = false;
    for (std::size_t side = 0; side < 6; ++side) {
      const int axis = static_cast<int>(side / 2);
      if (space.walls[side].type != WallType::open || space.periodic[side / 2]) continue;
      const double beyond = side % 2 ? p[axis] - end[axis] : space.min[axis] - p[axis];
      if (beyond > slack) out = true, ++by_side[side];
    }
    lost += out;
  }
  if (lost == 0) return std::nullopt;
  const auto most = static_cast<std::size_t>(std::max_element(by_side.begin(), by_side.end()) - by_side.begin());
  const std::string where = fmt::format("beyond the open side {}", side_names[most]);
  if (lost == points.size())
    return fmt::format("{}: error: body {} lies wholly {}, where matter is taken out: move it, or make space larger",
                       place(file, scene, body), body.name, where);
  warnings.push_back(
      fmt::format("{:.4g} of {:.4g} m^3 of body {} lie {}, and are taken out at once: move it, or make "
                  "space larger",
                  static_cast<double>(lost) * std::pow(space.spacing, 3),
                  static_cast<double>(points.size()) * std::pow(space.spacing, 3), body.name, where));
  return std::nullopt;
}

std::vector<std::string> short_of_walls(const model::Body& body, const Box3d& bounds, const model::Space& space) {
  std::vector<std::string> notes;
  const double slack = 1e-6 * space.dx();
  const Vec3d end = space.end();
  for (int a = 0; a < 3; ++a) {
    const double asked = space.max[a], gap = end[a] - asked;
    if (space.periodic[static_cast<std::size_t>(a)] || !(gap > slack) || std::abs(bounds.max[a] - asked) > slack)
      continue;
    notes.push_back(
        fmt::format("body {} ends {:.4g} m short of the wall {}_max: space.max asks for {:.10g} along {}, and the wall "
                    "stands at {:.10g}, at whole cells of {:.4g} m",
                    body.name, gap, "xyz"[a], asked, "xyz"[a], end[a], space.dx()));
  }
  return notes;
}

void VolumeCheck::add(const std::string& name, const Shape& shape, const Region& region, const Sampling& sampling,
                      std::size_t particles) {
  const double holds = static_cast<double>(particles) * spacing_ * spacing_ * spacing_,
               should = shape_volume(shape, region, spacing_, meshes_);
  if (!(should > 0) || std::abs(holds / should - 1) <= slack_of(holds, should, region.bounds().size(), spacing_))
    return;
  constexpr std::size_t most_advised = 3;  // looking for better spacings costs time
  off_.push_back(
      {name, off_.size() < most_advised ? finer_spacing(shape, spacing_, sampling, meshes_) : "", holds, should});
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

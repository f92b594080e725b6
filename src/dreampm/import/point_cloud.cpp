#include "dreampm/import/point_cloud.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "dreampm/base/error.h"
#include "dreampm/base/log.h"
#include "dreampm/base/parallel.h"
#include "dreampm/import/point_file.h"

namespace dreampm {
namespace {

/// One of the points in every place; what lies within a millionth of the cloud's size is in one
/// place.
std::vector<Vec3d> one_a_place(const std::vector<Vec3d>& points) {
  constexpr double steps = 1 << 20;
  Box3d box;
  for (const Vec3d& p : points) box.add(p);
  const Vec3d size = box.size();
  const double step = std::max({size.x, size.y, size.z}) / steps;
  std::vector<std::pair<std::uint64_t, std::size_t>> places(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    std::uint64_t key = 0;
    for (int a = 0; a < 3; ++a)
      key = key << 21 | (step > 0 ? static_cast<std::uint64_t>((points[i][a] - box.min[a]) / step) : 0);
    places[i] = {key, i};
  }
  std::sort(places.begin(), places.end());
  std::vector<Vec3d> kept;
  for (std::size_t i = 0; i < places.size(); ++i)
    if (i == 0 || places[i].first != places[i - 1].first) kept.push_back(points[places[i].second]);
  return kept;
}

/// Squared, from the point `i` to the fourth nearest of the others.
double fourth_neighbor(const std::vector<Vec3d>& points, std::size_t i) {
  std::array<double, 4> least;
  least.fill(std::numeric_limits<double>::infinity());
  for (std::size_t k = 0; k < points.size(); ++k) {
    const double d = length2(points[k] - points[i]);
    if (d >= least[3] || k == i) continue;
    std::size_t at = 3;
    for (; at > 0 && least[at - 1] > d; --at) least[at] = least[at - 1];
    least[at] = d;
  }
  return least[3];
}

}  // namespace

std::vector<Vec3d> read_point_cloud(const std::filesystem::path& path, double scale) {
  return read_moving_cloud(path, scale).points;
}

MovingCloud read_moving_cloud(const std::filesystem::path& path, double scale) {
  return moving_cloud(read_point_file(path), path.string(), scale);
}

MovingCloud moving_cloud(Model model, const std::string& name, double scale) {
  if (!(scale > 0) || !std::isfinite(scale)) fail_input("{}: a scale of {}: a number above 0 is wanted", name, scale);
  for (const std::string& w : model.warnings) warn("{}", w);
  if (model.vertices.empty()) fail_input("{}: holds no points", name);
  for (Vec3d& p : model.vertices) p *= scale;
  for (Vec3d& v : model.velocities) v *= scale;
  return {std::move(model.vertices), std::move(model.velocities), std::move(model.ids), std::move(model.colors)};
}

CloudLook look_at_cloud(const std::vector<Vec3d>& points) {
  constexpr std::size_t fewest = 16, looks = 256;
  const std::vector<Vec3d> kept = one_a_place(points);
  CloudLook out{{}, points.size() - kept.size()};
  if (kept.size() < fewest) return out;
  // Each look goes past all points, which needs no idea of their spacing beforehand.
  std::vector<double> squares(std::min(kept.size(), looks));
  parallel_for(squares.size(), 1,
               [&](std::size_t i) { squares[i] = fourth_neighbor(kept, i * kept.size() / squares.size()); });
  const auto middle = squares.begin() + static_cast<std::ptrdiff_t>(squares.size() / 2);
  std::nth_element(squares.begin(), middle, squares.end());
  out.spacing = std::sqrt(*middle);
  return out;
}

std::vector<std::string> cloud_warnings(const std::vector<Vec3d>& points, double spacing, const std::string& name) {
  constexpr double much = 1.25;
  const CloudLook look = look_at_cloud(points);
  std::vector<std::string> out;
  const std::string apart = look.spacing ? fmt::format("its points lie about {:.3g} m apart", *look.spacing)
                                         : std::string("it has few points");
  if (look.coincident > 0)
    out.push_back(fmt::format("{}: {} of {} points lie in the place of another, so matter is there twice; {}", name,
                              look.coincident, points.size(), apart));
  if (look.spacing && (*look.spacing > much * spacing || *look.spacing * much < spacing))
    out.push_back(fmt::format(
        "{}: {}, while each counts as a cube of {:.3g} m: together they hold {:.3g} times the volume that "
        "they fill; use a spacing of {:.3g} m, or scale the cloud by {:.3g}",
        name, apart, spacing, std::pow(spacing / *look.spacing, 3), *look.spacing, spacing / *look.spacing));
  return out;
}

}  // namespace dreampm

#include "dreampm/contact/surface_points.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace dreampm {
namespace {

/// Returns SurfacePoint::from_edge: the mean of the directions in which the surface falls off,
/// reversed. Opposite directions cancel, so that neither the points of a sphere nor those in the
/// middle of a narrow face have any.
Vec3d away_from_edge(const ColliderView& view, const Vec3d& at, const Vec3d& normal) {
  Vec3d sum;
  for (const Vec3d& way : ways_along(normal))
    if (view.nearest(at - normal * ColliderContact::edge_depth + way) > ColliderView::slit) sum -= way;
  const double size = length(sum);
  return size > 0.5 ? sum * (1 / size) : Vec3d{};
}

/// A crossing of a line and a surface, with the area of the surface that it stands for.
struct Crossing {
  std::uint16_t collider;
  Vec3d at, normal;
  double area;
};

/// The patches of surfaces in one cell, one for each collider and each way that it faces there: an
/// edge has two.
class Patches {
 public:
  void add(const Crossing& c) {
    for (Patch& p : patches_)
      if (p.collider == c.collider && dot(p.facing, c.normal) > ColliderContact::same_face * length(p.facing))
        return p.add(c);
    patches_.push_back({c.collider});
    patches_.back().add(c);
  }
  template <class Body>
  void for_each(const Body& body) const {
    for (const Patch& p : patches_)
      if (const double area = length(p.facing); area > 1e-3)
        body(p.collider, p.middle * (1 / p.area), p.facing * (1 / area), area);
  }

 private:
  struct Patch {
    std::uint16_t collider;
    Vec3d middle{}, facing{};  ///< sums over area
    double area = 0;
    void add(const Crossing& c) { middle += c.at * c.area, facing += c.normal * c.area, area += c.area; }
  };
  std::vector<Patch> patches_;
};

/// Along which axes another face rises from the surface within a cell of a place on it, before the
/// walls. Gaps of a cell have no corners: there is no matter in them that could press on both faces
/// apart.
std::array<bool, 3> towards_corner(const ColliderView& view, const Vec3d& at, const Vec3d& normal) {
  constexpr double above = 0.5, gap = 1.25;
  std::array<bool, 3> axes{};
  if (ColliderView::inside(view.nearest(at + normal * gap))) return axes;
  for (int a = 0; a < 3; ++a) {
    Vec3d way = normal * -normal[a];  // the axis along the surface
    way[a] += 1;
    if (length(way) < 0.5) continue;
    for (const double side : {-1.0, 1.0}) {
      const Vec3d there = at + normal * above + normalized(way) * side;
      if (ColliderView::inside(view.nearest(there)) && view.within_domain(there))
        axes[static_cast<std::size_t>(a)] = true;
    }
  }
  return axes;
}

/// Returns the crossings of the lines along the axes with surfaces that matter can touch, in the
/// cell that begins at `first`.
std::vector<Crossing> crossings(const ColliderView& view, const Vec3d& first) {
  constexpr int lines_a_cell = ColliderContact::lines_a_cell, lines = lines_a_cell * lines_a_cell,
                places_a_line = lines_a_cell + 1;
  constexpr double apart = 1.0 / lines_a_cell;
  std::array<Vec3d, std::size_t{3} * lines * places_a_line> places;
  for (int a = 0, n = 0; a < 3; ++a)
    for (int line = 0; line < lines; ++line)
      for (int part = 0; part < places_a_line; ++part) {
        Vec3d& place = places[static_cast<std::size_t>(n++)];
        place = first;
        place[a] += part * apart;
        place[(a + 1) % 3] += (line / lines_a_cell + 0.5) * apart;
        place[(a + 2) % 3] += (line % lines_a_cell + 0.5) * apart;
      }
  std::array<double, places.size()> distances;
  view.nearest(places, distances.data());
  std::vector<Crossing> all;
  for (std::size_t line = 0; line < std::size_t{3} * lines; ++line) {
    const int a = static_cast<int>(line) / lines;
    const Vec3d* const place = places.data() + line * places_a_line;
    const double* const distance = distances.data() + line * places_a_line;
    // A distance changes by no more than the way: the whole line lies on one side.
    if (std::abs(distance[0]) > 1.001) continue;
    for (int part = 0; part < lines_a_cell; ++part) {
      const double begin = distance[part], end = distance[part + 1];
      // Nor does it cross the surface before it has come there.
      if (const int free = static_cast<int>(std::abs(begin) / (1.05 * apart)); free > 0) {
        part += free - 1;
        continue;
      }
      if (ColliderView::inside(begin) == ColliderView::inside(end)) continue;
      const Vec3d at = view.crossing(place[part], place[part + 1], begin, end);
      const std::uint16_t collider = view.nearest_collider(at);
      const Vec3d normal = view.normal(collider, at);
      if (view.is_exposed(at, normal)) all.push_back({collider, at, normal, std::abs(normal[a]) * apart * apart});
    }
  }
  return all;
}

/// Cells from the middle of a block within which surfaces cut its cells: half its diagonal.
constexpr double block_reach_of_surfaces = 3.5;
/// Bound of the distance from the middle of a cell to a surface that cuts it [cells]: half the
/// diagonal.
constexpr double half_diagonal = 0.87;

/// True if a surface may cut one of the eighths of a cell.
bool is_cut(const ColliderView& view, const Vec3d& middle) {
  constexpr double aside = 0.25, reach = 0.45;  // a little more than half the diagonal of an eighth
  std::array<Vec3d, 8> middles;
  for (int n = 0; n < 8; ++n)
    middles[static_cast<std::size_t>(n)] =
        middle + Vec3d{n & 4 ? aside : -aside, n & 2 ? aside : -aside, n & 1 ? aside : -aside};
  std::array<double, 8> distances;
  view.nearest(middles, distances.data());
  return std::any_of(distances.begin(), distances.end(), [](double d) { return std::abs(d) <= reach; });
}

}  // namespace

std::array<Vec3d, 8> ways_along(const Vec3d& normal) {
  const Vec3d u = normalized(cross(normal, std::abs(normal.x) < 0.6 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0})),
              v = cross(normal, u);
  std::array<Vec3d, 8> ways;
  for (std::size_t k = 0; k < ways.size(); ++k) {
    const double angle = 2 * std::numbers::pi * static_cast<double>(k) / ways.size();
    ways[k] = u * std::cos(angle) + v * std::sin(angle);
  }
  return ways;
}

void add_patches(const ColliderView& view, const Vec3d& first, std::vector<SurfacePatch>& patches) {
  const Vec3d middle = first + Vec3d{0.5, 0.5, 0.5};
  if (std::abs(view.nearest(middle)) > half_diagonal) return;
  if (!is_cut(view, middle)) return;
  const std::vector<Crossing> all = crossings(view, first);
  Patches whole;
  for (const Crossing& c : all) whole.add(c);
  std::array<bool, 3> halved{};
  whole.for_each([&](std::uint16_t, const Vec3d& at, const Vec3d& normal, double) {
    const auto towards = towards_corner(view, at, normal);
    for (std::size_t a = 0; a < 3; ++a) halved[a] = halved[a] || towards[a];
  });
  // One point for a cell beside a corner gives nothing to the nodes behind the other face that
  // kernels there reach.
  std::array<Patches, 8> parts;
  for (const Crossing& c : all) {
    constexpr double rounding = 1e-5;  // a face through the middle lies on one side of it
    std::size_t part = 0;
    for (int a = 0; a < 3; ++a)
      part = 2 * part + (halved[static_cast<std::size_t>(a)] && c.at[a] > middle[a] + rounding ? 1 : 0);
    parts[part].add(c);
  }
  for (const Patches& part : parts)
    part.for_each([&](std::uint16_t collider, const Vec3d& at, const Vec3d& normal, double area) {
      if (view.within_domain(at)) patches.push_back({at, normal, away_from_edge(view, at, normal), area, collider});
    });
}

SurfacePoint surface_point(ExposedNodes& exposed, const SurfacePatch& patch) {
  SurfacePoint p{static_cast<Vec3<float>>(patch.at),
                 static_cast<Vec3<float>>(patch.normal),
                 static_cast<Vec3<float>>(patch.from_edge),
                 static_cast<float>(patch.area),
                 0,
                 {},
                 patch.collider};
  for (int a = 0; a < 3; ++a)
    p.first[static_cast<std::size_t>(a)] = static_cast<std::int8_t>(std::floor(patch.at[a] - 0.5));
  for (int m = 0; m < 27; ++m) {
    const Vec3i node{p.first[0] + m / 9, p.first[1] + m / 3 % 3, p.first[2] + m % 3};
    if (exposed.at(patch.collider, node).distance < -ColliderContact::deep_nodes) p.deep |= 1u << m;
  }
  return p;
}

void add_points(ExposedNodes& exposed, std::vector<SurfacePoint>& points) {
  const ColliderView& view = exposed.view();
  std::vector<std::uint16_t> others = view.within(block_reach_of_surfaces);
  std::erase_if(others, [&](std::uint16_t c) { return view.is_rigid_body(c); });
  if (others.empty()) return;
  std::array<bool, block_nodes> meets{};  // by cell: whether a surface of the others may cut it
  std::array<Vec3d, block_nodes> middles;
  for (int n = 0; n < block_nodes; ++n)
    middles[static_cast<std::size_t>(n)] = static_cast<Vec3d>(node_offset(n)) + Vec3d{0.5, 0.5, 0.5};
  for (const std::uint16_t c : others) {
    std::array<double, block_nodes> distances;
    view.distances(c, middles, distances.data());
    for (std::size_t n = 0; n < block_nodes; ++n) meets[n] = meets[n] || std::abs(distances[n]) <= half_diagonal;
  }
  std::vector<SurfacePatch> patches;
  for (int n = 0; n < block_nodes; ++n) {
    if (!meets[static_cast<std::size_t>(n)]) continue;
    patches.clear();
    add_patches(view, static_cast<Vec3d>(node_offset(n)), patches);
    for (const SurfacePatch& patch : patches)
      if (!view.is_rigid_body(patch.collider)) points.push_back(surface_point(exposed, patch));
  }
}

}  // namespace dreampm

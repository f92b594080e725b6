#include "dreampm/state/obstacles.h"

#include <algorithm>
#include <boost/container/small_vector.hpp>
#include <cmath>
#include <numbers>
#include <tuple>
#include <utility>

#include "dreampm/base/parallel.h"
#include "dreampm/state/collider_view.h"
#include "dreampm/state/neighbours.h"
#include "dreampm/state/refit.h"

namespace dreampm {
namespace {

/// Along each axis and across it: what a surface has within less than a quarter of a cell may be missed.
constexpr int lines_a_cell = 4;
constexpr Node<float> far_away{0, 0, 0, static_cast<float>(clearance_reach)};

// The part of a quadratic B-spline beyond distance d on its positive side: how much of a node's kernel lies inside a
// plane obstacle at signed distance d (cells).
double kernel_inside(double d) {
  if (d >= 1.5) return 0;
  if (d <= -1.5) return 1;
  if (d >= 0.5) return std::pow(1.5 - d, 3) / 6;
  if (d <= -0.5) return 1 - std::pow(1.5 + d, 3) / 6;
  return 0.5 - 0.75 * d + d * d * d / 3;
}

void add_nodes(const ColliderView& view, std::uint16_t collider, std::vector<ObstacleNode>& nodes) {
  for (int n = 0; n < block_nodes; ++n) {
    const ColliderDistance to = view.exposed(collider, static_cast<Vec3d>(node_offset(n)));
    const double blocked = kernel_inside(to.distance);
    if (blocked <= 0) continue;
    const bool inside = ColliderView::inside(to.distance);
    nodes.push_back({static_cast<std::uint8_t>(n), inside, to.distance < -deep_nodes, collider,
                     static_cast<float>(blocked), inside ? to.normal : Vec3d{}});
  }
}

/// Where several colliders take of a node's kernel, what they take together is no sum. Of two faces that meet at a
/// right angle the second takes its part of what the first one left; one that continues the first takes nothing more.
void share_kernels(const ColliderView& view, std::vector<ObstacleNode>& nodes) {
  std::array<double, block_nodes> sums{};
  std::array<boost::container::small_vector<Vec3d, 2>, block_nodes> normals;
  std::sort(nodes.begin(), nodes.end(), [](const ObstacleNode& a, const ObstacleNode& b) {
    return std::tuple(-a.blocked, a.collider, a.node) < std::tuple(-b.blocked, b.collider, b.node);
  });
  for (ObstacleNode& n : nodes) {
    const Vec3d normal = n.inside ? n.normal : view.normal(n.collider, static_cast<Vec3d>(node_offset(n.node)));
    double alike = 0;
    for (const Vec3d& other : normals[n.node]) alike = std::max(alike, dot(normal, other));
    n.blocked *= static_cast<float>((1 - sums[n.node]) * (1 - alike));
    sums[n.node] += static_cast<double>(n.blocked);
    normals[n.node].push_back(normal);
  }
  std::erase_if(nodes, [](const ObstacleNode& n) { return !(n.blocked > 0); });
  std::sort(nodes.begin(), nodes.end(), [](const ObstacleNode& a, const ObstacleNode& b) {
    return std::tuple(a.node, a.collider) < std::tuple(b.node, b.collider);
  });
}

/// The distance from the nearest of several colliders at a block's nodes and those beside them.
class Distances {
 public:
  Distances() { d_.fill(clearance_reach); }
  void add(const ColliderView& view, std::uint16_t collider) {
    for (int i = 0; i < width; ++i)
      for (int j = 0; j < width; ++j)
        for (int k = 0; k < width; ++k) {
          double& d = d_[static_cast<std::size_t>((i * width + j) * width + k)];
          d = std::max(-clearance_reach, std::min(d, view.exposed(collider, {i - 1.0, j - 1.0, k - 1.0}).distance));
        }
  }
  /// As of Obstacles::clearance. A quadratic spline of the distances themselves would be off by an eighth of their
  /// Laplacian: by 1/4 r cells on a sphere of r cells.
  Node<float> clearance(int n) const {
    const Vec3i at = node_offset(n);
    const int middle = ((at.x + 1) * width + at.y + 1) * width + at.z + 1, steps[3] = {width * width, width, 1};
    const auto d = [&](int i) { return d_[static_cast<std::size_t>(i)]; };
    Vec3d gradient;
    double laplacian = 0;
    for (int a = 0; a < 3; ++a) {
      const double before = d(middle - steps[a]), after = d(middle + steps[a]);
      gradient[a] = 0.5 * (after - before), laplacian += before - 2 * d(middle) + after;
    }
    return {static_cast<float>(gradient.x), static_cast<float>(gradient.y), static_cast<float>(gradient.z),
            static_cast<float>(d(middle) - laplacian / 8)};
  }

 private:
  static constexpr int width = block_width + 2;
  std::array<double, width * width * width> d_;
};

/// As SurfacePoint::inland: the mean of the ways on which the surface falls off, turned round. Ways that face each
/// other cancel, so that neither the points of a sphere nor those in the middle of a narrow face have any.
Vec3d away_from_edge(const ColliderView& view, const Vec3d& at, const Vec3d& normal) {
  constexpr int ways = 8;
  constexpr double below = 0.25;  // the surface bends less than that within a cell unless there is an edge
  const Vec3d u = normalized(cross(normal, std::abs(normal.x) < 0.6 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0})),
              v = cross(normal, u);
  Vec3d sum;
  for (int k = 0; k < ways; ++k) {
    const double angle = 2 * std::numbers::pi * k / ways;
    const Vec3d way = u * std::cos(angle) + v * std::sin(angle);
    if (view.nearest(at - normal * below + way) > ColliderView::slit) sum -= way;
  }
  const double size = length(sum);
  return size > 0.5 ? sum * (1 / size) : Vec3d{};
}

SurfacePoint surface_point(const ColliderView& view, std::uint16_t collider, const Vec3d& at, const Vec3d& normal,
                           double area) {
  SurfacePoint p{static_cast<Vec3<float>>(at),
                 static_cast<Vec3<float>>(normal),
                 static_cast<Vec3<float>>(away_from_edge(view, at, normal)),
                 static_cast<float>(area),
                 0,
                 {},
                 collider};
  for (int a = 0; a < 3; ++a) p.first[static_cast<std::size_t>(a)] = static_cast<std::int8_t>(std::floor(at[a] - 0.5));
  for (int m = 0; m < 27; ++m) {
    const Vec3i node{p.first[0] + m / 9, p.first[1] + m / 3 % 3, p.first[2] + m % 3};
    if (view.exposed(collider, static_cast<Vec3d>(node)).distance < -deep_nodes) p.deep |= 1u << m;
  }
  return p;
}

/// Whether matter may come to a place [cells from node `first`]: not on walls or behind.
template <class R>
bool within_domain(const World<R>& world, const Vec3i& first, const Vec3d& at) {
  for (int a = 0; a < 3; ++a) {
    const double x = first[a] + at[a];
    if (world.periodic[static_cast<std::size_t>(a)]) continue;
    if (x < world.low[a] + 1e-6 || x > world.high[a] - 1e-6) return false;
  }
  return true;
}

/// The patches of surfaces in one cell, one for each collider and each way that it faces there: an edge has two.
class Patches {
 public:
  void add(std::uint16_t collider, const Vec3d& at, const Vec3d& normal, double area) {
    for (Patch& p : patches_)
      if (p.collider == collider && dot(p.facing, normal) > 0.7 * length(p.facing)) return p.add(at, normal, area);
    patches_.push_back({collider});
    patches_.back().add(at, normal, area);
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
    void add(const Vec3d& at, const Vec3d& normal, double some) {
      middle += at * some, facing += normal * some, area += some;
    }
  };
  std::vector<Patch> patches_;
};

template <class R>
void add_points(const World<R>& world, const Vec3i& block, const ColliderView& view,
                std::vector<SurfacePoint>& points) {
  constexpr double apart = 1.0 / lines_a_cell;
  for (int n = 0; n < block_nodes; ++n) {
    const Vec3d first = static_cast<Vec3d>(node_offset(n));
    if (std::abs(view.nearest(first + Vec3d{0.5, 0.5, 0.5})) > 0.87) continue;  // half a cell's diagonal
    Patches patches;
    for (int a = 0; a < 3; ++a)
      for (int line = 0; line < lines_a_cell * lines_a_cell; ++line) {
        Vec3d from = first;
        from[(a + 1) % 3] += (line / lines_a_cell + 0.5) * apart,
            from[(a + 2) % 3] += (line % lines_a_cell + 0.5) * apart;
        double begin = view.nearest(from);
        for (int part = 0; part < lines_a_cell; ++part) {
          Vec3d to = from;
          to[a] += apart;
          const double end = view.nearest(to);
          if (ColliderView::inside(begin) != ColliderView::inside(end)) {
            const Vec3d at = view.crossing(from, to, begin, end);
            const std::uint16_t collider = view.nearest_collider(at);
            const Vec3d normal = view.normal(collider, at);
            if (view.is_exposed(at, normal)) patches.add(collider, at, normal, std::abs(normal[a]) * apart * apart);
          }
          from = to, begin = end;
        }
      }
    patches.for_each([&](std::uint16_t collider, const Vec3d& at, const Vec3d& normal, double area) {
      if (within_domain(world, block * block_width, at))
        points.push_back(surface_point(view, collider, at, normal, area));
    });
  }
}

/// Whether the collider ends again less than `thickness` behind a place on its surface.
bool is_thin(const ColliderView& view, const Vec3d& at, const Vec3d& normal, double thickness) {
  constexpr int steps = 8;
  for (int k = 1; k <= steps; ++k)
    if (view.nearest(at - normal * (thickness * k / steps)) > 1e-6) return true;
  return false;
}

/// Whether splines between nodes do not resolve the solid behind the surface that is nearest to a free place.
template <class R>
bool needs_distance(const World<R>& world, const ColliderView& view, const Vec3d& at) {
  constexpr double hollow = 0.75;
  const double distance = view.nearest(at);
  if (ColliderView::inside(distance) || distance > 1) return false;
  const std::uint16_t collider = view.nearest_collider(at);
  if (world.colliders[collider].holds) return false;
  const Vec3d normal = view.normal(collider, at), foot = at - normal * distance;
  return is_thin(view, foot, normal, thin_wall) ||
         (view.nearest(foot + normal) < hollow && is_thin(view, foot, normal, thin_edge));
}

/// The cells of a block in which particles need their exact distance: those of free places that need it, and all around
/// them, for a particle just inside of a collider to be put back.
template <class R>
std::uint64_t thin_cells(const World<R>& world, const ColliderView& view) {
  // A particle is put back from half a cell before a surface at most, as far as it moves in a step.
  constexpr double near = 0.5 + 0.87;
  std::uint64_t cells = 0;
  for (int n = 0; n < block_nodes; ++n) {
    const Vec3d first = static_cast<Vec3d>(node_offset(n));
    if (std::abs(view.nearest(first + Vec3d{0.5, 0.5, 0.5})) > near) continue;
    bool needed = false;
    for (int m = 0; m < 27 && !needed; ++m)
      needed = needs_distance(world, view, first + static_cast<Vec3d>(neighbour_offset(m)) + Vec3d{0.5, 0.5, 0.5});
    cells |= static_cast<std::uint64_t>(needed) << n;
  }
  return cells;
}

}  // namespace

/// Null if no collider is near.
template <class R>
std::unique_ptr<Obstacles::Near> Obstacles::find(const World<R>& world, const Vec3i& block) const {
  // Half the diagonal of the block and the kernel's reach.
  const ColliderView view(world, block, copies_);
  const std::vector<std::uint16_t> colliders = view.within(2.6 + 1.5);
  if (colliders.empty()) return nullptr;
  auto near = std::make_unique<Near>();
  Distances distances;
  for (const std::uint16_t c : colliders) {
    add_nodes(view, c, near->nodes);
    if (!world.colliders[c].holds) distances.add(view, c);
  }
  share_kernels(view, near->nodes);
  add_points(world, block, view, near->points);
  if (const std::uint64_t cells = thin_cells(world, view)) near->thin = std::make_unique<const Thin>(Thin{view, cells});
  for (int n = 0; n < block_nodes; ++n) near->clearance[static_cast<std::size_t>(n)] = distances.clearance(n);
  return near;
}

template <class R>
void Obstacles::prepare(const World<R>& world) {
  any_ = !world.colliders.empty();
  const BlockList& grid = world.grid.blocks;
  before_.swap(by_block_);
  by_block_.assign(grid.size(), nullptr);
  if (!any_) {
    blocks_.clear(), clearance_.clear();
    return;
  }
  // Most blocks were in the last grid too: both lists are in order.
  fresh_.clear();
  const Vec3i first{world.low.x >> 2, world.low.y >> 2, world.low.z >> 2};
  for (std::size_t b = 0, old = 0; b < grid.size(); ++b) {
    while (old < blocks_.size() && before(blocks_[old], grid[b] - first)) ++old;
    if (old < blocks_.size() && blocks_[old] == grid[b] - first) {
      by_block_[b] = before_[old];
      continue;
    }
    const auto known = cache_.find(grid[b] - first);
    if (known == cache_.end())
      fresh_.push_back(static_cast<std::uint32_t>(b));
    else
      by_block_[b] = known->second.get();
  }
  blocks_.clear();
  for (const Vec3i& b : grid.all()) blocks_.push_back(b - first);
  if (!fresh_.empty()) look_up(world);

  refit(clearance_, grid.size() * block_nodes);
  parallel_for(grid.size(), 64, [&](std::size_t b) {
    Node<float>* const to = clearance_.data() + b * block_nodes;
    if (by_block_[b])
      std::copy_n(by_block_[b]->clearance.data(), block_nodes, to);
    else
      std::fill_n(to, block_nodes, far_away);
  });
}

template <class R>
void Obstacles::look_up(const World<R>& world) {
  const BlockList& grid = world.grid.blocks;
  const Vec3i first{world.low.x >> 2, world.low.y >> 2, world.low.z >> 2};
  if (copies_.size() != world.colliders.size())
    for (const Collider& c : world.colliders) copies_.push_back(periodic_copies(world, *c.shape));
  std::vector<std::unique_ptr<Near>> found(fresh_.size());
  parallel_for(fresh_.size(), 8, [&](std::size_t i) { found[i] = find(world, grid[fresh_[i]]); });
  for (std::size_t i = 0; i < fresh_.size(); ++i) {
    auto& entry = cache_[grid[fresh_[i]] - first];
    entry = std::move(found[i]);
    by_block_[fresh_[i]] = entry.get();
    any_thin_ = any_thin_ || (entry && entry->thin);
  }
}

template void Obstacles::prepare(const World<float>&);
template void Obstacles::prepare(const World<double>&);

}  // namespace dreampm

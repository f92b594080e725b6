#include "dreampm/solver/projection/cut_cells.h"

#include <algorithm>
#include <cmath>

namespace dreampm {
namespace {

/// Nodes beside a block that the kernels of its cells reach, to either side, and in all.
constexpr int node_halo = 1;
constexpr int nodes_along = block_width + 3;

/// Samples along an edge of a face, and along one of a cell's kernel, which is two cells wide.
constexpr int face_samples = 8, kernel_samples = 8;

/// Less of a face is closed: a matrix with such a sliver is ill-conditioned.
constexpr double least_open = 0.02;

/// Cells from the middle of a block within which a surface may cut it, or the kernel of one of its
/// cells.
constexpr double block_reach = 6;

/// Particles are put so far out of a collider that they are nearer than half of it [cells].
constexpr double least_gap = 2e-3;

/// Distances from colliders at the nodes of a block and of those beside it [cells].
struct NodeDistances {
  std::array<double, nodes_along * nodes_along * nodes_along> at;
  double operator()(int i, int j, int k) const {
    return at[static_cast<std::size_t>(((i + node_halo) * nodes_along + j + node_halo) * nodes_along + k + node_halo)];
  }
  explicit NodeDistances(const ColliderView& view) {
    std::array<Vec3d, nodes_along * nodes_along> places;
    for (int i = 0; i < nodes_along; ++i) {
      for (int n = 0; n < nodes_along * nodes_along; ++n)
        places[static_cast<std::size_t>(n)] = {static_cast<double>(i - node_halo),
                                               static_cast<double>(n / nodes_along - node_halo),
                                               static_cast<double>(n % nodes_along - node_halo)};
      view.nearest(places, at.data() + i * nodes_along * nodes_along);
    }
  }
};

/// The part of a unit square whose corners are that far from a surface that lies outside of it.
double open_part(double a, double b, double c, double d) {
  int open = 0;
  for (int i = 0; i < face_samples; ++i)
    for (int j = 0; j < face_samples; ++j) {
      const double u = (i + 0.5) / face_samples, v = (j + 0.5) / face_samples;
      open += (1 - u) * ((1 - v) * a + v * b) + u * ((1 - v) * c + v * d) > 0;
    }
  const double part = static_cast<double>(open) / (face_samples * face_samples);
  return part < least_open ? 0 : part;
}

/// The part of the kernel of a cell, a tent two cells wide, that lies outside of colliders.
double open_kernel(const NodeDistances& d, const Vec3i& cell) {
  double open = 0, all = 0;
  const auto sample = [](int n) { return (n + 0.5) * 2 / kernel_samples - 1; };  // from the cell's center
  for (int i = 0; i < kernel_samples; ++i)
    for (int j = 0; j < kernel_samples; ++j)
      for (int k = 0; k < kernel_samples; ++k) {
        const double o[3] = {sample(i), sample(j), sample(k)};
        int first[3];
        double way[3], w = 1;
        for (int a = 0; a < 3; ++a) {
          const double at = cell[a] + 0.5 + o[a];
          first[a] = static_cast<int>(std::floor(at));
          way[a] = at - first[a], w *= 1 - std::abs(o[a]);
        }
        const auto along_z = [&](int x, int y) {
          const double low = d(first[0] + x, first[1] + y, first[2]),
                       high = d(first[0] + x, first[1] + y, first[2] + 1);
          return low + way[2] * (high - low);
        };
        const auto along_y = [&](int x) {
          const double low = along_z(x, 0), high = along_z(x, 1);
          return low + way[1] * (high - low);
        };
        const double low = along_y(0), high = along_y(1);
        all += w;
        if (low + way[0] * (high - low) > 0) open += w;
      }
  return open / all;
}

}  // namespace

template <class R>
std::unique_ptr<typename CutCells<R>::Block> CutCells<R>::cut_block(const World<R>& world, const Vec3i& block) const {
  const ColliderView view(world, block, placed_, ColliderView::See::all);
  if (view.within(block_reach).empty()) return nullptr;
  const NodeDistances d(view);
  // A distance changes by no more than the way: no surface is near where all nodes are a cell's
  // diagonal away.
  if (*std::min_element(d.at.begin(), d.at.end()) > 1.8) return nullptr;
  auto cut = std::make_unique<Block>();
  for (int n = 0; n < block_nodes; ++n) {
    const Vec3i c = node_offset(n);
    const auto at = static_cast<std::size_t>(n);
    const auto [i, j, k] = c;
    cut->open[0][at] = static_cast<R>(open_part(d(i, j, k), d(i, j, k + 1), d(i, j + 1, k), d(i, j + 1, k + 1)));
    cut->open[1][at] = static_cast<R>(open_part(d(i, j, k), d(i, j, k + 1), d(i + 1, j, k), d(i + 1, j, k + 1)));
    cut->open[2][at] = static_cast<R>(open_part(d(i, j, k), d(i, j + 1, k), d(i + 1, j, k), d(i + 1, j + 1, k)));
    cut->room[at] = static_cast<R>(open_kernel(d, c));
  }
  return cut;
}

template <class R>
void CutCells<R>::see(const World<R>& world) {
  const auto as_before = [](const PlacedCollider& a, const Collider& b) {
    return a.collider.name == b.name && a.collider.shape == b.shape && a.collider.surface_pose == b.surface_pose;
  };
  const bool others = placed_.size() != world.colliders.size() ||
                      !std::equal(placed_.begin(), placed_.end(), world.colliders.begin(),
                                  [](const auto& a, const auto& b) { return a.collider.name == b.name; });
  if (others) blocks_.clear();
  // What is near a collider where it was, and where it is.
  std::vector<PlacedCollider> moved;
  std::vector<PlacedCollider> now;
  for (std::size_t c = 0; c < world.colliders.size(); ++c) {
    const Collider& collider = world.colliders[c];
    now.push_back({collider, periodic_copies(world, collider)});
    if (!others && !as_before(placed_[c], collider)) moved.push_back(placed_[c]), moved.push_back(now.back());
  }
  placed_ = std::move(now);
  any_moves_ =
      std::any_of(world.colliders.begin(), world.colliders.end(), [](const Collider& c) { return !c.stands(); });
  if (moved.empty()) return;
  std::erase_if(blocks_, [&](const auto& entry) {
    const Vec3d middle = world.node_position(entry.first * block_width) + Vec3d{1.5, 1.5, 1.5} * world.dx;
    return std::any_of(moved.begin(), moved.end(),
                       [&](const PlacedCollider& c) { return c.distance(middle) <= block_reach * world.dx; });
  });
}

template <class R>
void CutCells<R>::find_velocities(const World<R>& world, const Vec3i& block, MacGrid<R>& grid) const {
  for_closed(world, grid, block, [&](const ClosedFace& face) {
    const Vec3d velocity = face.view.velocity(face.view.nearest_collider(face.middle), face.middle);
    grid.solid[static_cast<std::size_t>(face.axis)][face.place] = static_cast<R>(velocity[face.axis]);
  });
}

template <class R>
void CutCells<R>::cut(const World<R>& world, MacGrid<R>& grid) {
  see(world);
  if (placed_.empty()) return;
  const std::vector<Vec3i>& blocks = world.grid.blocks.all();
  std::vector<std::unique_ptr<Block>*> wanted;
  std::vector<Vec3i> fresh;
  for (const Vec3i& b : blocks)
    if (const auto [at, is_new] = blocks_.try_emplace(b); is_new) wanted.push_back(&at->second), fresh.push_back(b);
  parallel_for(fresh.size(), 1, [&](std::size_t n) { *wanted[n] = cut_block(world, fresh[n]); });
  parallel_for(blocks.size(), 16, [&](std::size_t b) {
    const Block* const cut = blocks_.find(blocks[b])->second.get();
    if (!cut) return;
    grid.cells.for_block(blocks[b], [&](std::size_t n, std::size_t at) {
      for (std::size_t a = 0; a < 3; ++a) grid.open[a][at] *= cut->open[a][n];
      grid.room[at] = cut->room[n];
    });
    if (any_moves_) find_velocities(world, blocks[b], grid);
  });
}

template <class R>
CutCells<R>::Rescue::Rescue(const World<R>& world, const CutCells& cells, const Vec3i& block)
    : block_(static_cast<Vec3d>(block * block_width)) {
  if (!cells.any()) return;
  // A particle goes a block on at most, and twice as far in a step that is sorted twice.
  constexpr double reach = 2.5 * block_width;
  ColliderView view(world, block, cells.placed_, ColliderView::See::all);
  if (!view.within(reach).empty()) view_ = std::move(view);
}

template <class R>
void CutCells<R>::Rescue::operator()(const Vec3i& first, Vec3<R>& x) const {
  const Vec3d at = static_cast<Vec3d>(x) + static_cast<Vec3d>(first) - block_;
  const ColliderDistance found = view_->nearest_exposed(at, least_gap);
  if (!(found.distance < least_gap / 2)) return;
  x += static_cast<Vec3<R>>(found.normal * (least_gap - found.distance));
}

template class CutCells<float>;
template class CutCells<double>;

}  // namespace dreampm

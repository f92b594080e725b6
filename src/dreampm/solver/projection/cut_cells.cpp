#include "dreampm/solver/projection/cut_cells.h"

#include <algorithm>
#include <cmath>

namespace dreampm {
namespace {

/// Samples along an edge of a face, and along one of a cell's kernel, which is two cells wide.
constexpr int face_samples = 8, kernel_samples = 8;

/// Less of a face is closed: a matrix with such a sliver is ill-conditioned.
constexpr double least_open = 0.02;

/// Cells from the middle of a block within which a surface may cut it, or the kernel of one of its
/// cells.
constexpr double block_reach = 6;

/// Particles are put so far out of a collider that they are nearer than half of it [cells].
constexpr double least_gap = 2e-3;

/// What colliders leave of a face, and the middle of what they close, along the two axes after its
/// own, from 0 to 1.
struct FacePart {
  double open = 1, along = 0.5, up = 0.5;
};
/// Of a unit square whose corners are that far from a surface that lies outside of it.
FacePart face_part(double low, double along, double up, double both) {
  if (std::min({low, along, up, both}) > 0) return {1};
  if (!(std::max({low, along, up, both}) > 0)) return {0};
  int closed = 0;
  double sum_along = 0, sum_up = 0;
  for (int i = 0; i < face_samples; ++i)
    for (int j = 0; j < face_samples; ++j) {
      const double u = (i + 0.5) / face_samples, v = (j + 0.5) / face_samples;
      if ((1 - u) * ((1 - v) * low + v * along) + u * ((1 - v) * up + v * both) > 0) continue;
      ++closed;
      sum_along += v, sum_up += u;
    }
  const double part = 1 - static_cast<double>(closed) / (face_samples * face_samples);
  if (part < least_open) return {0};
  if (closed == 0) return {1};
  return {part, sum_along / closed, sum_up / closed};
}

/// Where the samples of a cell's kernel along an axis lie: between which nodes, counted from the
/// one before the cell, how far on, and what the kernel is there.
struct KernelSamples {
  int first[kernel_samples];
  double way[kernel_samples], weight[kernel_samples];
  constexpr KernelSamples() : first{}, way{}, weight{} {
    for (int n = 0; n < kernel_samples; ++n) {
      const double from_center = (n + 0.5) * 2 / kernel_samples - 1, at = 1.5 + from_center;
      first[n] = static_cast<int>(at), way[n] = at - first[n];
      weight[n] = from_center < 0 ? 1 + from_center : 1 - from_center;
    }
  }
};

/// The part of the kernel of a cell, a tent two cells wide, that lies outside of colliders.
template <class NodeDistances>
double open_kernel(const NodeDistances& d, const Vec3i& cell) {
  constexpr int nodes = 4;  // that the kernel reaches along an axis
  constexpr KernelSamples samples;
  // Axis by axis: [x][y][sample of z], [x][sample of y][sample of z].
  double along_z[nodes][nodes][kernel_samples], along_y[nodes][kernel_samples][kernel_samples];
  double least = 1e30, most = -1e30;
  for (int i = 0; i < nodes; ++i)
    for (int j = 0; j < nodes; ++j) {
      double at[nodes];
      for (int k = 0; k < nodes; ++k) {
        at[k] = d(cell.x + i - 1, cell.y + j - 1, cell.z + k - 1);
        least = std::min(least, at[k]), most = std::max(most, at[k]);
      }
      for (int n = 0; n < kernel_samples; ++n) {
        const int k = samples.first[n];
        along_z[i][j][n] = at[k] + samples.way[n] * (at[k + 1] - at[k]);
      }
    }
  if (least > 0) return 1;
  if (!(most > 0)) return 0;
  for (int i = 0; i < nodes; ++i)
    for (int m = 0; m < kernel_samples; ++m)
      for (int n = 0; n < kernel_samples; ++n) {
        const int j = samples.first[m];
        along_y[i][m][n] = along_z[i][j][n] + samples.way[m] * (along_z[i][j + 1][n] - along_z[i][j][n]);
      }
  double open = 0, all = 0;
  for (int l = 0; l < kernel_samples; ++l)
    for (int m = 0; m < kernel_samples; ++m) {
      const int i = samples.first[l];
      double part = 0, whole = 0;
      for (int n = 0; n < kernel_samples; ++n) {
        const double low = along_y[i][m][n], at = low + samples.way[l] * (along_y[i + 1][m][n] - low);
        part += at > 0 ? samples.weight[n] : 0;
        whole += samples.weight[n];
      }
      open += samples.weight[l] * samples.weight[m] * part, all += samples.weight[l] * samples.weight[m] * whole;
    }
  return open / all;
}

}  // namespace

template <class R>
CutCells<R>::NodeDistances::NodeDistances(const ColliderView& view) {
  constexpr int layer = nodes_along * nodes_along;
  std::array<Vec3d, layer> places;
  std::array<double, layer> found;
  for (int i = 0; i < nodes_along; ++i) {
    for (int n = 0; n < layer; ++n)
      places[static_cast<std::size_t>(n)] = {static_cast<double>(i - node_halo),
                                             static_cast<double>(n / nodes_along - node_halo),
                                             static_cast<double>(n % nodes_along - node_halo)};
    view.nearest(places, found.data());
    std::copy(found.begin(), found.end(), at.begin() + i * layer);
  }
}

template <class R>
Vec3d CutCells<R>::middle_of_closed(const Block& cut, std::size_t axis, std::size_t n) {
  Vec3d middle{};
  middle[static_cast<int>(axis + 1) % 3] = static_cast<double>(cut.along[axis][n]);
  middle[static_cast<int>(axis + 2) % 3] = static_cast<double>(cut.up[axis][n]);
  return middle;
}

template <class R>
Vec3d CutCells<R>::to_surface(const Block& cut, const Vec3i& cell) {
  double distance = 0;
  Vec3d slope{};
  for (int n = 0; n < 8; ++n) {
    const Vec3i side{n >> 2, n >> 1 & 1, n & 1};
    const double d = cut.distances(cell.x + side.x, cell.y + side.y, cell.z + side.z);
    distance += d / 8;
    for (int a = 0; a < 3; ++a) slope[a] += side[a] ? d / 4 : -d / 4;
  }
  const double steep = length(slope);
  return steep > 0 ? slope * (-distance / steep) : Vec3d{};
}

template <class R>
std::unique_ptr<typename CutCells<R>::Block> CutCells<R>::cut_block(const World<R>& world, const Vec3i& block) const {
  const ColliderView view(world, block, placed_, ColliderView::See::all);
  if (view.within(block_reach).empty()) return nullptr;
  const NodeDistances d(view);
  // A distance changes by no more than the way: no surface is near where all nodes are a cell's
  // diagonal away.
  if (*std::min_element(d.at.begin(), d.at.end()) > 1.8f) return nullptr;
  auto cut = std::make_unique<Block>(d);
  for (int n = 0; n < block_nodes; ++n) {
    const Vec3i c = node_offset(n);
    const auto at = static_cast<std::size_t>(n);
    for (std::size_t a = 0; a < 3; ++a) {
      // The corners of the low face.
      Vec3i along{}, up{};
      along[static_cast<int>(a + 1) % 3] = 1, up[static_cast<int>(a + 2) % 3] = 1;
      const auto corner = [&](const Vec3i& node) { return d(node.x, node.y, node.z); };
      const double corners[4] = {corner(c), corner(c + along), corner(c + up), corner(c + along + up)};
      const FacePart part = face_part(corners[0], corners[1], corners[2], corners[3]);
      cut->open[a][at] = static_cast<R>(part.open);
      cut->along[a][at] = static_cast<R>(part.along), cut->up[a][at] = static_cast<R>(part.up);
      cut->gap[a][at] = static_cast<R>((corners[0] + corners[1] + corners[2] + corners[3]) / 4);
    }
    cut->room[at] = static_cast<R>(open_kernel(d, c));
    for (std::size_t a = 0; a < 3; ++a)
      cut->owner[a][at] = cut->open[a][at] < R(1)
                              ? view.nearest_collider(static_cast<Vec3d>(c) + face_middle(static_cast<int>(a), false))
                              : MacGrid<R>::no_owner;
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
  if (moved.empty()) return;
  std::erase_if(blocks_, [&](const auto& entry) {
    const Vec3d middle = world.node_position(entry.first * block_width) + Vec3d{1.5, 1.5, 1.5} * world.dx;
    return std::any_of(moved.begin(), moved.end(),
                       [&](const PlacedCollider& c) { return c.distance(middle) <= block_reach * world.dx; });
  });
}

template <class R>
void CutCells<R>::find_velocities(const World<R>& world, MacGrid<R>& grid) const {
  if (grid.solid[0].empty()) return;
  const std::vector<Vec3i>& blocks = world.grid.blocks.all();
  parallel_for(blocks.size(), 16, [&](std::size_t b) {
    const Block* const cut = blocks_.find(blocks[b])->second.get();
    if (!cut) return;
    const ColliderView view(world, blocks[b], placed_, ColliderView::SinglesOnly{});
    grid.cells.for_block(blocks[b], [&](std::size_t n, std::size_t at) {
      for (std::size_t a = 0; a < 3; ++a) {
        const std::uint16_t owner = cut->owner[a][n];
        if (owner == grid.no_owner) continue;
        const Vec3d place = static_cast<Vec3d>(node_offset(static_cast<int>(n))) + middle_of_closed(*cut, a, n);
        grid.solid[a][at] = static_cast<R>(view.velocity(owner, place)[static_cast<int>(a)]);
      }
    });
  });
  for (auto& f : grid.solid) grid.wrap(f);
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
      for (std::size_t a = 0; a < 3; ++a) {
        grid.open[a][at] *= cut->open[a][n];
        grid.owner[a][at] = cut->owner[a][n];
        if (!grid.gap[a].empty()) grid.gap[a][at] = cut->gap[a][n];
      }
      grid.room[at] = cut->room[n];
    });
  });
  for (std::size_t a = 0; a < 3; ++a) grid.wrap(grid.open[a]), grid.wrap(grid.owner[a]), grid.wrap(grid.gap[a]);
  grid.wrap(grid.room);
  find_velocities(world, grid);
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

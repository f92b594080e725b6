#include "dreampm/solver/projection/cut_cells.h"

#include <algorithm>
#include <cmath>

namespace dreampm {
namespace {

/// Samples along half an edge of a face, and along half an edge of a cell.
constexpr int face_samples = 4, cell_samples = 2;

/// Less of a face is closed: a matrix with such a sliver is ill-conditioned.
constexpr double least_open = 0.02;

/// Cells from the middle of a block within which a surface may cut it, or the kernel of one of its
/// cells.
constexpr double block_reach = 6;

/// Particles are put so far out of a collider that they are nearer than half of it [cells].
constexpr double least_gap = 2e-3;

/// They go beside colliders in pieces no longer than this [cells], or than the way to the nearest.
constexpr double longest_piece = 0.4;

/// Distances from colliders [cells] at places that are half a cell apart, for edges and corners of
/// colliders: those of a block, and beside it as far as the kernels of its cells reach.
class NodeDistances {
 public:
  explicit NodeDistances(const ColliderView& view) {
    std::array<Vec3d, layer> places;
    std::array<double, layer> found;
    for (int i = 0; i < along; ++i) {
      for (int n = 0; n < layer; ++n)
        places[static_cast<std::size_t>(n)] =
            Vec3d{static_cast<double>(i - halo), static_cast<double>(n / along - halo),
                  static_cast<double>(n % along - halo)} *
            0.5;
      view.nearest(places, found.data());
      std::copy(found.begin(), found.end(), at_.begin() + i * layer);
    }
  }
  /// `place`: from the block's first node, in half cells.
  double operator()(const Vec3i& place) const {
    const Vec3i n = place + Vec3i{halo, halo, halo};
    return static_cast<double>(at_[static_cast<std::size_t>(n.x * layer + n.y * along + n.z)]);
  }
  double least() const { return static_cast<double>(*std::min_element(at_.begin(), at_.end())); }

 private:
  static constexpr int halo = 1, along = 2 * block_width + 1 + 2 * halo, layer = along * along;
  std::array<float, along * layer> at_;
};

/// The part of a sample's surroundings that is open, by the distance at its middle from a surface,
/// which changes by `width` across them.
double open_part(double distance, double width) {
  if (std::abs(distance) >= width / 2) return distance > 0 ? 1 : 0;
  return 0.5 + distance / width;
}

/// Part of a square or a cube that is closed, and its first moment about the corner of lowest
/// coordinates, in units of their edge.
struct ClosedSquare {
  double part = 0, along = 0, up = 0;
};
struct ClosedCube {
  double part = 0;
  Vec3d moment;
};

/// Returns the closed part of a square whose corners are that far [edges] from a surface.
ClosedSquare closed_square(double low, double along, double up, double both) {
  if (std::min({low, along, up, both}) > 0) return {};
  if (!(std::max({low, along, up, both}) > 0)) return {1, 0.5, 0.5};
  ClosedSquare closed;
  constexpr double each = 1.0 / (face_samples * face_samples);
  for (int i = 0; i < face_samples; ++i)
    for (int j = 0; j < face_samples; ++j) {
      const double u = (i + 0.5) / face_samples, v = (j + 0.5) / face_samples;
      const double slope_along = (1 - u) * (along - low) + u * (both - up),
                   slope_up = (1 - v) * (up - low) + v * (both - along);
      const double distance = (1 - u) * ((1 - v) * low + v * along) + u * ((1 - v) * up + v * both);
      const double part = each * (1 - open_part(distance, (std::abs(slope_along) + std::abs(slope_up)) / face_samples));
      closed.part += part, closed.along += part * v, closed.up += part * u;
    }
  return closed;
}

/// Returns the closed part of a cube with such corners, by x, y, z.
ClosedCube closed_cube(const double (&at)[8]) {
  if (*std::min_element(at, at + 8) > 0) return {};
  if (!(*std::max_element(at, at + 8) > 0)) return {1, {0.5, 0.5, 0.5}};
  ClosedCube closed;
  constexpr double each = 1.0 / (cell_samples * cell_samples * cell_samples);
  for (int i = 0; i < cell_samples; ++i)
    for (int j = 0; j < cell_samples; ++j)
      for (int k = 0; k < cell_samples; ++k) {
        const Vec3d w = Vec3d{i + 0.5, j + 0.5, k + 0.5} * (1.0 / cell_samples);
        double along_z[4], along_y[2];
        for (int n = 0; n < 4; ++n) along_z[n] = at[2 * n] + w.z * (at[2 * n + 1] - at[2 * n]);
        for (int n = 0; n < 2; ++n) along_y[n] = along_z[2 * n] + w.y * (along_z[2 * n + 1] - along_z[2 * n]);
        const double part = each * (1 - open_part(along_y[0] + w.x * (along_y[1] - along_y[0]), 1.0 / cell_samples));
        closed.part += part, closed.moment += w * part;
      }
  return closed;
}

/// The part of a face that colliders leave open, and the middle of the closed part, along the two
/// axes after its own, from 0 to 1.
struct FacePart {
  double open = 1, along = 0.5, up = 0.5;
};
/// `d`: of places in half cells.
FacePart face_part(const NodeDistances& d, const Vec3i& low, int axis) {
  Vec3i along{}, up{};
  along[(axis + 1) % 3] = 1, up[(axis + 2) % 3] = 1;
  ClosedSquare closed;
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 2; ++j) {
      const Vec3i at = low + up * i + along * j;
      const ClosedSquare quarter = closed_square(2 * d(at), 2 * d(at + along), 2 * d(at + up), 2 * d(at + along + up));
      closed.part += quarter.part / 4;
      closed.along += (quarter.along + j * quarter.part) / 8, closed.up += (quarter.up + i * quarter.part) / 8;
    }
  if (1 - closed.part < least_open) return {0};
  if (!(closed.part > 0)) return {1};
  return {1 - closed.part, closed.along / closed.part, closed.up / closed.part};
}

/// The volume that colliders fill of each eighth of a block's cells, and of those on its low sides.
class Eighths {
 public:
  explicit Eighths(const NodeDistances& d) {
    for (int n = 0; n < along * along * along; ++n) {
      const Vec3i low = Vec3i{n / (along * along), n / along % along, n % along} - Vec3i{1, 1, 1};
      double at[8];
      for (int m = 0; m < 8; ++m) at[m] = 2 * d(low + Vec3i{m >> 2, m >> 1 & 1, m & 1});
      filled_[static_cast<std::size_t>(n)] = closed_cube(at);
    }
  }
  /// Returns the closed part of the cube of eight whose first is `low`, with its moment about its
  /// low corner [cells].
  ClosedCube of_cube(const Vec3i& low) const {
    ClosedCube filled;
    for (int n = 0; n < 8; ++n) {
      const Vec3i eighth{n >> 2, n >> 1 & 1, n & 1}, at = low + eighth + Vec3i{1, 1, 1};
      const ClosedCube& part = filled_[static_cast<std::size_t>((at.x * along + at.y) * along + at.z)];
      filled.part += part.part / 8, filled.moment += (part.moment + static_cast<Vec3d>(eighth) * part.part) / 16;
    }
    return filled;
  }

 private:
  static constexpr int along = 2 * block_width + 1;
  std::array<ClosedCube, along * along * along> filled_;
};

/// The part of the kernel of a cell, a tent two cells wide, that lies outside of colliders.
double open_kernel(const NodeDistances& d, const Vec3i& low) {
  constexpr int nodes = 5, samples = 8;  // along an axis: two samples between two nodes
  // Axis by axis: [x][y][sample of z], [x][sample of y][sample of z].
  double along_z[nodes][nodes][samples], along_y[nodes][samples][samples], weight[samples];
  double least = 1e30, most = -1e30;
  constexpr double way[2] = {0.25, 0.75};
  for (int n = 0; n < samples; ++n) weight[n] = (n < samples / 2 ? n + 0.5 : samples - n - 0.5) / 16;
  for (int i = 0; i < nodes; ++i)
    for (int j = 0; j < nodes; ++j) {
      double at[nodes];
      for (int k = 0; k < nodes; ++k) {
        at[k] = d(low + Vec3i{i - 1, j - 1, k - 1});
        least = std::min(least, at[k]), most = std::max(most, at[k]);
      }
      for (int n = 0; n < samples; ++n) along_z[i][j][n] = at[n / 2] + way[n % 2] * (at[n / 2 + 1] - at[n / 2]);
    }
  if (least > 0) return 1;
  if (!(most > 0)) return 0;
  for (int i = 0; i < nodes; ++i)
    for (int m = 0; m < samples; ++m)
      for (int n = 0; n < samples; ++n)
        along_y[i][m][n] = along_z[i][m / 2][n] + way[m % 2] * (along_z[i][m / 2 + 1][n] - along_z[i][m / 2][n]);
  double open = 0;
  for (int l = 0; l < samples; ++l)
    for (int m = 0; m < samples; ++m) {
      double part = 0;
      for (int n = 0; n < samples; ++n) {
        const double from = along_y[l / 2][m][n], at = from + way[l % 2] * (along_y[l / 2 + 1][m][n] - from);
        part += weight[n] * open_part(at, 2.0 / samples);
      }
      open += weight[l] * weight[m] * part;
    }
  return open;
}

}  // namespace

template <class R>
Vec3d CutCells<R>::middle_of_closed(const Block& cut, std::size_t axis, std::size_t n) {
  Vec3d middle{};
  middle[static_cast<int>(axis + 1) % 3] = static_cast<double>(cut.along[axis][n]);
  middle[static_cast<int>(axis + 2) % 3] = static_cast<double>(cut.up[axis][n]);
  return middle;
}

template <class R>
std::unique_ptr<typename CutCells<R>::Block> CutCells<R>::cut_block(const World<R>& world, const Vec3i& block) const {
  const ColliderView view(world, block, placed_, ColliderView::See::all);
  if (view.within(block_reach).empty()) return nullptr;
  const NodeDistances d(view);
  // A distance changes by no more than the way: no surface is near where all nodes are a cell's
  // diagonal away.
  if (d.least() > 1.8) return nullptr;
  auto cut = std::make_unique<Block>();
  const Eighths eighths(d);
  for (int n = 0; n < block_nodes; ++n) {
    const Vec3i c = node_offset(n);
    const auto at = static_cast<std::size_t>(n);
    const Vec3i low = c * 2;
    for (std::size_t a = 0; a < 3; ++a) {
      const FacePart part = face_part(d, low, static_cast<int>(a));
      cut->open[a][at] = static_cast<R>(part.open);
      cut->along[a][at] = static_cast<R>(part.along), cut->up[a][at] = static_cast<R>(part.up);
      Vec3i middle = low + Vec3i{1, 1, 1};
      middle[static_cast<int>(a)] -= 1;
      cut->gap[a][at] = static_cast<R>(d(middle));
      Vec3i across, beside = low - Vec3i{1, 1, 1};
      across[static_cast<int>(a)] = 1, beside[static_cast<int>(a)] += 1;
      cut->filled_at_face[a][at] = static_cast<R>(eighths.of_cube(low - across).part);
      cut->filled_at_edge[a][at] = static_cast<R>(eighths.of_cube(beside).part);
    }
    cut->room[at] = static_cast<R>(open_kernel(d, low));
    const ClosedCube filled = eighths.of_cube(low);
    cut->filled[at] = static_cast<R>(filled.part);
    cut->filled_middle[at] = static_cast<Vec3<R>>(filled.part > 0 ? filled.moment / filled.part : filled.moment);
    cut->filler[at] =
        filled.part > 0 ? view.nearest_collider(static_cast<Vec3d>(c) + Vec3d{0.5, 0.5, 0.5}) : MacGrid<R>::no_owner;
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
  // The moved colliders, where they were and where they are.
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
CutCells<R>::Collisions::Collisions(const World<R>& world, const CutCells& cells, const Vec3i& block, double dt)
    : block_(static_cast<Vec3d>(block * block_width)), way_(dt / world.dx) {
  if (!cells.any()) return;
  // A particle goes a block on at most, and twice as far in a step that is sorted twice.
  constexpr double reach = 2.5 * block_width;
  ColliderView view(world, block, cells.placed_, ColliderView::See::all);
  if (!view.within(reach).empty()) view_ = std::move(view);
}

template <class R>
void CutCells<R>::Collisions::put_out(const Vec3d& from, Vec3d& at, Surface& met) const {
  const ColliderDistance found = view_->nearest_exposed(at, least_gap);
  if (!(found.distance < least_gap / 2)) return;
  met.normal = found.normal, met.velocity = view_->velocity(view_->nearest_collider(at), at);
  const Vec3d out = at + found.normal * (least_gap - found.distance);
  const double into = longest_piece + length(met.velocity) * way_, before = view_->nearest(from);
  const bool through = found.distance < -into && before > -into;
  if (!through && view_->nearest(out) >= std::min(before, 0.0)) {
    at = out;
    return;
  }
  const Vec3d back = from - at;
  if (const double gone = length(back); gone > 0) met.normal = back / gone;
  at = from;
}

template <class R>
typename CutCells<R>::Collisions::Surface CutCells<R>::Collisions::operator()(const Vec3i& first, const Vec3<R>& from,
                                                                              Vec3<R>& x) const {
  const Vec3d origin = block_ - static_cast<Vec3d>(first), end = static_cast<Vec3d>(x) - origin;
  Surface met{};
  Vec3d at = static_cast<Vec3d>(from) - origin, way = end - at;
  double left = length(way);
  while (left > longest_piece) {
    const double distance = view_->nearest(at);
    if (distance > left) break;
    const Vec3d piece = way * (std::max(distance, longest_piece) / left), before = at;
    Surface here{};
    at += piece, way -= piece;
    put_out(before, at, here);
    if (here.normal != Vec3d{}) {
      way -= here.normal * std::min(dot(way, here.normal), 0.0);
      met = here;
    }
    left = length(way);
  }
  const Vec3d before = at;
  at = met.normal == Vec3d{} ? end : at + way;
  put_out(before, at, met);
  if (met.normal == Vec3d{}) return met;
  const Vec3d start = static_cast<Vec3d>(from) - origin;
  met.part = std::min(1.0, length(at - start) / std::max(length(end - start), 1e-9));
  x = static_cast<Vec3<R>>(at + origin);
  return met;
}

template class CutCells<float>;
template class CutCells<double>;

}  // namespace dreampm

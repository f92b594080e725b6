// Where a particle has moved to since the last sort: which block around its own, and which cell of
// that. Compilers of device code read it too.
#pragma once
#include <cstdint>

#include "dreampm/state/node.h"

namespace dreampm {

/// -1, 0 or 1: to which side of its block a position has moved along an axis. `u`: as in
/// ParticleSet::u.
template <class R>
DM_FN int side_of(R u) {
  return 1 - (u < R(block_width)) - (u < R(0));
}
/// The number of the block that it lies in now among the 27 around its own, as neighbor_offset.
template <class R>
DM_FN int neighbor_of(const Vec3<R>& u) {
  return ((side_of(u.x) + 1) * 3 + side_of(u.y) + 1) * 3 + side_of(u.z) + 1;
}
/// The same position seen from the block on that side.
template <class R>
DM_FN R seen_there(R u) {
  return u - static_cast<R>(block_width * side_of(u));
}
/// The cell that it lies in there, along an axis.
template <class R>
DM_FN int cell_of(R u) {
  const int towards_zero = static_cast<int>(u);
  return (towards_zero - (u < static_cast<R>(towards_zero))) & (block_width - 1);
}

/// The cell that a sorted particle lies in, by node_index(). A place just before the end of its
/// block may be rounded to that.
template <class R>
DM_FN int held_cell(const Vec3<R>& u) {
  const auto cell = [](R at) {
    const int c = static_cast<int>(at);
    return c < 0 ? 0 : c < block_width ? c : block_width - 1;
  };
  return node_index(cell(u.x), cell(u.y), cell(u.z));
}

/// Returns the place of a cell in the order of a block: row after row along z, each beside the one
/// before, so that those of two rows that share a vector of lanes share nodes as well.
constexpr int turn_of(int i, int j, int k) { return node_index(i, j ^ ((i & 1) * (block_width - 1)), k); }
template <class R>
DM_FN int turn_of(const Vec3<R>& u) {
  return turn_of(cell_of(u.x), cell_of(u.y), cell_of(u.z));
}
/// The cell that comes at a turn, by node_index().
constexpr int cell_at(int turn) {
  const int i = turn / (block_width * block_width), j = turn / block_width % block_width;
  return node_index(i, j ^ ((i & 1) * (block_width - 1)), turn % block_width);
}

}  // namespace dreampm

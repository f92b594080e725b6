// A node of the grid, and the places of nodes in their block: what code for devices sees of the
// grid too.
#pragma once
#include <cstdint>

#include "dreampm/math/vec.h"

namespace dreampm {

inline constexpr int block_width = 4;
inline constexpr int block_nodes = block_width * block_width * block_width;

/// Momentum [kg m/s] and mass [kg] between steps; after grid_update velocity [m/s] and mass.
template <class R>
struct alignas(4 * sizeof(R)) Node {
  R x{}, y{}, z{}, m{};
  friend DM_FN Node operator+(const Node& a, const Node& b) { return {a.x + b.x, a.y + b.y, a.z + b.z, a.m + b.m}; }
  friend DM_FN Node operator-(const Node& a, const Node& b) { return {a.x - b.x, a.y - b.y, a.z - b.z, a.m - b.m}; }
  friend DM_FN Node operator*(const Node& a, R s) { return {a.x * s, a.y * s, a.z * s, a.m * s}; }
  friend DM_FN Node mul_add(const Node& a, R s, const Node& b) { return a * s + b; }
  friend DM_FN Node mul_sub(const Node& a, R s, const Node& b) { return a * s - b; }
};

/// The mixture: numbers of a node that the sets share, where there is matter of several kinds or a
/// collider. They lie in the members of a Node, so that all code for nodes handles them too.
namespace mixture {
/// Fraction of the node's kernel that solids and colliders take [1].
template <class N>
DM_FN constexpr auto& blocked(N& node) {
  return node.x;
}
/// Rest volume of a field's matter over dx^3 [1].
template <class N>
DM_FN constexpr auto& filled(N& node, std::size_t field) {
  return field == 0 ? node.y : node.z;
}
/// sum w m nu of the liquids [kg m^2/s].
template <class N>
DM_FN constexpr auto& viscosity(N& node) {
  return node.m;
}
}  // namespace mixture

/// Index of node (i, j, k), each in [0, 4), within its block.
constexpr int node_index(int i, int j, int k) { return (i * block_width + j) * block_width + k; }
/// The step in index from a node of a block to its neighbor along an axis.
inline constexpr int node_step[3] = {node_index(1, 0, 0), node_index(0, 1, 0), node_index(0, 0, 1)};

/// Node number `n` of a block, relative to its first node.
constexpr Vec3i node_offset(int n) {
  return {n / (block_width * block_width), n / block_width % block_width, n % block_width};
}

/// Returns the lowest node at which stencils of a block of particles begin at a sort; they begin at
/// it or one of the next three along each axis. Until the next sort they may begin one node before
/// or after these four. docs/images/blocks.svg shows it.
constexpr Vec3i first_stencil(const Vec3i& block) { return block * block_width + Vec3i{1, 1, 1}; }

}  // namespace dreampm

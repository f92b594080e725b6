// The 27 nodes around one particle: their weights, and their places in the memory of the grid's
// fields.
#pragma once
#include <cstddef>

#include "dreampm/physics/transfer.h"
#include "dreampm/state/neighbors.h"

namespace dreampm::reference {

/// The numbers of a node that make a vector: a velocity or a momentum.
template <class R>
Vec3<R> vector_of(const Node<R>& node) {
  return {node.x, node.y, node.z};
}

template <class R>
class ParticleNodes {
 public:
  /// Makes the nodes of a particle at `u`, as in ParticleSet::u, in a block of particles that
  /// reaches `blocks` of the grid.
  ParticleNodes(const StencilBlocks& blocks, const Vec3<R>& u) : stencil(make_stencil(u)), blocks_(blocks) {}

  const Stencil<R> stencil;

  /// Returns the index of node (i, j, k) of the stencil, each in [0, 3), in a field of the grid.
  std::size_t at(int i, int j, int k) const {
    // From the first node of the two by two by two blocks; stencils count from first_stencil(), the
    // second.
    const int x = stencil.node(0) + i + 1, y = stencil.node(1) + j + 1, z = stencil.node(2) + k + 1;
    const int block = (x / block_width * 2 + y / block_width) * 2 + z / block_width;
    return static_cast<std::size_t>(blocks_[static_cast<std::size_t>(block)]) * block_nodes +
           static_cast<std::size_t>(node_index(x % block_width, y % block_width, z % block_width));
  }

  /// Calls body(w_ip, i) for each node i.
  template <class Body>
  void for_each(const Body& body) const {
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        for (int k = 0; k < 3; ++k) body(stencil.weight(i, j, k), at(i, j, k));
  }

  /// sum w_ip value(i)
  template <class Value>
  auto sum(const Value& value) const {
    decltype(value(std::size_t{})) total{};
    for_each([&](R w, std::size_t node) { total += value(node) * w; });
    return total;
  }

  /// sum w_ip v_i and sum w_ip v_i (x_i - x_p)^T of the nodes of a field, and their bends where
  /// `bends` asks for them.
  template <Bends bends>
  Moments<Node<R>> moments(const Nodes<R>& field) const {
    return gather<Node<R>, bends>(stencil, [&](int i, int j) {
      return NodeRow<Node<R>>{{field[at(i, j, 0)], field[at(i, j, 1)], field[at(i, j, 2)]}};
    });
  }

  /// value(i) in rows of nodes along z, for density_state(). `value` has to outlive what this
  /// returns.
  template <class Value>
  auto splines(const Value& value) const {
    return [&](int i, int j) { return line_spline<R>(value(at(i, j, 0)), value(at(i, j, 1)), value(at(i, j, 2))); };
  }

  /// Adds w_ip (q + sum_a slope[a] (x_i - x_p)_a) to the vectors of the nodes of a field, and w_ip
  /// mass to their masses.
  void add(Nodes<R>& field, const Vec3<R>& q, const Vec3<R> (&slope)[3], R mass) const {
    const Node<R> slopes[3] = {node_of(slope[0], R(0)), node_of(slope[1], R(0)), node_of(slope[2], R(0))};
    scatter(stencil, node_of(q, mass), slopes, [&](int i, int j, int k) -> Node<R>& { return field[at(i, j, k)]; });
  }

 private:
  static Node<R> node_of(const Vec3<R>& vector, R mass) { return {vector.x, vector.y, vector.z, mass}; }

  const StencilBlocks& blocks_;
};

}  // namespace dreampm::reference

// Distances from colliders at the nodes of one block and at those beside them.
#pragma once
#include <array>

#include "dreampm/contact/collider_view.h"
#include "dreampm/contact/exposed_nodes.h"
#include "dreampm/physics/node.h"
#include "dreampm/state/grid.h"

namespace dreampm {

/// The distance [cells] from the nearest of several colliders, at most `clearance_reach` either
/// way; as much outside where there is none.
class BlockDistances {
 public:
  BlockDistances();
  /// One collider more, with the faces that matter can touch.
  void add_exposed(ExposedNodes& exposed, std::uint16_t collider);
  /// One collider more, with all of its faces.
  void add_whole(ExposedNodes& exposed, std::uint16_t collider);
  /// The colliders of `other` more.
  void add(const BlockDistances& other);

  /// Returns the distance at the block's node of that index.
  double at_node(int n) const { return d_[index(node_offset(n))]; }
  /// Returns the clearance as in Obstacles::clearance. A quadratic spline of the distances
  /// themselves would be off by an eighth of their Laplacian: by 1/4 r cells on a sphere of r
  /// cells.
  Node<float> clearance(int n) const;
  /// True if these surfaces and the other ones are so far apart, as far as the nodes show it, that
  /// no face hides another.
  bool is_apart_from(const BlockDistances& other) const;
  /// True if the surfaces are as far from the closed walls of the view.
  bool is_apart_from_walls(const ColliderView& view) const;

 private:
  static constexpr int width = block_width + 2;
  static constexpr std::size_t index(const Vec3i& node) {
    return static_cast<std::size_t>(((node.x + 1) * width + node.y + 1) * width + node.z + 1);
  }
  template <class Body>
  static void for_each_node(const Body& body);

  std::array<double, width * width * width> d_;
};

}  // namespace dreampm

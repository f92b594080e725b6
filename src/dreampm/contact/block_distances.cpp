#include "dreampm/contact/block_distances.h"

#include <algorithm>
#include <cmath>

#include "dreampm/physics/collider_contact.h"

namespace dreampm {
namespace {

constexpr double reach = ColliderContact::clearance_reach;
/// Half the diagonal of a cell: how far a surface may be from the nearest node.
constexpr double to_node = 0.87;
/// Cells from a node near a surface within which there must be no other.
constexpr double apart = to_node + ColliderView::before_face;

}  // namespace

BlockDistances::BlockDistances() { d_.fill(reach); }

template <class Body>
void BlockDistances::for_each_node(const Body& body) {
  for (int i = -1; i < width - 1; ++i)
    for (int j = -1; j < width - 1; ++j)
      for (int k = -1; k < width - 1; ++k) body(Vec3i{i, j, k});
}

void BlockDistances::add_exposed(ExposedNodes& exposed, std::uint16_t collider) {
  for_each_node([&](const Vec3i& node) {
    double& d = d_[index(node)];
    d = std::max(-reach, std::min(d, exposed.at(collider, node).distance));
  });
}

void BlockDistances::add_whole(ExposedNodes& exposed, std::uint16_t collider) {
  for_each_node([&](const Vec3i& node) {
    double& d = d_[index(node)];
    d = std::max(-reach, std::min(d, exposed.whole(collider, node)));
  });
}

void BlockDistances::add(const BlockDistances& other) {
  for (std::size_t i = 0; i < d_.size(); ++i) d_[i] = std::min(d_[i], other.d_[i]);
}

Node<float> BlockDistances::clearance(int n) const {
  const std::size_t middle = index(node_offset(n)), steps[3] = {width * width, width, 1};
  Vec3d gradient;
  double laplacian = 0;
  for (int a = 0; a < 3; ++a) {
    const double before = d_[middle - steps[a]], after = d_[middle + steps[a]];
    gradient[a] = 0.5 * (after - before), laplacian += before - 2 * d_[middle] + after;
  }
  return {static_cast<float>(gradient.x), static_cast<float>(gradient.y), static_cast<float>(gradient.z),
          static_cast<float>(d_[middle] - laplacian / 8)};
}

bool BlockDistances::is_apart_from(const BlockDistances& other) const {
  for (std::size_t i = 0; i < d_.size(); ++i)
    if (std::abs(d_[i]) <= to_node && other.d_[i] <= apart) return false;
  return true;
}

bool BlockDistances::is_apart_from_walls(const ColliderView& view) const {
  bool all = true;
  for_each_node([&](const Vec3i& node) {
    all = all && (std::abs(d_[index(node)]) > to_node || view.before_wall(static_cast<Vec3d>(node)) > apart);
  });
  return all;
}

}  // namespace dreampm

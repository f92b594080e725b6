#include "dreampm/contact/obstacle_nodes.h"

#include <algorithm>
#include <array>
#include <boost/container/small_vector.hpp>
#include <cmath>
#include <optional>
#include <tuple>
#include <vector>

#include "dreampm/physics/collider_contact.h"
#include "dreampm/state/grid.h"

namespace dreampm {
namespace {

/// True if the solid around a node is a half-space within most of the node's kernel.
bool is_plane(const ColliderView& view, const Vec3d& node) {
  constexpr double around = 0.8, off = 0.05;
  std::array<Vec3d, 15> steps{};  // none, to either side along each axis, to the corners
  for (int a = 0; a < 3; ++a)
    steps[static_cast<std::size_t>(1 + 2 * a)][a] = -around, steps[static_cast<std::size_t>(2 + 2 * a)][a] = around;
  for (int corner = 0; corner < 8; ++corner) {
    const auto side = [&](int bit) { return (corner & bit) != 0 ? around : -around; };
    steps[static_cast<std::size_t>(7 + corner)] = {side(4), side(2), side(1)};
  }
  std::array<Vec3d, steps.size()> places;
  for (std::size_t n = 0; n < steps.size(); ++n) places[n] = node + steps[n];
  std::array<double, steps.size()> distances;
  view.nearest(places, distances.data());
  const double d = distances[0];
  Vec3d slope;
  for (int a = 0; a < 3; ++a) {
    const double before = distances[static_cast<std::size_t>(1 + 2 * a)],
                 after = distances[static_cast<std::size_t>(2 + 2 * a)];
    if (std::abs(before + after - 2 * d) > 2 * off) return false;
    slope[a] = (after - before) / (2 * around);
  }
  for (std::size_t n = 7; n < steps.size(); ++n)
    if (std::abs(distances[n] - d - dot(slope, steps[n])) > off) return false;
  return true;
}

/// The parts of the kernels of a block's nodes inside all colliders together: added up over cubes,
/// and over smaller ones where a surface may cut them. Kernels of neighbors overlap, so that each
/// cube is looked at once.
template <Cubes count>
class KernelSums {
 public:
  explicit KernelSums(const ColliderView& view) : view_(view) {
    for (int i = 0; i < small; ++i)
      weight_[static_cast<std::size_t>(i)] =
          kernel_inside(i * width / 2 - 1.5) - kernel_inside((i + 1) * width / 2 - 1.5);
  }
  /// `node` within the block.
  double inside(const Vec3i& node) {
    double sum = 0;
    for (int cube = 0; cube < cubes * cubes * cubes; ++cube) {
      const int i = cube / (cubes * cubes), j = cube / cubes % cubes, k = cube % cubes;
      const double d = distance_.at(node, {i, j, k}, [&](const Vec3d& at) { return view_.nearest(at); });
      if (d >= half_diagonal) continue;
      if (d <= -half_diagonal) {
        sum += weight_of_two(i) * weight_of_two(j) * weight_of_two(k);
        continue;
      }
      for (int part = 0; part < 8; ++part) {
        const int u = 2 * i + (part >> 2), v = 2 * j + (part >> 1 & 1), w = 2 * k + (part & 1);
        sum += weight_of(u) * weight_of(v) * weight_of(w) *
               filled_.at(node, {u, v, w}, [&](const Vec3d& at) { return view_.filled(at, width / 2); });
      }
    }
    return std::min(sum, 1.0);
  }

 private:
  static constexpr int cubes = static_cast<int>(count), small = 2 * cubes;
  static constexpr double width = 3.0 / cubes, half_diagonal = 0.87 * width;
  double weight_of(int i) const { return weight_[static_cast<std::size_t>(i)]; }
  double weight_of_two(int i) const { return weight_of(2 * i) + weight_of(2 * i + 1); }

  /// Values at the middles of cubes, `along` of them in the width of a kernel.
  template <int along>
  class Known {
   public:
    template <class Value>
    double at(const Vec3i& node, const Vec3i& cube, const Value& value) {
      const Vec3i i = node * (along / 3) + cube;
      std::optional<double>& known = values_[static_cast<std::size_t>((i.x * side + i.y) * side + i.z)];
      if (!known) known = value((static_cast<Vec3d>(i) + Vec3d{0.5, 0.5, 0.5}) * (3.0 / along) - Vec3d{1.5, 1.5, 1.5});
      return *known;
    }

   private:
    static constexpr int side = (block_width - 1) * along / 3 + along;
    std::vector<std::optional<double>> values_ = std::vector<std::optional<double>>(side * side * side);
  };

  const ColliderView& view_;
  std::array<double, small> weight_{};
  Known<cubes> distance_;
  Known<small> filled_;
};

template <Cubes count>
void share(const ColliderView& view, std::vector<ObstacleNode>& nodes) {
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
  KernelSums<count> kernels(view);
  std::array<double, block_nodes> scale;
  scale.fill(1);
  for (std::size_t n = 0; n < block_nodes; ++n) {
    const Vec3i node = node_offset(static_cast<int>(n));
    if (sums[n] > 0 && !is_plane(view, static_cast<Vec3d>(node))) scale[n] = kernels.inside(node) / sums[n];
  }
  for (ObstacleNode& n : nodes) n.taken = static_cast<float>(n.blocked * scale[n.node]);
  std::erase_if(nodes, [](const ObstacleNode& n) { return !(n.blocked > 0); });
  std::sort(nodes.begin(), nodes.end(), in_order);
}

}  // namespace

double kernel_inside(double d) {
  if (d >= 1.5) return 0;
  if (d <= -1.5) return 1;
  if (d >= 0.5) return std::pow(1.5 - d, 3) / 6;
  if (d <= -0.5) return 1 - std::pow(1.5 + d, 3) / 6;
  return 0.5 - 0.75 * d + d * d * d / 3;
}

void add_nodes(ExposedNodes& exposed, std::uint16_t collider, std::vector<ObstacleNode>& nodes) {
  for (int n = 0; n < block_nodes; ++n) {
    const ColliderDistance& to = exposed.at(collider, node_offset(n));
    const double blocked = kernel_inside(to.distance);
    if (blocked <= 0) continue;
    const bool inside = ColliderView::inside(to.distance);
    nodes.push_back({static_cast<std::uint8_t>(n), inside, to.distance < -ColliderContact::deep_nodes, collider,
                     static_cast<float>(blocked), static_cast<float>(blocked), inside ? to.normal : Vec3d{}});
  }
}

void share_kernels(const ColliderView& view, Cubes cubes, std::vector<ObstacleNode>& nodes) {
  if (cubes == Cubes::fixed)
    share<Cubes::fixed>(view, nodes);
  else
    share<Cubes::moving>(view, nodes);
}

bool in_order(const ObstacleNode& a, const ObstacleNode& b) {
  return std::tuple(a.node, a.collider) < std::tuple(b.node, b.collider);
}

void add_body_nodes(ExposedNodes& exposed, std::uint16_t body, const BlockDistances& own, const BodyKernel& kernel,
                    std::vector<ObstacleNode>& nodes) {
  std::array<float, block_nodes> blocked{}, taken{};  // by the others
  for (const ObstacleNode& n : nodes) blocked[n.node] += n.blocked, taken[n.node] += n.taken;
  for (int n = 0; n < block_nodes; ++n) {
    const double d = own.at_node(n), plane = kernel_inside(d);
    if (plane <= 0) continue;
    const auto i = static_cast<std::size_t>(n);
    const Vec3i node = node_offset(n);
    const bool inside = ColliderView::inside(d);
    double part = 0;
    exposed.view().for_each_frame(body, static_cast<Vec3d>(node), [&](const Vec3d& p) { part += kernel.inside(p); });
    nodes.push_back({static_cast<std::uint8_t>(n), inside, d < -ColliderContact::deep_nodes, body,
                     static_cast<float>(plane) * std::max(0.0f, 1 - blocked[i]),
                     std::min(static_cast<float>(part), std::max(0.0f, 1 - taken[i])),
                     inside ? exposed.at(body, node).normal : Vec3d{}});
  }
}

}  // namespace dreampm

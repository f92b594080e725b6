#include "dreampm/state/obstacle_nodes.h"

#include <algorithm>
#include <array>
#include <boost/container/small_vector.hpp>
#include <cmath>
#include <tuple>

#include "dreampm/physics/collider_contact.h"
#include "dreampm/state/grid.h"

namespace dreampm {
namespace {

// The part of a quadratic B-spline beyond distance d on its positive side: how much of a node's
// kernel lies inside a plane obstacle at signed distance d (cells).
double kernel_inside(double d) {
  if (d >= 1.5) return 0;
  if (d <= -1.5) return 1;
  if (d >= 0.5) return std::pow(1.5 - d, 3) / 6;
  if (d <= -0.5) return 1 - std::pow(1.5 + d, 3) / 6;
  return 0.5 - 0.75 * d + d * d * d / 3;
}

/// Whether the solid about a node is a half-space, as far as most of its kernel goes.
bool is_plane(const ColliderView& view, const Vec3d& node) {
  constexpr double around = 0.8, off = 0.05;
  const double d = view.nearest(node);
  Vec3d slope;
  for (int a = 0; a < 3; ++a) {
    Vec3d step;
    step[a] = around;
    const double before = view.nearest(node - step), after = view.nearest(node + step);
    if (std::abs(before + after - 2 * d) > 2 * off) return false;
    slope[a] = (after - before) / (2 * around);
  }
  for (int corner = 0; corner < 8; ++corner) {
    const auto side = [&](int bit) { return (corner & bit) != 0 ? around : -around; };
    const Vec3d step{side(4), side(2), side(1)};
    if (std::abs(view.nearest(node + step) - d - dot(slope, step)) > off) return false;
  }
  return true;
}

/// The part of a node's kernel inside all colliders together: added up over cubes, and over smaller
/// ones where a surface may cut them.
template <Cubes count>
double kernel_inside_all(const ColliderView& view, const Vec3d& node) {
  constexpr int cubes = static_cast<int>(count), small = 2 * cubes;
  constexpr double width = 3.0 / cubes, half_diagonal = 0.87 * width;
  std::array<double, small> weight{};
  for (int i = 0; i < small; ++i)
    weight[static_cast<std::size_t>(i)] = kernel_inside(i * width / 2 - 1.5) - kernel_inside((i + 1) * width / 2 - 1.5);
  const auto weight_of = [&](int i) { return weight[static_cast<std::size_t>(i)]; };
  const auto weight_of_two = [&](int i) { return weight_of(2 * i) + weight_of(2 * i + 1); };
  const auto middle = [&](int i, int j, int k, double wide) {
    return node + Vec3d{i + 0.5, j + 0.5, k + 0.5} * wide - Vec3d{1.5, 1.5, 1.5};
  };
  double sum = 0;
  for (int cube = 0; cube < cubes * cubes * cubes; ++cube) {
    const int i = cube / (cubes * cubes), j = cube / cubes % cubes, k = cube % cubes;
    const double d = view.nearest(middle(i, j, k, width));
    if (d >= half_diagonal) continue;
    if (d <= -half_diagonal) {
      sum += weight_of_two(i) * weight_of_two(j) * weight_of_two(k);
      continue;
    }
    for (int part = 0; part < 8; ++part) {
      const int u = 2 * i + (part >> 2), v = 2 * j + (part >> 1 & 1), w = 2 * k + (part & 1);
      sum += weight_of(u) * weight_of(v) * weight_of(w) * view.filled(middle(u, v, w, width / 2), width / 2);
    }
  }
  return std::min(sum, 1.0);
}

}  // namespace

void add_nodes(const ColliderView& view, std::uint16_t collider, std::vector<ObstacleNode>& nodes) {
  for (int n = 0; n < block_nodes; ++n) {
    const ColliderDistance to = view.exposed(collider, static_cast<Vec3d>(node_offset(n)));
    const double blocked = kernel_inside(to.distance);
    if (blocked <= 0) continue;
    const bool inside = ColliderView::inside(to.distance);
    nodes.push_back({static_cast<std::uint8_t>(n), inside, to.distance < -ColliderContact::deep_nodes, collider,
                     static_cast<float>(blocked), static_cast<float>(blocked), inside ? to.normal : Vec3d{}});
  }
}

void share_kernels(const ColliderView& view, Cubes cubes, std::vector<ObstacleNode>& nodes) {
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
  std::array<double, block_nodes> scale;
  scale.fill(1);
  for (std::size_t n = 0; n < block_nodes; ++n)
    if (const Vec3d at = static_cast<Vec3d>(node_offset(static_cast<int>(n))); sums[n] > 0 && !is_plane(view, at))
      scale[n] = (cubes == Cubes::fixed ? kernel_inside_all<Cubes::fixed>(view, at)
                                        : kernel_inside_all<Cubes::moving>(view, at)) /
                 sums[n];
  for (ObstacleNode& n : nodes) n.taken = static_cast<float>(n.blocked * scale[n.node]);
  std::erase_if(nodes, [](const ObstacleNode& n) { return !(n.blocked > 0); });
  std::sort(nodes.begin(), nodes.end(), [](const ObstacleNode& a, const ObstacleNode& b) {
    return std::tuple(a.node, a.collider) < std::tuple(b.node, b.collider);
  });
}

}  // namespace dreampm

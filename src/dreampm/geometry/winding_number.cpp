#include "dreampm/geometry/winding_number.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace dreampm {
namespace {

constexpr std::uint32_t leaf_size = 8;
constexpr double beta = 2;  // the paper's accuracy parameter; with the first moment kept the error is below 0.01

Vec3d centroid(const TriMesh& mesh, std::uint32_t t) {
  const auto& [a, b, c] = mesh.triangles[t];
  return (Vec3d(mesh.vertices[a]) + Vec3d(mesh.vertices[b]) + Vec3d(mesh.vertices[c])) / 3.0;
}

/// Twice tan(half the solid angle) as a ratio: atan2(top, bottom) is half the solid angle of the triangle.
inline double half_solid_angle(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  const double la = length(a), lb = length(b), lc = length(c);
  const double top = dot(a, cross(b, c));
  const double bottom = la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb;
  return top == 0 && bottom <= 0 ? 0 : std::atan2(top, bottom);  // a point on the triangle itself sees nothing
}

}  // namespace

WindingNumber::WindingNumber(const TriMesh& mesh) {
  const auto n = static_cast<std::uint32_t>(mesh.triangles.size());
  if (n == 0) return;
  std::vector<std::uint32_t> order(n);
  std::iota(order.begin(), order.end(), 0u);
  nodes_.reserve(n / 2 + 1);
  build(order, 0, n, mesh);
  triangles_.reserve(n);
  for (const std::uint32_t t : order) {
    const auto& [a, b, c] = mesh.triangles[t];
    triangles_.push_back({mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]});
  }
}

std::uint32_t WindingNumber::build(std::vector<std::uint32_t>& order, std::uint32_t begin, std::uint32_t end,
                                   const TriMesh& mesh) {
  const auto self = static_cast<std::uint32_t>(nodes_.size());
  nodes_.emplace_back();
  Node node{};
  node.begin = begin, node.end = end;
  Box3d centroids;
  Vec3d plain, weighted;
  double area = 0;
  for (std::uint32_t i = begin; i < end; ++i) {
    const auto& [ia, ib, ic] = mesh.triangles[order[i]];
    const Vec3d a(mesh.vertices[ia]), b(mesh.vertices[ib]), c(mesh.vertices[ic]);
    const Vec3d vector_area = cross(b - a, c - a) * 0.5, middle = (a + b + c) / 3.0;
    const double weight = length(vector_area);
    centroids.add(middle);
    plain += middle, weighted += middle * weight, area += weight;
    node.dipole += vector_area;
  }
  node.centre = area > 0 ? weighted / area : plain / double(end - begin);
  double radius2 = 0;
  for (std::uint32_t i = begin; i < end; ++i) {
    const auto& [ia, ib, ic] = mesh.triangles[order[i]];
    const Vec3d a(mesh.vertices[ia]), b(mesh.vertices[ib]), c(mesh.vertices[ic]);
    const Vec3d vector_area = cross(b - a, c - a) * 0.5, off = (a + b + c) / 3.0 - node.centre;
    for (int r = 0; r < 3; ++r)
      for (int s = 0; s < 3; ++s) node.moment[std::size_t(3 * r + s)] += off[r] * vector_area[s];
    for (const Vec3d& v : {a, b, c}) radius2 = std::max(radius2, length2(v - node.centre));
  }
  node.reach2 = beta * beta * radius2;
  if (end - begin > leaf_size) {
    const Vec3d extent = centroids.size();
    const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
    const std::uint32_t middle = begin + (end - begin) / 2;
    std::nth_element(order.begin() + begin, order.begin() + middle, order.begin() + end,
                     [&](std::uint32_t l, std::uint32_t r) {
                       const double cl = centroid(mesh, l)[axis], cr = centroid(mesh, r)[axis];
                       return cl != cr ? cl < cr : l < r;
                     });
    build(order, begin, middle, mesh);
    node.right = build(order, middle, end, mesh);
  }
  nodes_[self] = node;
  return self;
}

double WindingNumber::operator()(const Vec3d& p) const {
  if (nodes_.empty()) return 0;
  double far = 0, near = 0;
  std::uint32_t stack[64];  // depth is log2 of the triangle count
  int depth = 0;
  stack[depth++] = 0;
  while (depth > 0) {
    const std::uint32_t self = stack[--depth];
    const Node& node = nodes_[self];
    const Vec3d r = node.centre - p;
    const double d2 = length2(r);
    if (d2 > node.reach2) {
      // sum over triangles of area n . r/|r|^3, expanded about the centre to first order
      const double inv = 1 / std::sqrt(d2), inv3 = inv * inv * inv;
      const auto& m = node.moment;
      const double along = r.x * (m[0] * r.x + m[1] * r.y + m[2] * r.z) + r.y * (m[3] * r.x + m[4] * r.y + m[5] * r.z) +
                           r.z * (m[6] * r.x + m[7] * r.y + m[8] * r.z);
      far += inv3 * (dot(node.dipole, r) + (m[0] + m[4] + m[8]) - 3 * along * inv * inv);
    } else if (node.right) {
      stack[depth++] = node.right;
      stack[depth++] = self + 1;
    } else {
      for (std::uint32_t i = node.begin; i < node.end; ++i) {
        const Triangle& t = triangles_[i];
        near += half_solid_angle(Vec3d(t.a) - p, Vec3d(t.b) - p, Vec3d(t.c) - p);
      }
    }
  }
  return (far + 2 * near) / (4 * std::numbers::pi);
}

}  // namespace dreampm

#include "dreampm/geometry/winding_number.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace dreampm {
namespace {

constexpr std::uint32_t leaf_size = 8;
constexpr double beta = 2;  // the paper's accuracy parameter

Vec3d centroid(const TriMesh& mesh, std::uint32_t t) {
  const auto& [a, b, c] = mesh.triangles[t];
  return (Vec3d(mesh.vertices[a]) + Vec3d(mesh.vertices[b]) + Vec3d(mesh.vertices[c])) / 3.0;
}

/// Twice tan(half the solid angle) as a ratio: atan2(top, bottom) is half the solid angle of the
/// triangle.
inline double half_solid_angle(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  const double la = length(a), lb = length(b), lc = length(c);
  const double top = dot(a, cross(b, c));
  const double bottom = la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb;
  return top == 0 && bottom <= 0 ? 0 : std::atan2(top, bottom);  // a point on the triangle itself sees nothing
}

}  // namespace

/// A point at o with vector area n.
void WindingNumber::Node::add(const Vec3d& o, const Vec3d& n) {
  dipole += n;
  trace += dot(o, n);
  square[0] += o.x * n.x, square[1] += o.y * n.y, square[2] += o.z * n.z;
  square[3] += o.x * n.y + o.y * n.x, square[4] += o.x * n.z + o.z * n.x, square[5] += o.y * n.z + o.z * n.y;
  second += o * (2 * dot(o, n)) + n * length2(o);
  const Vec3d q = o * o;
  cubic[0] += q.x * n.x, cubic[1] += q.y * n.y, cubic[2] += q.z * n.z;
  cubic[3] += q.x * n.y + 2 * o.x * o.y * n.x, cubic[4] += q.x * n.z + 2 * o.x * o.z * n.x;
  cubic[5] += q.y * n.x + 2 * o.x * o.y * n.y, cubic[6] += q.y * n.z + 2 * o.y * o.z * n.y;
  cubic[7] += q.z * n.x + 2 * o.x * o.z * n.z, cubic[8] += q.z * n.y + 2 * o.y * o.z * n.z;
  cubic[9] += 2 * (o.x * o.y * n.z + o.x * o.z * n.y + o.y * o.z * n.x);
}

/// The integral of n.x/|x|^3 dA, expanded about the node's center r to second order in the offsets;
/// d2 = |r|^2.
double WindingNumber::Node::far_field(const Vec3d& r, double d2) const {
  const double inv2 = 1 / d2, inv3 = inv2 * std::sqrt(inv2);
  const Vec3d s = r * r;
  const double form2 = square[0] * s.x + square[1] * s.y + square[2] * s.z + square[3] * r.x * r.y +
                       square[4] * r.x * r.z + square[5] * r.y * r.z;
  const double form3 = s.x * (cubic[0] * r.x + cubic[3] * r.y + cubic[4] * r.z) +
                       s.y * (cubic[5] * r.x + cubic[1] * r.y + cubic[6] * r.z) +
                       s.z * (cubic[7] * r.x + cubic[8] * r.y + cubic[2] * r.z) + cubic[9] * r.x * r.y * r.z;
  return inv3 * (dot(dipole, r) + trace - 3 * form2 * inv2 + inv2 * (7.5 * form3 * inv2 - 1.5 * dot(second, r)));
}

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
  }
  node.center = area > 0 ? weighted / area : plain / double(end - begin);
  double radius2 = 0;
  const bool few = end - begin <= 64;  // then the shape of each triangle counts, not only its place
  for (std::uint32_t i = begin; i < end; ++i) {
    const auto& [ia, ib, ic] = mesh.triangles[order[i]];
    const Vec3d a = Vec3d(mesh.vertices[ia]) - node.center, b = Vec3d(mesh.vertices[ib]) - node.center,
                c = Vec3d(mesh.vertices[ic]) - node.center;
    const Vec3d vector_area = cross(b - a, c - a) * 0.5, off = (a + b + c) / 3.0;
    node.add(off, few ? vector_area * 0.75 : vector_area);
    for (const Vec3d& v : {a, b, c}) {
      radius2 = std::max(radius2, length2(v));
      if (few) node.add(v, vector_area / 12.0);  // with the centroid a rule that is exact for squares
    }
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
    const Vec3d r = node.center - p;
    const double d2 = length2(r);
    if (d2 > node.reach2) {
      far += node.far_field(r, d2);
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

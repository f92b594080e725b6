// Tapered capsules and plates, united by the smooth minimum of I. Quilez ("Smooth minimum", 2013),
// and meshed by surface nets (Gibson 1998, "Constrained Elastic Surface Nets").
#include "dreampm/import/dragon.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace dreampm {
namespace dragon_parts {
namespace {

/// A place on a limb, and how thick the limb is there.
struct Joint {
  Vec3d at;
  double radius;
};

double smooth_min(double a, double b, double width) {
  const double h = std::max(width - std::abs(a - b), 0.0) / width;
  return std::min(a, b) - 0.25 * h * h * width;
}

double to_limb(const Vec3d& p, const Joint& a, const Joint& b) {
  const Vec3d along = b.at - a.at, off = p - a.at;
  const double t = std::clamp(dot(off, along) / length2(along), 0.0, 1.0);
  return length(off - along * t) - (a.radius + (b.radius - a.radius) * t);
}

/// Returns the distance to a triangle with rounded edges.
double to_plate(const Vec3d& p, const std::array<Vec3d, 3>& v, double half) {
  const Vec3d normal = normalized(cross(v[1] - v[0], v[2] - v[0]));
  bool inside = true;
  double nearest = 1e30;
  for (std::size_t e = 0; e < 3; ++e) {
    const Vec3d& a = v[e];
    const Vec3d& b = v[(e + 1) % 3];
    inside = inside && dot(cross(normal, b - a), p - a) >= 0;
    nearest = std::min(nearest, to_limb(p, {a, 0}, {b, 0}));
  }
  return (inside ? std::abs(dot(normal, p - v[0])) : nearest) - half;
}

// It is read as a dragon where it is 40 particles long, too: what stands out is two of them thick
// at least, and twice as far from the rest. From the tip of the tail to the nose, in the middle
// plane but for the tail.
constexpr std::array<Joint, 13> spine{{{{-1.74, 0.68, 0.34}, 0.06},
                                       {{-1.74, 0.40, 0.42}, 0.09},
                                       {{-1.46, 0.20, 0.38}, 0.12},
                                       {{-1.06, 0.18, 0.22}, 0.16},
                                       {{-0.70, 0.34, 0.06}, 0.23},
                                       {{-0.34, 0.52, 0.00}, 0.31},
                                       {{0.04, 0.60, 0.00}, 0.33},
                                       {{0.38, 0.72, 0.00}, 0.27},
                                       {{0.66, 0.98, 0.00}, 0.19},
                                       {{0.78, 1.32, 0.00}, 0.15},
                                       {{0.98, 1.60, 0.00}, 0.19},
                                       {{1.26, 1.58, 0.00}, 0.15},
                                       {{1.58, 1.52, 0.00}, 0.12}}};
constexpr std::array<Joint, 2> jaw{{{{1.02, 1.46, 0}, 0.11}, {{1.42, 1.20, 0}, 0.08}}};
// The left half; the right one is its mirror.
constexpr std::array<Joint, 3> horn{
    {{{0.94, 1.74, 0.11}, 0.09}, {{0.70, 1.88, 0.19}, 0.075}, {{0.48, 2.06, 0.22}, 0.05}}};
constexpr Joint eye{{1.12, 1.74, 0.13}, 0.085}, nostril{{1.62, 1.61, 0.08}, 0.06}, cheek{{1.0, 1.56, 0.15}, 0.11};
constexpr std::array<Joint, 4> arm{
    {{{0.40, 0.56, 0.20}, 0.15}, {{0.50, 0.30, 0.32}, 0.11}, {{0.50, 0.10, 0.34}, 0.10}, {{0.70, 0.07, 0.36}, 0.08}}};
constexpr std::array<Joint, 4> leg{{{{-0.30, 0.46, 0.26}, 0.21},
                                    {{-0.10, 0.30, 0.40}, 0.16},
                                    {{-0.26, 0.11, 0.41}, 0.11},
                                    {{-0.02, 0.07, 0.44}, 0.085}}};
constexpr Vec3d shoulder{0.10, 0.88, 0.14}, elbow{-0.16, 1.56, 0.52}, back{-0.42, 0.80, 0.16};
constexpr std::array<Vec3d, 3> fingers{{{-0.98, 2.10, 1.02}, {-1.30, 1.46, 0.98}, {-1.10, 0.98, 0.74}}};
constexpr double membrane = 0.09, bone = 0.1;
// The spade at the end of the tail.
constexpr std::array<Vec3d, 3> spade{{{-1.74, 0.66, 0.08}, {-1.78, 1.06, 0.33}, {-1.74, 0.66, 0.60}}};

template <std::size_t N>
double to_chain(const Vec3d& p, const std::array<Joint, N>& joints, double width) {
  double d = 1e30;
  for (std::size_t i = 0; i + 1 < N; ++i) d = smooth_min(d, to_limb(p, joints[i], joints[i + 1]), width);
  return d;
}

double to_wing(const Vec3d& p) {
  double d = to_limb(p, {shoulder, 0.13}, {elbow, bone});
  for (const Vec3d& f : fingers) d = smooth_min(d, to_limb(p, {elbow, bone}, {f, 0.1}), 0.05);
  for (std::size_t f = 0; f + 1 < fingers.size(); ++f) {
    // Scalloped: between two fingers the edge is drawn in.
    const Vec3d inner = (fingers[f] + fingers[f + 1]) * 0.42 + elbow * 0.16;
    d = smooth_min(d, to_plate(p, {elbow, fingers[f], inner}, membrane), 0.03);
    d = smooth_min(d, to_plate(p, {elbow, inner, fingers[f + 1]}, membrane), 0.03);
  }
  d = smooth_min(d, to_plate(p, {elbow, fingers.back(), back}, membrane), 0.03);
  return smooth_min(d, to_plate(p, {elbow, back, shoulder}, membrane), 0.03);
}

/// Below 0 in the dragon.
double to_dragon(const Vec3d& p) {
  const Vec3d q{p.x, p.y, std::abs(p.z)};
  double d = to_chain(p, spine, 0.16);
  d = smooth_min(d, to_chain(p, jaw, 0.05), 0.05);
  d = smooth_min(d, to_chain(q, arm, 0.1), 0.12);
  d = smooth_min(d, to_chain(q, leg, 0.1), 0.14);
  d = smooth_min(d, to_wing(q), 0.08);
  d = smooth_min(d, to_chain(q, horn, 0.05), 0.06);
  d = smooth_min(d, to_plate(p, spade, 0.07), 0.05);
  for (const Joint& bump : {eye, nostril}) d = smooth_min(d, length(q - bump.at) - bump.radius, 0.04);
  d = smooth_min(d, length(q - cheek.at) - cheek.radius, 0.1);
  // Spikes stand on the spine, from the tail's root to the neck.
  constexpr double spike = 0.28;
  for (std::size_t i = 2; i < 10; ++i)
    for (const double share : {0.0, 0.5}) {
      const Joint &a = spine[i], &b = spine[i + 1];
      const Vec3d along = normalized(b.at - a.at), at = a.at + (b.at - a.at) * share;
      const Vec3d up = normalized(Vec3d{0, 1, 0} - along * along.y);
      const double radius = a.radius + (b.radius - a.radius) * share, size = spike * std::min(1.0, 0.45 + 1.4 * radius);
      d = smooth_min(
          d, to_limb(p, {at + up * (radius - 0.03), 0.12}, {at + up * (radius + size) - along * (0.35 * size), 0.045}),
          0.04);
    }
  return std::max(d, -p.y);  // it stands
}

constexpr Vec3d low{-2.05, -0.12, -1.213}, high{1.9, 2.4, 1.2};
constexpr double cell = 0.067;

/// Returns a place where the field is 0, near the given one.
Vec3d onto_surface(Vec3d p) {
  constexpr double h = 1e-4;
  for (int k = 0; k < 3; ++k) {
    const double d = to_dragon(p);
    const Vec3d slope{(to_dragon(p + Vec3d{h, 0, 0}) - to_dragon(p - Vec3d{h, 0, 0})) / (2 * h),
                      (to_dragon(p + Vec3d{0, h, 0}) - to_dragon(p - Vec3d{0, h, 0})) / (2 * h),
                      (to_dragon(p + Vec3d{0, 0, h}) - to_dragon(p - Vec3d{0, 0, h})) / (2 * h)};
    const double steep = length2(slope);
    if (steep < 0.1) break;
    const Vec3d move = slope * (-d / steep);
    // No farther than a third of a cell: neighbors must not pass one another.
    const double far = length(move);
    p += far > cell / 3 ? move * (cell / 3 / far) : move;
  }
  return p;
}

}  // namespace
}  // namespace dragon_parts

TriMesh little_dragon() {
  using namespace dragon_parts;
  const Vec3i n{static_cast<int>((high.x - low.x) / cell), static_cast<int>((high.y - low.y) / cell),
                static_cast<int>((high.z - low.z) / cell)};
  const auto index = [&](int i, int j, int k) {
    return (static_cast<std::size_t>(i) * static_cast<std::size_t>(n.y) + static_cast<std::size_t>(j)) *
               static_cast<std::size_t>(n.z) +
           static_cast<std::size_t>(k);
  };
  const auto corner = [&](int i, int j, int k) { return low + Vec3d{i * cell, j * cell, k * cell}; };
  std::vector<double> field(index(n.x - 1, n.y - 1, n.z - 1) + 1);
  for (int i = 0; i < n.x; ++i)
    for (int j = 0; j < n.y; ++j)
      for (int k = 0; k < n.z; ++k) field[index(i, j, k)] = to_dragon(corner(i, j, k));
  const auto in = [&](int i, int j, int k) { return field[index(i, j, k)] < 0; };
  // A face of a cell whose corners are in and out by turns would give an edge with four triangles:
  // it is filled.
  for (bool changed = true; changed;) {
    changed = false;
    for (int i = 1; i + 1 < n.x; ++i)
      for (int j = 1; j + 1 < n.y; ++j)
        for (int k = 1; k + 1 < n.z; ++k)
          for (int a = 0; a < 3; ++a) {
            std::array<std::size_t, 4> around{};
            for (std::size_t c = 0; c < 4; ++c) {
              std::array<int, 3> at{i, j, k};
              at[std::size_t(a + 1) % 3] += c == 1 || c == 2;
              at[std::size_t(a + 2) % 3] += c >= 2;
              around[c] = index(at[0], at[1], at[2]);
            }
            const auto inside = [&](std::size_t c) { return field[around[c]] < 0; };
            if (inside(0) != inside(2) || inside(1) != inside(3) || inside(0) == inside(1)) continue;
            for (const std::size_t c : around) field[c] = std::min(field[c], -0.1 * cell);
            changed = true;
          }
  }

  // A vertex in each cell that the surface crosses, amid the crossings of its edges.
  TriMesh mesh;
  std::vector<std::uint32_t> vertex(field.size());
  for (int i = 0; i + 1 < n.x; ++i)
    for (int j = 0; j + 1 < n.y; ++j)
      for (int k = 0; k + 1 < n.z; ++k) {
        Vec3d sum;
        int crossings = 0;
        for (int a = 0; a < 3; ++a)
          for (int e = 0; e < 4; ++e) {
            std::array<int, 3> from{i, j, k};
            from[std::size_t(a + 1) % 3] += e & 1, from[std::size_t(a + 2) % 3] += e >> 1;
            std::array<int, 3> to = from;
            ++to[std::size_t(a)];
            const double f = field[index(from[0], from[1], from[2])], g = field[index(to[0], to[1], to[2])];
            if ((f < 0) == (g < 0)) continue;
            const Vec3d x = corner(from[0], from[1], from[2]), y = corner(to[0], to[1], to[2]);
            sum += x + (y - x) * (f / (f - g)), ++crossings;
          }
        if (crossings == 0) continue;
        vertex[index(i, j, k)] = static_cast<std::uint32_t>(mesh.vertices.size());
        mesh.vertices.push_back(static_cast<Vec3f>(onto_surface(sum / crossings)));
      }
  // Around each edge that crosses it the four cells' vertices are two triangles.
  for (int i = 1; i + 1 < n.x; ++i)
    for (int j = 1; j + 1 < n.y; ++j)
      for (int k = 1; k + 1 < n.z; ++k)
        for (int a = 0; a < 3; ++a) {
          std::array<int, 3> to{i, j, k};
          ++to[std::size_t(a)];
          const bool here = in(i, j, k);
          if (here == in(to[0], to[1], to[2])) continue;
          std::array<std::uint32_t, 4> ring{};
          for (std::size_t c = 0; c < 4; ++c) {
            // (0,0), (-1,0), (-1,-1), (0,-1) along the two other axes: counterclockwise from
            // outside.
            std::array<int, 3> at{i, j, k};
            at[std::size_t(a + 1) % 3] -= c == 1 || c == 2;
            at[std::size_t(a + 2) % 3] -= c >= 2;
            ring[c] = vertex[index(at[0], at[1], at[2])];
          }
          if (!here) std::swap(ring[1], ring[3]);
          mesh.triangles.push_back({ring[0], ring[1], ring[2]});
          mesh.triangles.push_back({ring[0], ring[2], ring[3]});
        }
  return mesh;
}

}  // namespace dreampm

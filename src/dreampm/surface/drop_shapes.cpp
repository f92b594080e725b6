#include "dreampm/surface/drop_shapes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

namespace dreampm::surface {
namespace {

/// An icosahedron, each face split in four `levels` times, of volume 1.
TriMesh unit_sphere(int levels) {
  const float g = (1 + std::sqrt(5.0f)) / 2;
  TriMesh s;
  // Corners of three golden rectangles: (0, +-1, +-g) and its cyclic turns.
  for (int a = 0; a < 3; ++a)
    for (int k = 0; k < 4; ++k) {
      Vec3f p;
      p[(a + 1) % 3] = k & 1 ? 1.0f : -1.0f;
      p[(a + 2) % 3] = k & 2 ? g : -g;
      s.vertices.push_back(normalized(p));
    }
  // Faces: three corners at one edge length of each other, turned outwards.
  const float edge2 = 1.01f * length2(s.vertices[0] - s.vertices[1]);
  const auto near = [&](std::uint32_t i, std::uint32_t j) { return length2(s.vertices[i] - s.vertices[j]) < edge2; };
  for (std::uint32_t i = 0; i < 12; ++i)
    for (std::uint32_t j = i + 1; j < 12; ++j)
      for (std::uint32_t k = j + 1; k < 12; ++k) {
        if (!near(i, j) || !near(j, k) || !near(i, k)) continue;
        const bool outward = dot(s.vertices[i], cross(s.vertices[j], s.vertices[k])) > 0;
        s.triangles.push_back(outward ? std::array{i, j, k} : std::array{i, k, j});
      }
  for (int level = 0; level < levels; ++level) {
    std::vector<std::array<std::uint32_t, 3>> middles;  // edge from, to, vertex
    const auto middle = [&](std::uint32_t i, std::uint32_t j) {
      for (const auto& m : middles)
        if (m[0] == std::min(i, j) && m[1] == std::max(i, j)) return m[2];
      const auto v = static_cast<std::uint32_t>(s.vertices.size());
      s.vertices.push_back(normalized(s.vertices[i] + s.vertices[j]));
      middles.push_back({std::min(i, j), std::max(i, j), v});
      return v;
    };
    const auto faces = std::exchange(s.triangles, {});
    for (const auto& f : faces) {
      const std::uint32_t a = middle(f[0], f[1]), b = middle(f[1], f[2]), c = middle(f[2], f[0]);
      s.triangles.insert(s.triangles.end(), {{f[0], a, c}, {f[1], b, a}, {f[2], c, b}, {a, b, c}});
    }
  }
  s.normals = s.vertices;
  float six = 0;
  for (const auto& t : s.triangles) six += dot(s.vertices[t[0]], cross(s.vertices[t[1]], s.vertices[t[2]]));
  for (Vec3f& v : s.vertices) v = v / std::cbrt(six / 6);
  return s;
}

/// A spherical cap of volume 1 on the plane y = 0, up to which it counts, with a foot below: its
/// base moves with the depth that it reaches into what it lies on.
struct Cap {
  TriMesh mesh;
  std::size_t rim = 0, foot = 0;  ///< the first vertices of the ring on the plane, and of that below it
};

Cap unit_cap(int rings, int sides) {
  Cap cap;
  TriMesh& m = cap.mesh;
  const auto ring = [&](float radius, float y, float tilt) {
    for (int k = 0; k < sides; ++k) {
      const float turn = 2 * std::numbers::pi_v<float> * static_cast<float>(k) / static_cast<float>(sides);
      m.vertices.push_back({radius * std::cos(turn), y, radius * std::sin(turn)});
      m.normals.push_back({std::sin(tilt) * std::cos(turn), std::cos(tilt), std::sin(tilt) * std::sin(turn)});
    }
  };
  m.vertices.push_back({0, 1 - std::cos(contact_angle), 0}), m.normals.push_back({0, 1, 0});
  for (int r = 1; r <= rings; ++r) {
    const float tilt = contact_angle * static_cast<float>(r) / static_cast<float>(rings);
    cap.rim = m.vertices.size();
    ring(std::sin(tilt), r == rings ? 0 : std::cos(tilt) - std::cos(contact_angle), tilt);
  }
  cap.foot = m.vertices.size();
  ring(std::sin(contact_angle), 0, std::numbers::pi_v<float> / 2);
  m.vertices.push_back({}), m.normals.push_back({0, -1, 0});
  const auto bottom = static_cast<std::uint32_t>(m.vertices.size() - 1), n = static_cast<std::uint32_t>(sides);
  for (std::uint32_t k = 0; k < n; ++k) {
    const std::uint32_t next = (k + 1) % n;
    m.triangles.push_back({0, 1 + next, 1 + k});
    for (std::uint32_t from = 1; from + n < bottom; from += n) {
      m.triangles.push_back({from + k, from + next, from + n + next});
      m.triangles.push_back({from + k, from + n + next, from + n + k});
    }
    m.triangles.push_back({bottom, bottom - n + k, bottom - n + next});
  }
  float six = 0;
  for (const auto& t : m.triangles) six += dot(m.vertices[t[0]], cross(m.vertices[t[1]], m.vertices[t[2]]));
  for (Vec3f& v : m.vertices) v = v / std::cbrt(six / 6);
  return cap;
}

/// What a drop lies on.
struct Ground {
  float distance = 1e30f;
  Vec3f point, normal;
  bool solid = false;
};
Ground ground_of(const Bounds& bounds, const Vec3f& p, float within) {
  Ground ground;
  for (int s = 0; s < 6; ++s) {
    const float d = bounds.walls.distance(s, p);
    if (!bounds.walls.closed[static_cast<std::size_t>(s)] || d >= ground.distance) continue;
    Vec3f n{};
    n[s / 2] = s % 2 == 0 ? 1.0f : -1.0f;
    ground = {d, p - n * d, n, false};
  }
  if (!bounds.solids.empty() && bounds.solids.near({p, p}))
    if (const float d = bounds.solids.distance(p); d < std::min(within, ground.distance))
      if (const Vec3f on = bounds.solids.projected(p, 0); length(on - p) < 2 * within)
        ground = {d, on, bounds.solids.normal(on), true};
  return ground;
}

/// p, moved off the other walls so that what reaches `radius` fits.
Vec3f fitted(const Walls& walls, Vec3f p, float radius, const Vec3f& ground) {
  for (int side = 0; side < 6; ++side)
    if (walls.closed[static_cast<std::size_t>(side)] && walls.distance(side, p) < radius && ground[side / 2] == 0)
      p[side / 2] = walls.place(side) + (side % 2 == 0 ? radius : -radius);
  return p;
}

class Adding {
 public:
  Adding(TriMesh& mesh, const Bounds& bounds, float spacing, float depth)
      : mesh_(mesh),
        bounds_(bounds),
        spacing_(spacing),
        depth_(depth),
        moving_(mesh.velocities.size() == mesh.vertices.size()) {}

  void add(const SmallDrop& drop) {
    const bool coarse = drop.particles < 3;
    const float size = spacing_ * std::cbrt(static_cast<float>(drop.particles));
    const float radius = size * length(spheres_[0].vertices[0]);
    if (const Ground ground = ground_of(bounds_, drop.center, radius); ground.distance < radius) {
      constexpr float least = 1e-3f;  // of its volume: less is not seen
      if (drop.remaining > least)
        add_cap(coarse ? caps_[0] : caps_[1], size * std::cbrt(drop.remaining), ground, drop.velocity);
    } else {
      add_sphere(coarse ? spheres_[0] : spheres_[1], size, radius, drop);
    }
  }

 private:
  void add_sphere(const TriMesh& shape, float size, float radius, const SmallDrop& drop) {
    const Vec3f c = fitted(bounds_.walls, drop.center, radius, {});
    const std::size_t first = begin(shape, drop.velocity);
    for (std::size_t v = 0; v < shape.vertices.size(); ++v) {
      mesh_.vertices[first + v] = bounds_.walls.inside(c + shape.vertices[v] * size);
      mesh_.normals[first + v] = shape.normals[v];
    }
  }
  void add_cap(const Cap& cap, float size, const Ground& ground, const Vec3f& velocity) {
    const Vec3f n = ground.normal, t = normalized(cross(std::abs(n.x) < 0.7f ? Vec3f{1, 0, 0} : Vec3f{0, 1, 0}, n)),
                u = cross(n, t);  // u, n, t: right-handed, as x, y, z
    const auto turned = [&](const Vec3f& d) { return u * d.x + n * d.y + t * d.z; };
    const float rim = size * std::abs(cap.mesh.vertices[cap.rim].x);
    const Vec3f c = ground.solid ? ground.point : fitted(bounds_.walls, ground.point, rim, n);
    const std::size_t first = begin(cap.mesh, velocity);
    for (std::size_t v = 0; v < cap.mesh.vertices.size(); ++v) {
      Vec3f& x = mesh_.vertices[first + v];
      x = c + turned(cap.mesh.vertices[v]) * size;
      mesh_.normals[first + v] = turned(cap.mesh.normals[v]);
      if (v < cap.rim) continue;
      if (ground.solid) x = bounds_.solids.projected(x, 0);
      if (v < cap.foot) continue;
      if (ground.solid) {
        const Solids::WayIn way = bounds_.solids.way_in(x, bounds_.solids.normal(x), depth_);
        x -= way.out * way.depth;
      } else {
        x -= n * depth_;
      }
    }
  }
  /// Makes room for a shape's vertices, and adds its triangles.
  std::size_t begin(const TriMesh& shape, const Vec3f& velocity) {
    const std::size_t first = mesh_.vertices.size(), end = first + shape.vertices.size();
    mesh_.vertices.resize(end), mesh_.normals.resize(end);
    if (moving_) mesh_.velocities.resize(end, velocity);
    const auto from = static_cast<std::uint32_t>(first);
    for (const auto& t : shape.triangles) mesh_.triangles.push_back({from + t[0], from + t[1], from + t[2]});
    return first;
  }

  TriMesh& mesh_;
  const Bounds& bounds_;
  float spacing_, depth_;
  bool moving_;
  std::array<TriMesh, 2> spheres_{unit_sphere(1), unit_sphere(2)};
  std::array<Cap, 2> caps_{unit_cap(3, 12), unit_cap(5, 20)};
};

}  // namespace

void add_small_drops(TriMesh& mesh, std::span<const SmallDrop> drops, const Bounds& bounds, float spacing,
                     float depth) {
  if (drops.empty()) return;
  Adding adding(mesh, bounds, spacing, depth);
  for (const SmallDrop& d : drops) adding.add(d);
}

}  // namespace dreampm::surface

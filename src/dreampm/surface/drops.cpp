#include "dreampm/surface/drops.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace dreampm::surface {
namespace {

constexpr double kSphere = 0.238732;  // 3/(4 pi): radius^3 of a sphere of volume 1

/// Sums over the surface of each body.
struct Size {
  Vec3d middle{};
  double area = 0, volume = 0, reach = 0;
  std::size_t vertices = 0;
};

std::vector<Size> measure(const QuadMesh& mesh, const Bodies& bodies) {
  std::vector<Size> sizes(bodies.count);
  const auto body = [&](std::size_t v) -> Size& { return sizes[static_cast<std::size_t>(bodies.of_vertex[v])]; };
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    Size& s = body(v);
    s.middle += Vec3d(mesh.vertices[v]);
    ++s.vertices;
  }
  for (Size& s : sizes)
    if (s.vertices > 0) s.middle = s.middle / static_cast<double>(s.vertices);
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
    body(v).reach = std::max(body(v).reach, length(Vec3d(mesh.vertices[v]) - body(v).middle));
  for (const auto& q : mesh.quads) {
    Size& s = body(q[0]);
    std::array<Vec3d, 4> p;
    for (std::size_t k = 0; k < 4; ++k) p[k] = Vec3d(mesh.vertices[q[k]]) - s.middle;
    s.volume += (dot(p[0], cross(p[1], p[2])) + dot(p[0], cross(p[2], p[3]))) / 6;
    s.area += length(cross(p[2] - p[0], p[3] - p[1])) / 2;
  }
  return sizes;
}

}  // namespace

std::vector<SmallDrop> take_small_drops(QuadMesh& mesh, Bodies& bodies, std::span<const Vec3f> points,
                                        std::span<const Vec3f> velocities, std::span<const float> remaining,
                                        float spacing) {
  constexpr std::uint32_t kAnyShape = 3, kMost = 8;
  constexpr double kCompact = 2;  // of the sphere's radius
  const std::vector<Size> sizes = measure(mesh, bodies);
  std::vector<std::uint8_t> taken(bodies.count, 0);
  std::vector<SmallDrop> drops(bodies.count);
  for (std::size_t b = 0; b < bodies.count; ++b) {
    const std::uint32_t n = bodies.particles[b];
    const double radius = static_cast<double>(spacing) * std::cbrt(n * kSphere);
    taken[b] = n <= kAnyShape || (n <= kMost && sizes[b].reach < kCompact * radius);
  }
  std::vector<SmallDrop> alone;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3f velocity = velocities.empty() ? Vec3f{} : velocities[i];
    const float left = remaining.empty() ? 1 : remaining[i];
    if (bodies.of_particle[i] == Bodies::kNone) {
      alone.push_back({points[i], velocity, 1, left});
      continue;
    }
    const auto b = static_cast<std::size_t>(bodies.of_particle[i]);
    if (!taken[b]) continue;
    if (drops[b].particles == 0) drops[b].remaining = 0;
    drops[b].center += points[i], drops[b].velocity += velocity, drops[b].remaining += left, ++drops[b].particles;
  }
  for (SmallDrop& s : drops) {
    if (s.particles == 0) continue;
    const auto n = static_cast<float>(s.particles);
    alone.push_back({s.center / n, s.velocity / n, s.particles, s.remaining / n});
  }

  constexpr std::uint32_t kGone = 0xffffffffu;
  std::vector<std::uint32_t> to(mesh.vertices.size(), kGone);
  std::uint32_t left = 0;
  for (std::size_t v = 0; v < to.size(); ++v) {
    if (taken[static_cast<std::size_t>(bodies.of_vertex[v])]) continue;
    to[v] = left;
    mesh.vertices[left] = mesh.vertices[v];
    mesh.touches[left] = mesh.touches[v];
    if (!mesh.solid_normals.empty()) mesh.solid_normals[left] = mesh.solid_normals[v];
    bodies.of_vertex[left++] = bodies.of_vertex[v];
  }
  std::size_t kept = 0;
  for (std::size_t q = 0; q < mesh.quads.size(); ++q) {
    if (to[mesh.quads[q][0]] == kGone) continue;
    for (std::size_t k = 0; k < 4; ++k) mesh.quads[kept][k] = to[mesh.quads[q][k]];
    mesh.inner[kept++] = mesh.inner[q];
  }
  if (!mesh.solid_normals.empty()) mesh.solid_normals.resize(left);
  mesh.vertices.resize(left), mesh.touches.resize(left), bodies.of_vertex.resize(left);
  mesh.quads.resize(kept), mesh.inner.resize(kept);
  return alone;
}

void restore_volumes(QuadMesh& mesh, const Bodies& bodies, float spacing) {
  constexpr double kRound = 0.85;  // share of the way to a sphere that a compact drop takes
  const double particle = std::pow(static_cast<double>(spacing), 3);
  const auto wanted = [&](std::size_t b) { return particle * bodies.particles[b]; };
  const auto is_drop = [&](std::size_t b) { return bodies.particles[b] < kDropParticles; };
  const auto left_alone = [&](std::size_t b) { return bodies.on_wall[b] != 0 || bodies.particles[b] == 0; };
  std::vector<Size> sizes = measure(mesh, bodies);
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    const auto b = static_cast<std::size_t>(bodies.of_vertex[v]);
    if (left_alone(b) || !is_drop(b)) continue;
    const double radius = std::cbrt(wanted(b) * kSphere);
    const double share = kRound * std::clamp((2.2 - sizes[b].reach / radius) / 0.8, 0.0, 1.0);
    const Vec3d d = Vec3d(mesh.vertices[v]) - sizes[b].middle;
    const double l = length(d);
    if (l > 0) mesh.vertices[v] = Vec3f(sizes[b].middle + d * (1 - share + share * radius / l));
  }
  for (int pass = 0; pass < 3; ++pass) {  // the volume is not linear in the move
    sizes = measure(mesh, bodies);
    std::vector<Vec3f> normal(mesh.vertices.size());
    for (const auto& q : mesh.quads) {
      const Vec3f area = cross(mesh.vertices[q[2]] - mesh.vertices[q[0]], mesh.vertices[q[3]] - mesh.vertices[q[1]]);
      for (const std::uint32_t v : q) normal[v] += area;
    }
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
      const auto b = static_cast<std::size_t>(bodies.of_vertex[v]);
      const Size& s = sizes[b];
      if (left_alone(b) || s.volume <= 0) continue;
      if (is_drop(b)) {
        const double scale = std::clamp(std::cbrt(wanted(b) / s.volume), 0.7, 1.5);
        mesh.vertices[v] = Vec3f(s.middle + (Vec3d(mesh.vertices[v]) - s.middle) * scale);
      } else {
        const double most = static_cast<double>(spacing) / 2;
        const double move = std::clamp((wanted(b) - s.volume) / s.area, -most, most);
        mesh.vertices[v] += normalized(normal[v]) * static_cast<float>(move);
      }
    }
  }
}

}  // namespace dreampm::surface

#include "dreampm/surface/overlap.h"

#include <algorithm>
#include <cmath>

#include "dreampm/base/parallel.h"

namespace dreampm::surface {
namespace {

float ramp(float x, float from, float to) {
  const float t = std::clamp((x - from) / (to - from), 0.0f, 1.0f);
  return t * t * (3 - 2 * t);
}

/// The way that goes `depth` against the normal `n` of a wall, within the plane of the free surface
/// of normal `free` as far as both allow.
Vec3f inward(const Vec3f& n, const Vec3f& free, float depth) {
  constexpr float least = 0.25f;  // sine squared of the angle between them: flatter films go straight in
  const float c = dot(n, free), sine2 = 1 - c * c;
  if (sine2 <= 0) return n * -depth;
  const Vec3f along = (free * c - n) / sine2;
  const float share = std::min(1.0f, sine2 / least);
  return (along * share - n * (1 - share)) * depth;
}

class Extension {
 public:
  Extension(const QuadMesh& quads, const Bounds& bounds, const OverlapSettings& settings)
      : quads_(quads), bounds_(bounds), settings_(settings) {}

  Vec3f moved(std::size_t v, Vec3f x, const Vec3f& normal) const {
    const bool pure = quads_.pure_wall(v);
    const Vec3f start = x;
    if (!bounds_.solids.empty()) x += into_solid(v, x, normal, pure);
    const std::uint8_t touches = quads_.touches[v];
    for (int s = 0; s < 6; ++s) {
      if ((touches >> s & 1) == 0) continue;
      Vec3f n{};
      n[s / 2] = s % 2 == 0 ? 1.0f : -1.0f;
      x[s / 2] = start[s / 2];
      x += pure ? n * -settings_.depth : inward(n, normal, settings_.depth);
    }
    return x;
  }

 private:
  Vec3f into_solid(std::size_t v, const Vec3f& x, const Vec3f& normal, bool pure) const {
    const Solids& solids = bounds_.solids;
    if ((quads_.touches[v] & QuadMesh::kSolid) != 0) {
      const auto [out, depth, whole] = solids.way_in(x, solids.normal(x), settings_.depth);
      if (!pure) return inward(out, normal, depth);
      const Vec3f in = out * -depth;
      return whole ? solids.projected(x + in, -settings_.depth) - x : in;
    }
    if (!solids.near({x, x})) return {};
    const float d = solids.distance(x);
    if (d >= settings_.gap) return {};
    const Vec3f n = solids.normal(x);
    const float share = ramp(-dot(n, normal), 0.2f, 0.6f) * (1 - ramp(d / settings_.gap, 0.6f, 1));
    if (share <= 0) return {};
    const Solids::WayIn way = solids.way_in(x - n * d, n, settings_.depth);
    return (n * d + way.out * way.depth) * -share;
  }

  const QuadMesh& quads_;
  const Bounds& bounds_;
  const OverlapSettings& settings_;
};

}  // namespace

void extend(TriMesh& mesh, const QuadMesh& quads, const Bounds& bounds, const OverlapSettings& settings) {
  if (!(settings.depth > 0)) return;
  const Extension extension(quads, bounds, settings);
  parallel_for(mesh.vertices.size(), 512,
               [&](std::size_t v) { mesh.vertices[v] = extension.moved(v, mesh.vertices[v], mesh.normals[v]); });
}

}  // namespace dreampm::surface

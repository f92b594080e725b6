#include "dreampm/surface/smooth.h"

#include <algorithm>
#include <numeric>

#include "dreampm/base/parallel.h"

namespace dreampm::surface {
namespace {

/// The vertices that each vertex listens to.
struct Links {
  std::vector<std::uint32_t> first, to;
};

Links make_links(const QuadMesh& mesh) {
  const std::size_t n = mesh.vertices.size();
  const auto contact = [&](std::uint32_t v) { return mesh.on_wall(v) && !mesh.pure_wall(v); };
  const auto listens = [&](std::uint32_t a, std::uint32_t b) { return !contact(a) || !mesh.pure_wall(b); };
  Links links;
  links.first.assign(n + 1, 0);
  // The mesh is closed: every edge is met once in either direction.
  for (const auto& q : mesh.quads)
    for (std::size_t k = 0; k < 4; ++k)
      if (listens(q[k], q[(k + 1) % 4])) ++links.first[q[k] + 1];
  std::partial_sum(links.first.begin(), links.first.end(), links.first.begin());
  links.to.resize(links.first.back());
  std::vector<std::uint32_t> at(links.first.begin(), links.first.end() - 1);
  for (const auto& q : mesh.quads)
    for (std::size_t k = 0; k < 4; ++k)
      if (listens(q[k], q[(k + 1) % 4])) links.to[at[q[k]]++] = q[(k + 1) % 4];
  return links;
}

/// A move of a vertex without what leads off its walls and its solid.
Vec3f kept_on(const QuadMesh& mesh, std::size_t v, Vec3f move) {
  const std::uint8_t touches = mesh.touches[v];
  if (touches & QuadMesh::kSolid) move -= mesh.solid_normals[v] * dot(mesh.solid_normals[v], move);
  if (touches & 3) move.x = 0;
  if (touches & 12) move.y = 0;
  if (touches & 48) move.z = 0;
  return move;
}

/// x, y, z and nothing, in one register.
using Lane4 [[gnu::vector_size(16)]] = float;

class Smoother {
 public:
  Smoother(const QuadMesh& mesh, std::span<const float> bear) : mesh_(mesh), bear_(bear), links_(make_links(mesh)) {}

  /// S: `steps` steps towards the mean of the neighbors.
  void apply(std::vector<Vec3f>& x, int steps) {
    now_.resize(x.size()), next_.resize(x.size());
    parallel_for(x.size(), 8192, [&](std::size_t v) { now_[v] = Lane4{x[v].x, x[v].y, x[v].z, 0}; });
    for (int s = 0; s < steps; ++s) {
      parallel_for(x.size(), 4096, [&](std::size_t v) { next_[v] = stepped(v); });
      now_.swap(next_);
    }
    parallel_for(x.size(), 8192, [&](std::size_t v) { x[v] = {now_[v][0], now_[v][1], now_[v][2]}; });
  }

 private:
  Lane4 stepped(std::size_t v) const {
    constexpr float kStep = 0.85f;
    const std::uint32_t begin = links_.first[v], end = links_.first[v + 1];
    const std::uint8_t touches = mesh_.touches[v];
    const Lane4 x = now_[v];
    if (begin == end || ((touches & QuadMesh::kSolid) && mesh_.pure_wall(v))) return x;
    Lane4 sum{};
    for (std::uint32_t k = begin; k < end; ++k) sum += now_[links_.to[k]];
    const Lane4 move = (sum / static_cast<float>(end - begin) - x) * (kStep * bear_[v]);
    if ((touches & ~QuadMesh::kFree) == 0) return x + move;
    const Vec3f kept = kept_on(mesh_, v, {move[0], move[1], move[2]});
    return x + Lane4{kept.x, kept.y, kept.z, 0};
  }
  const QuadMesh& mesh_;
  std::span<const float> bear_;
  Links links_;
  std::vector<Lane4> now_, next_;
};

}  // namespace

void smooth(QuadMesh& mesh, std::span<const float> bear, const SmoothSettings& s) {
  if (s.steps <= 0 || mesh.vertices.empty()) return;
  Smoother smoother(mesh, bear);
  std::vector<Vec3f> p = mesh.vertices, rest(p.size());
  smoother.apply(p, s.steps);
  parallel_for(p.size(), 8192, [&](std::size_t v) { rest[v] = mesh.vertices[v] - p[v]; });
  smoother.apply(rest, s.steps);
  parallel_for(p.size(), 8192, [&](std::size_t v) {
    const Vec3f move = kept_on(mesh, v, p[v] + rest[v] - mesh.vertices[v]);  // p + rest may differ in the last bit
    const float l = length(move);
    mesh.vertices[v] += l > s.largest ? move * (s.largest / l) : move;
  });
}

}  // namespace dreampm::surface

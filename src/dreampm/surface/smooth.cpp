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

class Smoother {
 public:
  Smoother(const QuadMesh& mesh, std::span<const float> bear) : mesh_(mesh), bear_(bear), links_(make_links(mesh)) {}

  /// S: `steps` steps towards the mean of the neighbors.
  void apply(std::vector<Vec3f>& x, int steps) {
    next_.resize(x.size());
    for (int s = 0; s < steps; ++s) {
      parallel_for(x.size(), 4096, [&](std::size_t v) { next_[v] = stepped(x, v); });
      x.swap(next_);
    }
  }

 private:
  Vec3f stepped(const std::vector<Vec3f>& x, std::size_t v) const {
    constexpr float kStep = 0.85f;
    const std::uint32_t begin = links_.first[v], end = links_.first[v + 1];
    if (begin == end) return x[v];
    Vec3f sum{};
    for (std::uint32_t k = begin; k < end; ++k) sum += x[links_.to[k]];
    Vec3f move = (sum / static_cast<float>(end - begin) - x[v]) * (kStep * bear_[v]);
    const std::uint8_t walls = mesh_.touches[v];
    if (walls & 3) move.x = 0;
    if (walls & 12) move.y = 0;
    if (walls & 48) move.z = 0;
    return x[v] + move;
  }
  const QuadMesh& mesh_;
  std::span<const float> bear_;
  Links links_;
  std::vector<Vec3f> next_;
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
    Vec3f move = p[v] + rest[v] - mesh.vertices[v];
    const std::uint8_t walls = mesh.touches[v];  // p + rest may differ from x in the last bit
    if (walls & 3) move.x = 0;
    if (walls & 12) move.y = 0;
    if (walls & 48) move.z = 0;
    const float l = length(move);
    mesh.vertices[v] += l > s.largest ? move * (s.largest / l) : move;
  });
}

}  // namespace dreampm::surface

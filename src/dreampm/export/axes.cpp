#include "dreampm/export/axes.h"

#include <fmt/format.h>

#include <array>

namespace dreampm::exchange {
namespace {

/// F becomes R F R^T, as both its sides are turned: an entry moves, and may change its sign.
void turn_gradient(ParticleFrame& frame) {
  constexpr std::array<int, 3> from{0, 2, 1};
  constexpr std::array<float, 3> sign{1, -1, 1};
  std::array<std::vector<float>, 9> old;
  const auto name = [](int i, int j) { return fmt::format("f_{}{}", i, j); };
  for (int k = 0; k < 9; ++k) {
    const auto column = frame.columns.find(name(k / 3, k % 3));
    if (column == frame.columns.end() || column->second.size() != frame.size()) return;
  }
  for (int k = 0; k < 9; ++k) old[std::size_t(k)] = std::move(frame.columns[name(k / 3, k % 3)]);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      const std::size_t a = std::size_t(i), b = std::size_t(j);
      std::vector<float> values = old[std::size_t(3 * from[a] + from[b])];
      for (float& v : values) v *= sign[a] * sign[b];
      frame.columns[name(i, j)] = std::move(values);
    }
}

}  // namespace

void Axes::apply(TriMesh& mesh) const {
  for (Vec3f& v : mesh.vertices) v = placed(v);
  for (Vec3f& v : mesh.velocities) v = placed(v);
  for (Vec3f& n : mesh.normals) n = turned(n);
}

void Axes::apply(VertexAttributes& attributes) const {
  for (VertexAttribute& a : attributes)
    for (std::size_t i = 0; a.kind == AttributeKind::vector && i + 2 < a.values.size(); i += 3) {
      const Vec3f v = turned(Vec3f{a.values[i], a.values[i + 1], a.values[i + 2]});
      for (int c = 0; c < 3; ++c) a.values[i + static_cast<std::size_t>(c)] = v[c];
    }
}

void Axes::apply(ParticleFrame& frame) const {
  for (Vec3f& x : frame.position) x = placed(x);
  for (Vec3d& x : frame.exact) x = placed(x);
  for (Vec3f& v : frame.velocity) v = placed(v);
  frame.shift = placed(frame.shift);
  if (up == Up::z) turn_gradient(frame);
}

}  // namespace dreampm::exchange

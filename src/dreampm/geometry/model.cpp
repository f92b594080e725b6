#include "dreampm/geometry/model.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include "dreampm/base/error.h"
#include "dreampm/geometry/ears.h"

namespace dreampm {
namespace {

/// A polygon seen along its mean normal (Newell's), so that it turns to the left as a whole.
std::vector<std::array<double, 2>> outline(const std::vector<Vec3d>& vertices,
                                           const std::vector<std::uint32_t>& corners) {
  const Vec3d from = vertices[corners[0]];
  Vec3d normal{};
  for (std::size_t i = 0; i < corners.size(); ++i)
    normal += cross(vertices[corners[i]] - from, vertices[corners[(i + 1) % corners.size()]] - from);
  const int along = std::abs(normal.x) > std::abs(normal.y) ? (std::abs(normal.x) > std::abs(normal.z) ? 0 : 2)
                                                            : (std::abs(normal.y) > std::abs(normal.z) ? 1 : 2);
  int u = (along + 1) % 3, v = (along + 2) % 3;
  if (normal[along] < 0) std::swap(u, v);
  std::vector<std::array<double, 2>> points;
  for (const std::uint32_t c : corners) points.push_back({vertices[c][u] - from[u], vertices[c][v] - from[v]});
  return points;
}

}  // namespace

Model model_of(const TriMesh& mesh) {
  Model model;
  model.vertices.reserve(mesh.vertices.size());
  for (const Vec3f& v : mesh.vertices) model.vertices.push_back(static_cast<Vec3d>(v));
  model.triangles = mesh.triangles;
  return model;
}

Box3d bounds_of(const Model& model) {
  Box3d box;
  for (const auto& t : model.triangles)
    for (const std::uint32_t v : t) box.add(model.vertices[v]);
  if (model.triangles.empty())
    for (const Vec3d& v : model.vertices) box.add(v);
  return box;
}

double enclosed_volume(const Model& model) {
  const Vec3d center = bounds_of(model).center();
  double six = 0;
  for (const auto& [a, b, c] : model.triangles)
    six += dot(model.vertices[a] - center, cross(model.vertices[b] - center, model.vertices[c] - center));
  return six / 6;
}

double surface_area(const Model& model) {
  double two = 0;
  for (const auto& [a, b, c] : model.triangles)
    two += length(cross(model.vertices[b] - model.vertices[a], model.vertices[c] - model.vertices[a]));
  return two / 2;
}

TriMesh about(const Model& model, const Vec3d& origin) {
  TriMesh mesh;
  mesh.vertices.reserve(model.vertices.size());
  for (const Vec3d& v : model.vertices) mesh.vertices.push_back(static_cast<Vec3f>(v - origin));
  mesh.triangles = model.triangles;
  return mesh;
}

void require_finite(const Model& model, const std::string& name) {
  for (std::size_t i = 0; i < model.vertices.size(); ++i)
    if (const Vec3d& v = model.vertices[i]; !is_finite(static_cast<Vec3f>(v)))
      fail_input("{}: vertex {} is ({}, {}, {}), not a finite place", name, i, v.x, v.y, v.z);
}

std::vector<std::uint32_t> by_place(const std::vector<Vec3d>& vertices) {
  std::vector<std::uint32_t> order(vertices.size()), same(vertices.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto place = [&](std::uint32_t v) { return std::tuple(vertices[v].x, vertices[v].y, vertices[v].z, v); };
  std::sort(order.begin(), order.end(), [&](auto a, auto b) { return place(a) < place(b); });
  for (std::size_t i = 0; i < order.size(); ++i)
    same[order[i]] = i > 0 && vertices[order[i]] == vertices[order[i - 1]] ? same[order[i - 1]] : order[i];
  return same;
}

void join_corners(Model& model) {
  const std::vector<std::uint32_t> same = by_place(model.vertices);
  std::vector<std::uint32_t> index(same.size());
  std::vector<Vec3d> kept;
  for (std::uint32_t v = 0; v < same.size(); ++v) {
    if (same[v] == v) {
      index[v] = static_cast<std::uint32_t>(kept.size());
      kept.push_back(model.vertices[v]);
    } else {
      index[v] = index[same[v]];
    }
  }
  model.vertices = std::move(kept);
  for (auto& t : model.triangles)
    for (std::uint32_t& v : t) v = index[v];
}

void add_polygon(Model& model, const std::vector<std::uint32_t>& corners) {
  const std::size_t n = corners.size();
  const auto add = [&](std::size_t a, std::size_t b, std::size_t c) {
    model.triangles.push_back({corners[a], corners[b], corners[c]});
  };
  if (n < 3) return;
  if (n == 3) return add(0, 1, 2);
  for (const auto& [a, b, c] : cut_polygon(outline(model.vertices, corners))) add(a, b, c);
}

void add_strip(Model& model, const std::vector<std::uint32_t>& strip) {
  for (std::size_t k = 2; k < strip.size(); ++k) {
    const std::uint32_t a = strip[k - 2 + k % 2], b = strip[k - 1 - k % 2], c = strip[k];
    if (a != b && b != c && c != a) model.triangles.push_back({a, b, c});  // others only lead the strip on
  }
}

std::uint8_t color_byte(double value) {
  return static_cast<std::uint8_t>(std::lround(std::clamp(std::isfinite(value) ? value : 0.0, 0.0, 255.0)));
}

}  // namespace dreampm

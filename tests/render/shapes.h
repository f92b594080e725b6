// Small closed meshes for the tests.
#pragma once
#include <cmath>
#include <numbers>

#include "dreampm/math/srgb.h"
#include "dreampm/render/render.h"

namespace dreampm {

inline TriMesh box_mesh(const Vec3f& a, const Vec3f& b) {
  TriMesh m;
  for (int k = 0; k < 8; ++k)
    m.vertices.push_back({(k & 1) != 0 ? b.x : a.x, (k & 2) != 0 ? b.y : a.y, (k & 4) != 0 ? b.z : a.z});
  m.triangles = {{0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}, {0, 1, 5}, {0, 5, 4},
                 {2, 6, 7}, {2, 7, 3}, {0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}};
  // a box has sharp edges: every face gets vertices of its own
  TriMesh flat;
  for (const auto& t : m.triangles) {
    const auto first = static_cast<std::uint32_t>(flat.vertices.size());
    for (const std::uint32_t v : t) flat.vertices.push_back(m.vertices[v]);
    flat.triangles.push_back({first, first + 1, first + 2});
  }
  return flat;
}

inline TriMesh ball_mesh(const Vec3f& center, float radius, std::uint32_t rows) {
  TriMesh m;
  const std::uint32_t columns = 2 * rows;
  for (std::uint32_t j = 0; j <= rows; ++j)
    for (std::uint32_t i = 0; i < columns; ++i) {
      const float t = std::numbers::pi_v<float> * static_cast<float>(j) / static_cast<float>(rows);
      const float f = 2 * std::numbers::pi_v<float> * static_cast<float>(i) / static_cast<float>(columns);
      m.vertices.push_back(center + Vec3f{std::sin(t) * std::cos(f), std::cos(t), std::sin(t) * std::sin(f)} * radius);
    }
  for (std::uint32_t j = 0; j < rows; ++j)
    for (std::uint32_t i = 0; i < columns; ++i) {
      const std::uint32_t a = j * columns + i, b = j * columns + (i + 1) % columns;
      if (j > 0) m.triangles.push_back({a, b, b + columns});
      if (j + 1 < rows) m.triangles.push_back({a, b + columns, a + columns});
    }
  return m;
}

/// The color of a look whose linear reflectance is that.
inline Vec3d srgb_of(const Vec3f& linear) {
  const auto channel = [](float x) { return srgb_from_linear(static_cast<double>(x)); };
  return {channel(linear.x), channel(linear.y), channel(linear.z)};
}

/// One object before a sky of radiance 1, without sun, floor or glass, seen along -z.
inline RenderScene before_uniform_sky(const RenderObject& object, float fov) {
  RenderScene s;
  s.basin = {{-1, -1, -1}, {1, 1, 1}};
  s.objects = {object};
  s.camera.fit_basin = false;
  s.camera.from = {0, 0, 4}, s.camera.to = {0, 0, 0}, s.camera.fov = fov;
  s.light.sun.strength = 0, s.light.sky = SkyKind::uniform;
  s.stage = {.floor = model::Floor::none, .basin = model::Basin::none};
  s.physical = true;
  return s;
}

inline RenderSettings small_picture(int width, int height, int samples) {
  RenderSettings s;
  s.width = width, s.height = height, s.min_samples = s.samples = samples;
  return s;
}

inline Vec3f mean_of(const Image& image) {
  Vec3d sum;
  for (const Vec3f& c : image.linear) sum += static_cast<Vec3d>(c);
  return static_cast<Vec3f>(sum / static_cast<double>(image.linear.size()));
}

}  // namespace dreampm

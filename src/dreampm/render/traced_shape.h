// One mesh, or balls of one object, as the tracer meets them.
#pragma once
#include <array>

#include "dreampm/render/intersect.h"

namespace dreampm::trace {

/// What of a geometry of Embree is asked for at a hit, and Embree does not give.
struct TracedShape {
  Kind kind = Kind::none;
  int object = air;
  bool spheres = false;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<Vec3f> normals;       ///< per vertex; empty: flat faces
  std::vector<std::uint8_t> walls;  ///< per triangle: 0, or 1 + the wall it lies on
  std::vector<Vec3f> colors;        ///< per sphere or vertex; or empty
  std::vector<float> opacity{};     ///< per grain; of others empty
  std::vector<Vec3f> centers{};     ///< m, per grain, with their radii
  std::vector<float> radii{};
  const Vec3f* points = nullptr;                ///< m, of the triangles; Embree has them
  const std::array<float, 4>* balls = nullptr;  ///< m, middles and radii of spheres; Embree has them
  std::vector<Vec3f> velocities{};              ///< m/s, per sphere, grain or vertex; empty: at rest
  std::vector<std::vector<Vec3f>> steps{};      ///< m, per step and vertex; or empty
  std::vector<std::vector<Vec3f>> turned{};     ///< normals per step and vertex; or empty

  Vec3f color(const Vec3f& of_look, std::size_t primitive, float u, float v) const;
  /// Of a triangle's vertices at a place on it.
  Vec3f mixed(const std::vector<Vec3f>& values, std::size_t primitive, float u, float v) const {
    const auto& [a, b, c] = triangles[primitive];
    return values[a] * (1 - u - v) + values[b] * u + values[c] * v;
  }
  Vec3f velocity(std::size_t primitive, float u, float v) const;
  /// The normal at a time, not yet of unit length.
  Vec3f normal(std::size_t primitive, float u, float v, float time) const;
  /// How far a place on a triangle has moved since the middle of the exposure.
  Vec3f moved(std::size_t primitive, float u, float v, float time) const;
};

}  // namespace dreampm::trace

// What lies under the mouse. Plain arithmetic, without OpenGL.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "dreampm/gl/camera.h"

namespace dreampm::gl {

/// How far along the ray the first of the spheres about `centers` begins [m], if the ray meets any;
/// those that hold its origin do not count. Goes over all of them: 65,536 take about 0.1 ms.
std::optional<float> first_sphere(const Ray& ray, std::span<const Vec3f> centers, float radius);

/// Where the ray meets the first of the triangles between `vertices`, from either side, in front of
/// its origin [m].
std::optional<float> first_triangle(const Ray& ray, std::span<const Vec3f> vertices,
                                    std::span<const std::array<std::uint32_t, 3>> triangles);

}  // namespace dreampm::gl

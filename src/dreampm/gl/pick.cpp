#include "dreampm/gl/pick.h"

#include <cmath>

namespace dreampm::gl {

std::optional<float> first_sphere(const Ray& ray, std::span<const Vec3f> centers, float radius) {
  const float r2 = radius * radius;
  std::optional<float> first;
  for (const Vec3f& center : centers) {
    const Vec3f arm = center - ray.origin;
    const float along = dot(arm, ray.direction), off2 = length2(arm - ray.direction * along);
    if (!(off2 < r2)) continue;
    const float begins = along - std::sqrt(r2 - off2);
    if (begins > 0 && (!first || begins < *first)) first = begins;
  }
  return first;
}

std::optional<float> first_triangle(const Ray& ray, std::span<const Vec3f> vertices,
                                    std::span<const std::array<std::uint32_t, 3>> triangles) {
  std::optional<float> first;
  for (const auto& t : triangles) {
    // Moeller and Trumbore 1997.
    const Vec3f& a = vertices[t[0]];
    const Vec3f ab = vertices[t[1]] - a, ac = vertices[t[2]] - a, across = cross(ray.direction, ac);
    const float volume = dot(ab, across);
    if (volume == 0) continue;
    const Vec3f from = ray.origin - a, turned = cross(from, ab);
    const float u = dot(from, across) / volume, v = dot(ray.direction, turned) / volume;
    if (!(u >= 0 && v >= 0 && u + v <= 1)) continue;
    if (const float along = dot(ac, turned) / volume; along > 0 && (!first || along < *first)) first = along;
  }
  return first;
}

}  // namespace dreampm::gl

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

std::optional<float> plane_hit(const Ray& ray, const Vec3f& point, const Vec3f& normal) {
  const float along = dot(ray.direction, normal);
  if (std::abs(along) < 1e-6f * length(normal)) return std::nullopt;
  const float t = dot(point - ray.origin, normal) / along;
  return t > 0 ? std::optional(t) : std::nullopt;
}

}  // namespace dreampm::gl

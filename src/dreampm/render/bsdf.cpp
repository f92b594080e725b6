#include "dreampm/render/bsdf.h"

#include "dreampm/render/color.h"

namespace dreampm::trace {

Vec3f Matte::eval(int, const Vec3f&, const Vec3f& light, const Vec3f& color) const {
  return color * (std::max(0.0f, light.z) / pi);
}

float Matte::pdf(int, const Vec3f&, const Vec3f& light) const { return std::max(0.0f, light.z) / pi; }

Bsdf::Sample Matte::sample(int, const Vec3f&, const Vec3f& color, float a, float b) const {
  return {cosine_hemisphere(a, b), color};
}

}  // namespace dreampm::trace

#include "dreampm/render/interface.h"

#include "dreampm/render/color.h"

namespace dreampm::trace {
namespace {

/// The outer face of the glass behind a water face adds this.
constexpr float glass_face = 0.02f;
const Vec3f bar_tint{0.45f, 0.72f, 0.66f};

/// A shading normal may send light through the face itself; bend it back.
Vec3f keep_side(Vec3f d, const Vec3f& face, float sign) {
  const float below = sign * dot(d, face);
  if (below < 0) d = d - face * (1.02f * sign * below);
  return normalized(d);
}

}  // namespace

Split split_light(const Geometry& geometry, const Hit& hit, const Vec3f& d, int medium) {
  Split s;
  const Vec3f n = hit.back ? -hit.normal : hit.normal;
  s.side = hit.back ? -hit.geometric : hit.geometric;
  const float cos_in = std::clamp(-dot(n, d), 0.0f, 1.0f);
  float cos_out = cos_in, eta = 1;
  s.reflected_medium = s.refracted_medium = medium;
  if (hit.kind == Kind::dielectric) {
    const float ior = std::get<DielectricLook>(geometry.look(hit.object)).ior;
    eta = hit.back ? ior : 1 / ior;
    s.reflectance = fresnel(cos_in, eta, cos_out);
    if (hit.glass && s.reflectance < 1) s.reflectance = std::min(1.0f, s.reflectance + glass_face);
    s.reflected_medium = hit.back ? hit.object : air;
    s.refracted_medium = hit.back ? air : hit.object;
  } else if (hit.kind == Kind::pane) {
    s.reflectance = pane_reflectance(cos_in);
    s.tint = pane_tint;
  } else {
    s.reflectance = fresnel(cos_in, 1 / 1.5f, cos_out);
    s.tint = bar_tint;
  }
  s.reflected = keep_side(d + n * (2 * cos_in), s.side, 1);
  s.refracted = hit.kind == Kind::dielectric ? keep_side(d * eta + n * (eta * cos_in - cos_out), s.side, -1) : d;
  return s;
}

}  // namespace dreampm::trace

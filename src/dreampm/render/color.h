// Small helpers on colors and directions.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "dreampm/math/vec.h"

namespace dreampm::trace {

inline constexpr float pi = std::numbers::pi_v<float>;
inline constexpr float degree = pi / 180;

inline float largest(const Vec3f& c) { return std::max(c.x, std::max(c.y, c.z)); }
inline float luminance(const Vec3f& c) { return 0.2126f * c.x + 0.7152f * c.y + 0.0722f * c.z; }
template <class T>
T mix(const T& a, const T& b, float t) {
  return a * (1 - t) + b * t;
}
inline float smoothstep(float a, float b, float x) {
  const float t = std::clamp((x - a) / (b - a), 0.0f, 1.0f);
  return t * t * (3 - 2 * t);
}
/// exp(-sigma t), by channel.
inline Vec3f transmission(const Vec3f& sigma, float t) {
  return {std::exp(-sigma.x * t), std::exp(-sigma.y * t), std::exp(-sigma.z * t)};
}

/// Two unit vectors square to the unit vector n and to each other.
struct Frame {
  Vec3f u, v, n;
  explicit Frame(const Vec3f& normal) : n(normal) {
    u = normalized(cross(std::fabs(n.y) < 0.9f ? Vec3f{0, 1, 0} : Vec3f{1, 0, 0}, n));
    v = cross(n, u);
  }
  Vec3f world(float x, float y, float z) const { return u * x + v * y + n * z; }
  Vec3f local(const Vec3f& d) const { return {dot(d, u), dot(d, v), dot(d, n)}; }
};

/// A direction about z with density cos/pi.
inline Vec3f cosine_hemisphere(float a, float b) {
  const float r = std::sqrt(a), phi = 2 * pi * b;
  return {r * std::cos(phi), r * std::sin(phi), std::sqrt(std::max(0.0f, 1 - a))};
}
/// The same about frame.n.
inline Vec3f cosine_direction(const Frame& frame, float a, float b) {
  const Vec3f d = cosine_hemisphere(a, b);
  return frame.world(d.x, d.y, d.z);
}

/// Share of unpolarised light that a smooth interface reflects. `cos_in` >= 0 in the first medium,
/// eta = n1/n2; `cos_out` is the cosine behind it (0 under total reflection, where the share is 1).
inline float fresnel(float cos_in, float eta, float& cos_out) {
  const float k = 1 - eta * eta * (1 - cos_in * cos_in);
  cos_out = k > 0 ? std::sqrt(k) : 0;
  if (k <= 0) return 1;
  const float s = (eta * cos_in - cos_out) / (eta * cos_in + cos_out);
  const float p = (eta * cos_out - cos_in) / (eta * cos_out + cos_in);
  return 0.5f * (s * s + p * p);
}

/// Share that a thin pane (two faces, ior 1.5, all inner reflections) reflects.
inline float pane_reflectance(float cos_in) {
  float cos_out;
  const float r = fresnel(cos_in, 1 / 1.5f, cos_out);
  return 2 * r / (1 + r);
}

/// A well-mixed 32-bit hash (constants of Wellons' lowbias32 search).
inline std::uint32_t hash32(std::uint32_t x) {
  x = (x ^ (x >> 16)) * 0x7feb352du;
  x = (x ^ (x >> 15)) * 0x846ca68bu;
  return x ^ (x >> 16);
}
inline float unit_float(std::uint32_t h) { return static_cast<float>(h >> 8) * 0x1p-24f; }

/// Smooth noise in [0, 1] with one lattice cell per unit.
inline float value_noise(float x, float y) {
  const float fx = std::floor(x), fy = std::floor(y);
  const int ix = static_cast<int>(fx), iy = static_cast<int>(fy);
  const float u = smoothstep(0, 1, x - fx), v = smoothstep(0, 1, y - fy);
  const auto at = [](int i, int j) {
    return unit_float(
        hash32(static_cast<std::uint32_t>(i) * 0x8da6b343u ^ static_cast<std::uint32_t>(j) * 0xd8163841u));
  };
  return mix(mix(at(ix, iy), at(ix + 1, iy), u), mix(at(ix, iy + 1), at(ix + 1, iy + 1), u), v);
}

}  // namespace dreampm::trace

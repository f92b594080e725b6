#include "dreampm/render/glossy.h"

#include "dreampm/render/color.h"

namespace dreampm::trace {
namespace {

constexpr float coat_ior = 1.5f;
/// A gloss narrower than this mirrors the sun's disc; a wider one is lit by it directly.
constexpr float mirror_below = 0.01f;
/// A base that gets less than this of all light is left out.
constexpr float least_base = 1e-4f;
/// Samples each way of one entry of the table.
constexpr int table_samples = 24;
constexpr float least_cosine = 1e-4f;

float ggx(float cos_half, float alpha) {
  const float k = cos_half * cos_half * (alpha * alpha - 1) + 1;
  return alpha * alpha / (pi * k * k);
}
/// Smith's Lambda.
float lambda(float c, float alpha) {
  const float c2 = c * c;
  return 0.5f * (std::sqrt(1 + alpha * alpha * std::max(0.0f, 1 - c2) / c2) - 1);
}

/// A microfacet's normal among those that `view` sees (Heitz 2018, "Sampling the GGX distribution
/// of visible normals").
Vec3f visible_normal(const Vec3f& view, float alpha, float a, float b) {
  const Vec3f v = normalized(Vec3f{alpha * view.x, alpha * view.y, view.z});
  const float across2 = v.x * v.x + v.y * v.y;
  const Vec3f t1 = across2 > 0 ? Vec3f{-v.y, v.x, 0} / std::sqrt(across2) : Vec3f{1, 0, 0}, t2 = cross(v, t1);
  const float r = std::sqrt(a), phi = 2 * pi * b, s = 0.5f * (1 + v.z), p1 = r * std::cos(phi);
  const float p2 = mix(std::sqrt(std::max(0.0f, 1 - p1 * p1)), r * std::sin(phi), s);
  const Vec3f n = t1 * p1 + t2 * p2 + v * std::sqrt(std::max(0.0f, 1 - p1 * p1 - p2 * p2));
  return normalized(Vec3f{alpha * n.x, alpha * n.y, std::max(1e-6f, n.z)});
}

}  // namespace

Glossy::Glossy(float roughness) : alpha_(std::max(1e-3f, roughness * roughness)), mirror_(alpha_ < mirror_below) {}

void Glossy::tabulate() {
  const Vec3f white{1, 1, 1};
  for (int i = 0; i < entries; ++i) {
    const float root = std::max(0.02f, static_cast<float>(i) / (entries - 1)), c = root * root;
    const Vec3f view{std::sqrt(std::max(0.0f, 1 - c * c)), 0, c};
    float sum = 0;
    for (int k = 0; k < table_samples * table_samples; ++k) {
      // denser where normals are steep
      const float t = (static_cast<float>(k % table_samples) + 0.5f) / table_samples,
                  b = (static_cast<float>(k / table_samples) + 0.5f) / table_samples;
      const Vec3f h = visible_normal(view, alpha_, 1 - t * t, b);
      const float cos_half = dot(view, h), cos_light = 2 * cos_half * h.z - c;
      if (cos_light <= 0) continue;
      const float lv = lambda(c, alpha_);
      sum += 2 * t * reflectance(cos_half, white).x * (1 + lv) / (1 + lv + lambda(cos_light, alpha_));
    }
    share_[static_cast<std::size_t>(i)] = sum / (table_samples * table_samples);
  }
  constexpr int steps = 512;
  for (int i = 0; i < steps; ++i) {
    const float c = (static_cast<float>(i) + 0.5f) / steps;
    mean_share_ += share(0, c) * 2 * c / steps;
  }
  has_base_ = 1 - mean_share_ > least_base;
}

float Glossy::share(int lobe, float cos_view) const {
  const float x = std::sqrt(std::clamp(cos_view, 0.0f, 1.0f)) * (entries - 1);
  const auto i = std::min(static_cast<std::size_t>(x), static_cast<std::size_t>(entries - 2));
  const float gloss = mix(share_[i], share_[i + 1], x - static_cast<float>(i));
  return lobe == 0 ? gloss : 1 - gloss;
}

Vec3f Glossy::eval(int lobe, const Vec3f& view, const Vec3f& light, const Vec3f& color) const {
  if (light.z <= 0 || mirror(lobe)) return {};
  if (lobe == 1) return base_color(color) * (share(1, view.z) * share(1, light.z) / (1 - mean_share_) * (light.z / pi));
  const float cos_view = std::max(least_cosine, view.z);
  const Vec3f h = normalized(view + light);
  return reflectance(dot(view, h), color) *
         (ggx(h.z, alpha_) / ((1 + lambda(cos_view, alpha_) + lambda(light.z, alpha_)) * 4 * cos_view));
}

float Glossy::pdf(int lobe, const Vec3f& view, const Vec3f& light) const {
  if (light.z <= 0 || mirror(lobe)) return 0;
  if (lobe == 1) return light.z / pi;
  const float cos_view = std::max(least_cosine, view.z);
  return ggx(normalized(view + light).z, alpha_) / ((1 + lambda(cos_view, alpha_)) * 4 * cos_view);
}

Bsdf::Sample Glossy::sample(int lobe, const Vec3f& view, const Vec3f& color, float a, float b) const {
  Sample s;
  if (lobe == 1) {
    s.light = cosine_hemisphere(a, b);
    s.weight = base_color(color) * (share(1, view.z) * share(1, s.light.z) / (1 - mean_share_));
    return s;
  }
  const float cos_view = std::max(least_cosine, view.z);
  const Vec3f h = visible_normal(view, alpha_, a, b);
  const float cos_half = dot(view, h);
  s.light = h * (2 * cos_half) - view;
  if (s.light.z <= 0 || cos_half <= 0) return s;
  const float lv = lambda(cos_view, alpha_);
  s.weight = reflectance(cos_half, color) * ((1 + lv) / (1 + lv + lambda(s.light.z, alpha_)));
  return s;
}

Conductor::Conductor(float roughness) : Glossy(roughness) { tabulate(); }

/// Schlick's approximation.
Vec3f Conductor::reflectance(float cos_half, const Vec3f& color) const {
  const float m = 1 - std::clamp(cos_half, 0.0f, 1.0f), m2 = m * m;
  return color + (Vec3f{1, 1, 1} - color) * (m2 * m2 * m);
}

// Light that is not reflected at once is reflected k > 1 times with the share F^k E (1 - E)^(k - 1)
// of all, where F is Schlick's mean over directions, color + (1 - color)/21, and E mean_share.
Vec3f Conductor::base_color(const Vec3f& color) const {
  const auto channel = [e = mean_share()](float c) {
    const float f = c + (1 - c) / 21;
    return f * f * e / (1 - f * (1 - e));
  };
  return {channel(color.x), channel(color.y), channel(color.z)};
}

Coated::Coated(float roughness, float outer_ior) : Glossy(roughness), eta_(outer_ior / coat_ior) { tabulate(); }

Vec3f Coated::reflectance(float cos_half, const Vec3f&) const {
  float cos_out;
  const float f = fresnel(std::clamp(cos_half, 0.0f, 1.0f), eta_, cos_out);
  return {f, f, f};
}

}  // namespace dreampm::trace

#include "dreampm/render/rough_surface.h"

#include "dreampm/render/color.h"

namespace dreampm::trace {
namespace {

constexpr float coat_ior = 1.5f;
/// A gloss narrower than this mirrors the sun's disc; a wider one is lit by it directly.
constexpr float mirror_below = 0.01f;
/// Samples each way of one entry of the table.
constexpr int table_samples = 24;

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

struct Gloss {
  float roughness = 0;
  bool coat = true;
};

Gloss gloss_of(const Look& look) {
  if (const auto* metal = std::get_if<Metal>(&look)) return {metal->roughness, false};
  if (const auto* wood = std::get_if<Wood>(&look)) return {wood->roughness, true};
  return {std::get<Plastic>(look).roughness, true};
}

}  // namespace

RoughSurface::RoughSurface(const Look& look, float outer_ior) {
  const Gloss gloss = gloss_of(look);
  has_base_ = gloss.coat;
  alpha_ = std::max(1e-3f, gloss.roughness * gloss.roughness);
  mirror_ = alpha_ < mirror_below;
  eta_ = outer_ior / coat_ior;
  const Vec3f white{1, 1, 1};
  for (int i = 0; i < entries; ++i) {
    const float root = std::max(0.02f, static_cast<float>(i) / (entries - 1)), c = root * root;
    const Vec3f view{std::sqrt(std::max(0.0f, 1 - c * c)), 0, c};
    float sum = 0;
    for (int k = 0; k < table_samples * table_samples; ++k) {
      const float a = (static_cast<float>(k % table_samples) + 0.5f) / table_samples,
                  b = (static_cast<float>(k / table_samples) + 0.5f) / table_samples;
      const Vec3f h = visible_normal(view, alpha_, a, b);
      const float cos_half = dot(view, h), cos_light = 2 * cos_half * h.z - c;
      if (cos_light <= 0) continue;
      const float lv = lambda(c, alpha_);
      sum += reflectance(cos_half, white).x * (1 + lv) / (1 + lv + lambda(cos_light, alpha_));
    }
    share_[static_cast<std::size_t>(i)] = sum / (table_samples * table_samples);
  }
  constexpr int steps = 512;
  for (int i = 0; i < steps; ++i) {
    const float c = (static_cast<float>(i) + 0.5f) / steps;
    mean_share_ += gloss_share(c) * 2 * c / steps;
  }
}

/// Schlick's approximation for a metal, Fresnel's formula for a coat.
Vec3f RoughSurface::reflectance(float cos_half, const Vec3f& color) const {
  const float c = std::clamp(cos_half, 0.0f, 1.0f);
  if (has_base_) {
    float cos_out;
    const float f = fresnel(c, eta_, cos_out);
    return {f, f, f};
  }
  const float m = 1 - c, m2 = m * m;
  return color + (Vec3f{1, 1, 1} - color) * (m2 * m2 * m);
}

float RoughSurface::gloss_share(float cos_view) const {
  const float x = std::sqrt(std::clamp(cos_view, 0.0f, 1.0f)) * (entries - 1);
  const auto i = std::min(static_cast<std::size_t>(x), static_cast<std::size_t>(entries - 2));
  return mix(share_[i], share_[i + 1], x - static_cast<float>(i));
}

/// What bounces more than once among the microfacets of a metal (Turquin 2019, "Practical multiple
/// scattering compensation for microfacet models", eq. 16). Under a coat the base takes it.
Vec3f RoughSurface::gain(float cos_view, const Vec3f& color) const {
  if (has_base_) return {1, 1, 1};
  return Vec3f{1, 1, 1} + color * (1 / gloss_share(cos_view) - 1);
}

RoughSurface::Sample RoughSurface::sample_gloss(const Vec3f& view, const Vec3f& color, float a, float b) const {
  const float cos_view = std::max(1e-4f, view.z);
  const Vec3f h = visible_normal(view, alpha_, a, b);
  const float cos_half = dot(view, h);
  Sample s;
  s.light = h * (2 * cos_half) - view;
  if (s.light.z <= 0 || cos_half <= 0) return s;
  const float lv = lambda(cos_view, alpha_);
  s.weight = reflectance(cos_half, color) * gain(cos_view, color) * ((1 + lv) / (1 + lv + lambda(s.light.z, alpha_)));
  return s;
}

// The base gets what the gloss leaves, either way (Kelemen and Szirmay-Kalos 2001, "A microfacet
// based coupled specular-matte BRDF model with importance sampling").
Vec3f RoughSurface::base_weight(const Vec3f& view, const Vec3f& light, const Vec3f& color) const {
  return color * ((1 - gloss_share(view.z)) * (1 - gloss_share(light.z)) / (1 - mean_share_));
}

Vec3f RoughSurface::scattered(const Vec3f& view, const Vec3f& light, const Vec3f& color) const {
  if (light.z <= 0) return {};
  Vec3f f;
  if (has_base_) f = base_weight(view, light, color) * (light.z / pi);
  if (mirror_) return f;
  const float cos_view = std::max(1e-4f, view.z);
  const Vec3f h = normalized(view + light);
  return f + reflectance(dot(view, h), color) * gain(cos_view, color) *
                 (ggx(h.z, alpha_) / ((1 + lambda(cos_view, alpha_) + lambda(light.z, alpha_)) * 4 * cos_view));
}

RoughSurfaces::RoughSurfaces(const Geometry& geometry) : media_(geometry.objects() + 1) {
  const auto dielectric = [&](int o) { return std::get_if<Dielectric>(&geometry.look(o)); };
  for (int o = 0; o < geometry.objects(); ++o) {
    const bool smooth = dielectric(o) != nullptr || std::holds_alternative<Opaque>(geometry.look(o));
    for (int m = air; m < geometry.objects(); ++m) {
      const bool possible = !smooth && (m == air || dielectric(m) != nullptr);
      index_.push_back(possible ? static_cast<int>(surfaces_.size()) : -1);
      if (possible) surfaces_.emplace_back(geometry.look(o), m == air ? 1 : dielectric(m)->ior);
    }
  }
}

const RoughSurface& RoughSurfaces::at(int object, int medium) const {
  const int i = index_[static_cast<std::size_t>(object * media_ + medium + 1)];
  return surfaces_[static_cast<std::size_t>(i)];
}

}  // namespace dreampm::trace

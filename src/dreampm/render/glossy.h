// Light at rough surfaces: metal, and a matte base under a clear coat (plastic, varnished wood).
// Microfacets after Trowbridge and Reitz (GGX) with the height-correlated masking of Smith (Heitz
// 2014, "Understanding the masking-shadowing function"). Neither absorbs more than its color says:
// a white one in a white furnace is invisible. Both are the same in either direction of light.
#pragma once
#include <array>

#include "dreampm/render/bsdf.h"

namespace dreampm::trace {

/// Reflection at microfacets, the lobe 0, over a matte base that gets what these leave, either way
/// (Kelemen and Szirmay-Kalos 2001, "A microfacet based coupled specular-matte BRDF model with
/// importance sampling").
class Glossy : public Bsdf {
 public:
  int lobes() const final { return has_base_ ? 2 : 1; }
  bool mirror(int lobe) const final { return lobe == 0 && mirror_; }
  bool wide(int lobe) const final { return lobe == 1; }
  float share(int lobe, float cos_view) const final;
  using Bsdf::eval;
  Vec3f eval(int lobe, const Vec3f& view, const Vec3f& light, const Vec3f& color) const final;
  float pdf(int lobe, const Vec3f& view, const Vec3f& light) const final;
  Sample sample(int lobe, const Vec3f& view, const Vec3f& color, float a, float b) const final;

 protected:
  /// `roughness`: 0 (polished) to 1.
  explicit Glossy(float roughness);
  /// To be called by the constructor of what knows the reflectance.
  void tabulate();
  /// Of a microfacet under that angle.
  virtual Vec3f reflectance(float cos_half, const Vec3f& color) const = 0;
  /// Of the base.
  virtual Vec3f base_color(const Vec3f& color) const = 0;
  /// The share of all light, from everywhere to everywhere, that microfacets of a color of 1
  /// reflect at once.
  float mean_share() const { return mean_share_; }

 private:
  static constexpr int entries = 48;
  float alpha_;
  bool mirror_, has_base_ = true;
  std::array<float, entries> share_{};  ///< over the root of the view's cosine
  float mean_share_ = 0;                ///< over all directions, weighted by the cosine
};

/// A rough conductor. The base is what bounces more than once among the microfacets (Kulla and
/// Conty 2017, "Revisiting physically based shading at Imageworks").
class Conductor final : public Glossy {
 public:
  explicit Conductor(float roughness);

 private:
  Vec3f reflectance(float cos_half, const Vec3f& color) const override;
  Vec3f base_color(const Vec3f& color) const override;
};

/// A matte base of the surface's color under a clear coat of index 1.5.
class Coated final : public Glossy {
 public:
  /// `outer_ior`: of what it lies in, 1 in air.
  Coated(float roughness, float outer_ior);

 private:
  Vec3f reflectance(float cos_half, const Vec3f& color) const override;
  Vec3f base_color(const Vec3f& color) const override { return color; }

  float eta_;
};

}  // namespace dreampm::trace

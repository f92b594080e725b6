// Light at rough surfaces: metal, and a matte base under a clear coat (plastic, varnished wood).
// Microfacets after Trowbridge and Reitz (GGX) with the height-correlated masking of Smith (Heitz
// 2014, "Understanding the masking-shadowing function"). Neither absorbs more than its color says:
// a white one in a white furnace is invisible.
#pragma once
#include <array>
#include <vector>

#include "dreampm/render/intersect.h"

namespace dreampm::trace {

/// Directions point away from the surface, in a frame whose z is its normal.
class RoughSurface {
 public:
  /// Of wood, metal or plastic. `outer_ior`: of what it lies in, 1 in air.
  RoughSurface(const Look& look, float outer_ior);

  /// A lobe: what its samples are worth, and the share of light that it sends back in all.
  struct Sample {
    Vec3f light;   ///< where light comes from; unused where weight is 0
    Vec3f weight;  ///< scattering times cosine over density
  };
  /// Reflection at microfacets. `a`, `b` uniform in [0, 1).
  Sample sample_gloss(const Vec3f& view, const Vec3f& color, float a, float b) const;
  /// The matte base; only where `has_base`. With the density cos/pi.
  Vec3f base_weight(const Vec3f& view, const Vec3f& light, const Vec3f& color) const;
  bool has_base() const { return has_base_; }
  /// The share of light from everywhere that the gloss sends to `view`.
  float gloss_share(float cos_view) const;
  /// Scattering times the cosine of the light [1/sr]; without the gloss where that is a mirror.
  Vec3f scattered(const Vec3f& view, const Vec3f& light, const Vec3f& color) const;
  /// Is the gloss so narrow that it shows the sun's disc?
  bool mirror() const { return mirror_; }

 private:
  Vec3f reflectance(float cos_half, const Vec3f& color) const;
  Vec3f gain(float cos_view, const Vec3f& color) const;

  static constexpr int entries = 48;
  bool has_base_, mirror_;
  float alpha_, eta_;
  std::array<float, entries> share_{};  ///< of the gloss, over the root of the view's cosine; of a metal with color 1
  float mean_share_ = 0;                ///< over all directions, weighted by the cosine
};

/// A surface for each rough object, and each medium that it may lie in.
class RoughSurfaces {
 public:
  explicit RoughSurfaces(const Geometry& geometry);
  const RoughSurface& at(int object, int medium) const;

 private:
  int media_;
  std::vector<RoughSurface> surfaces_;
  std::vector<int> index_;  ///< by object and medium
};

}  // namespace dreampm::trace

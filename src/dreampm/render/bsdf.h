// How a surface scatters light. A surface is a sum of lobes, each of which can be sampled alone, so
// that a path may follow them all or one of them.
#pragma once
#include "dreampm/math/vec.h"

namespace dreampm::trace {

/// Directions have unit length and point away from the surface, in a frame whose z is its normal;
/// views have z > 0. A color is the linear reflectance at the point, 0 to 1. Lobes count from 0,
/// the narrowest first.
class Bsdf {
 public:
  struct Sample {
    Vec3f light;   ///< where light comes from; unused where weight is 0
    Vec3f weight;  ///< scattering times cosine over density; 0: the light is lost
  };
  virtual ~Bsdf() = default;
  virtual int lobes() const = 0;
  /// Is the lobe so narrow that it shows the discs of lights? Such lobes have no `eval` and no
  /// `pdf`: both are 0.
  virtual bool mirror(int) const { return false; }
  /// Does the lobe send light from all over the hemisphere, so that lights alone say where to look?
  virtual bool wide(int) const { return false; }
  /// The share of light from everywhere that the lobe sends to the view, of a color of 1.
  virtual float share(int lobe, float cos_view) const = 0;
  /// Scattering times the cosine of the light [1/sr].
  virtual Vec3f eval(int lobe, const Vec3f& view, const Vec3f& light, const Vec3f& color) const = 0;
  /// The density of `sample` [1/sr].
  virtual float pdf(int lobe, const Vec3f& view, const Vec3f& light) const = 0;
  /// `a`, `b` uniform in [0, 1).
  virtual Sample sample(int lobe, const Vec3f& view, const Vec3f& color, float a, float b) const = 0;

  /// The sum over the lobes.
  Vec3f eval(const Vec3f& view, const Vec3f& light, const Vec3f& color) const {
    Vec3f sum;
    for (int lobe = 0; lobe < lobes(); ++lobe) sum += eval(lobe, view, light, color);
    return sum;
  }
};

/// A perfectly matte surface (Lambert).
class Matte final : public Bsdf {
 public:
  int lobes() const override { return 1; }
  bool wide(int) const override { return true; }
  float share(int, float) const override { return 1; }
  using Bsdf::eval;
  Vec3f eval(int, const Vec3f&, const Vec3f& light, const Vec3f& color) const override;
  float pdf(int, const Vec3f&, const Vec3f& light) const override;
  Sample sample(int, const Vec3f&, const Vec3f& color, float a, float b) const override;
};

}  // namespace dreampm::trace

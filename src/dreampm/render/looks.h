// A look of the model as the tracer uses it. A kind of look is a class in a file of its own, and a
// row of DM_LOOKS.
#pragma once
#include <memory>
#include <vector>

#include "dreampm/render/bsdf.h"
#include "dreampm/render/render.h"

namespace dreampm::trace {

/// What light meets within clear or cloudy matter.
struct Interior {
  float ior = 1;
  Vec3f absorption, scattering;  ///< 1/m for red, green, blue; >= 0
  float anisotropy = 0;          ///< mean cosine of scattering (Henyey and Greenstein 1941)
  Vec3f glow;                    ///< radiance of a thick layer: a look, left out if physical
  Vec3f extinction;              ///< 1/m, the sum of the two
  bool scatters = false;
};

/// Light scattered inside a thick layer of that absorption [1/m], which is only look.
Vec3f glow_of(const Vec3f& absorption);

/// A point of a surface.
struct SurfacePoint {
  Vec3f position;             ///< m
  Vec3f color;                ///< that of the object there, linear
  const TextureFrame& frame;  ///< of the object
  float footprint;            ///< m: the size of what is averaged
};

class Look {
 public:
  explicit Look(const model::Look& model) : model_(model) {}
  virtual ~Look() = default;
  Look(const Look&) = delete;
  Look& operator=(const Look&) = delete;
  /// What it is of; absent where light does not go in. One with an interior has a smooth surface,
  /// others have a bsdf.
  virtual const Interior* interior() const { return nullptr; }
  /// How the surface scatters, whatever its color, in a medium of that index.
  virtual std::unique_ptr<const Bsdf> bsdf(float outer_ior) const = 0;
  /// Linear; of the whole object.
  virtual Vec3f color() const;
  /// The same at a point, for looks with a pattern.
  virtual Vec3f color_at(const SurfacePoint& point) const { return point.color; }
  const model::Look& model() const { return model_; }

 private:
  model::Look model_;
};

/// The kinds of looks, in the order of model::LookType. For a row NAME a file of this folder
/// defines make_NAME.
#define DM_LOOKS(LOOK) LOOK(dielectric) LOOK(opaque) LOOK(spheres) LOOK(wood) LOOK(metal) LOOK(plastic)
#define DM_DECLARE_LOOK(name) std::unique_ptr<const Look> make_##name(const model::Look& look);
DM_LOOKS(DM_DECLARE_LOOK)
#undef DM_DECLARE_LOOK

/// As the look's type says.
std::unique_ptr<const Look> traced(const model::Look& look);

}  // namespace dreampm::trace

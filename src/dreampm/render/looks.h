// A look of the model as the tracer uses it: linear, in floats, a type a kind.
#pragma once
#include <variant>

#include "dreampm/math/vec.h"
#include "dreampm/model/render.h"

namespace dreampm::trace {

/// A smooth interface around a clear medium that absorbs by Beer-Lambert: water, honey, glass.
struct Dielectric {
  float ior = 1.333f;                  ///< 1.01 to 3
  Vec3f absorption{6.0f, 1.7f, 0.5f};  ///< 1/m for red, green, blue; >= 0
  Vec3f glow{0.03f, 0.22f, 0.34f};     ///< radiance scattered inside a thick layer: a look, left out if physical
};
/// A matte surface, under a clear coat where roughness < 1.
struct Opaque {
  Vec3f color{0.8f, 0.8f, 0.8f};  ///< linear reflectance, 0 to 1
  float roughness = 1;            ///< of the coat, 0 (polished) to 1 (no coat)
};
/// Wood under a satin varnish: rings about a pith, and fibers along it, in the frame of its object.
struct Wood {
  Vec3f color{0.51f, 0.25f, 0.09f};  ///< linear reflectance of the early wood, 0 to 1; late wood is darker
  float roughness = 0.45f;           ///< of the varnish, 0 to 1
  float ring = 0;                    ///< m from ring to ring; 0: by the size of the object
};
/// A rough conductor.
struct Metal {
  Vec3f color{0.56f, 0.57f, 0.58f};  ///< linear reflectance square to the surface, 0 to 1
  float roughness = 0.3f;            ///< 0 (a mirror) to 1
};
/// A matte base under a clear, rough coat.
struct Plastic {
  Vec3f color{0.34f, 0.01f, 0.01f};  ///< linear reflectance of the base, 0 to 1
  float roughness = 0.2f;            ///< of the coat, 0 (polished) to 1
};
using Look = std::variant<Dielectric, Opaque, Wood, Metal, Plastic>;

/// As the look's type says; spheres are opaque, without a coat. A dielectric glows as its
/// absorption asks; a clear one does not.
Look traced(const model::Look& look);

}  // namespace dreampm::trace

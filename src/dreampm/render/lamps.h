// Lamps: glowing balls beside the scene.
#pragma once
#include <vector>

#include "dreampm/render/sampler.h"

namespace dreampm::trace {

/// A way from a point to a light.
struct LightSample {
  Vec3f direction{};      ///< towards it, of unit length
  float distance = 1e9f;  ///< m
  Vec3f irradiance{};     ///< square to it, if nothing is in the way
};

struct Lamp {
  Vec3f center;  ///< m
  float radius;  ///< m
  Vec3f radiance;
};

class Lamps {
 public:
  explicit Lamps(std::vector<Lamp> lamps = {}) : lamps_(std::move(lamps)) {}
  bool empty() const { return lamps_.empty(); }
  const std::vector<Lamp>& all() const { return lamps_; }
  /// The radiance of the one that a ray meets within `reach` [m], or null.
  const Vec3f* met(const Vec3f& o, const Vec3f& d, float reach) const;
  /// A point on one of them, the nearer and brighter the more often, evenly over its disc as seen
  /// from p. Two numbers.
  LightSample draw(const Vec3f& p, Sampler& random) const;

 private:
  std::vector<Lamp> lamps_;
};

}  // namespace dreampm::trace

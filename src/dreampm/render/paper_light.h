// The light on a studio's paper. It is white and all around, so that most paths end there: with
// its light found beforehand they do so without noise.
#pragma once
#include <array>
#include <cstdint>
#include <functional>

#include "dreampm/render/backdrop.h"
#include "dreampm/render/light_grid.h"
#include "dreampm/render/sampler.h"

namespace dreampm::trace {

/// Irradiance of the sheet: as it would be with nothing on it, on coarse cells, and what the things
/// on it change near them, on fine ones.
class PaperLight {
 public:
  /// Starts dark.
  explicit PaperLight(const Backdrop& paper);
  /// A sample of the irradiance at a point of the sheet that faces along the normal. It may ask
  /// this object's irradiance, which changes only at the end of a call.
  using Arriving = std::function<Vec3f(const Vec3f& point, const Vec3f& normal, Sampler&)>;
  /// The light of the empty sheet, of `rays` samples a cell; again for each bounce within it.
  void bake_open(const Arriving& arriving, int rays, std::uint64_t seed);
  /// What lies over a point of the floor.
  enum class Over : std::uint8_t { nothing, clear, opaque };
  using Lies = std::function<Over(const Vec3f& point)>;
  /// How far `arriving` and `open` differ on the floor below `box` and round it, by the same
  /// samples of both. The floor under air and under clear matter are kept apart, for paths count
  /// radiance by the medium: light does not smear across the edge of a pool.
  void bake_near(const Box3f& box, const Arriving& arriving, const Arriving& open, const Lies& lies, int rays,
                 std::uint64_t seed);
  /// At a point of the sheet, seen through air or clear matter.
  Vec3f irradiance(const Vec3f& p, bool in_air = true) const;

 private:
  struct Layer {
    LightGrid light, weight;  ///< sums of samples, and their number in every channel
  };
  Vec3f near_at(const Vec3f& p, bool in_air) const;
  Backdrop paper_;
  float front_;  ///< m, along the sheet: where the coarse cells begin
  LightGrid open_;
  std::array<Layer, 2> near_;  ///< under air, under clear matter
  float x0_ = 0, z0_ = 0;      ///< m: where the fine cells begin
};

}  // namespace dreampm::trace

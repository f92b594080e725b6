// Light from all around, as a picture of longitude and latitude that can be sampled by its
// brightness.
#pragma once
#include <algorithm>
#include <cstddef>
#include <optional>
#include <vector>

#include "dreampm/math/vec.h"

namespace dreampm::trace {

/// Columns go round from -x over -z, +x in the middle, and +z; rows go down from +y. Rows have
/// equal steps of latitude.
class Environment {
 public:
  /// `turn`: rad, by the right hand about +y.
  Environment(int width, int height, std::vector<Vec3f> pixels, float turn = 0);
  /// Radiance from the unit vector d, between the middles of pixels.
  Vec3f radiance(const Vec3f& d) const;

  struct Drawn {
    Vec3f direction, radiance;
    float density = 0;  ///< 1/sr; 0: there is no light
  };
  /// A direction with a density about as the radiance, for a, b uniform in [0, 1) (Pharr, Jakob and
  /// Humphreys 2023, "Physically Based Rendering", 12.5).
  Drawn draw(float a, float b) const;
  /// One of directions that were drawn once, evenly over a and b; much faster.
  const Drawn& drawn_before(float a, float b) const {
    const auto at = [](float x) { return std::min(static_cast<std::size_t>(x * pool_side), pool_side - 1); };
    return pool_[at(a) * pool_side + at(b)];
  }
  /// What of it is brighter than `times` its mean, or nothing where that is little of its light.
  std::optional<Environment> bright_parts(float times) const;
  /// The density of `draw` [1/sr].
  float density(const Vec3f& d) const;
  /// The integral of radiance times cosine over the hemisphere about n, exact over the pixels.
  Vec3f irradiance(const Vec3f& n) const;

 private:
  struct Place {
    float u, v;  ///< in pixels
  };
  Place place_of(const Vec3f& d) const;
  Vec3f direction_at(const Place& place) const;
  std::size_t pixel(int x, int y) const { return static_cast<std::size_t>(y) * width_ + static_cast<std::size_t>(x); }

  std::size_t width_, height_;
  std::vector<Vec3f> pixels_;
  float turn_;
  std::vector<double> solid_angle_;  ///< sr, of a pixel of each row
  std::vector<double> in_row_;       ///< running sums of weights along each row, width + 1 of them
  std::vector<double> rows_;         ///< of whole rows
  static constexpr std::size_t pool_side = 128;
  std::vector<Drawn> pool_;
};

}  // namespace dreampm::trace

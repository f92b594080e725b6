// What foam asks of matter: where it is, how it moves, and how its motion differs nearby.
#pragma once
#include "dreampm/foam/foam.h"

namespace dreampm::foam {

/// The rest volume of a particle, swollen as it is [m^3].
inline float volume_of(const FoamMatter& matter, std::size_t i, float spacing) {
  return spacing * spacing * spacing * (matter.volume_ratio.empty() ? 1.0f : matter.volume_ratio[i]);
}

/// Where matter is and its velocity, on the grid of cells.
class MotionField {
 public:
  MotionField(const FoamMatter& matter, std::span<const Obstacle> obstacles, const FoamRules& rules);
  /// The share of space that matter and obstacles take, about 1 inside, a half at a surface.
  float fill(const Vec3f& p) const;
  /// The same, and where it grows [1/m].
  float fill(const Vec3f& p, Vec3f& gradient) const;
  /// m/s; zero where no matter is near. `share`: of space, by matter alone.
  Vec3f velocity(const Vec3f& p, float& share) const;
  float cell() const { return cell_; }

 private:
  LatticeField<5> field_;  ///< fill, velocity, blocked
  float cell_;
};

/// How far matter goes until the next frame, from where it is at this one.
class WayField {
 public:
  /// `way`: of each particle [m]; `known`: whether the next frame has it.
  WayField(const FoamMatter& matter, std::span<const Vec3f> way, std::span<const std::uint8_t> known,
           const FoamRules& rules);
  /// m; false where no matter is near.
  bool at(const Vec3f& p, Vec3f& way) const;

 private:
  LatticeField<4> field_;
};

/// What comes at an obstacle meets its image, at this times its own speed.
inline constexpr float image_factor = 2;

/// Measures of motion over the scale, at nodes.
class Measures {
 public:
  Measures(const FoamMatter& matter, std::span<const Obstacle> obstacles, const FoamRules& rules);
  struct At {
    float fill = 0;          ///< of matter alone
    float near_surface = 0;  ///< 0 inside of matter, 1 at its surface
    float trapped_air = 0;   ///< m/s: how matter meets and whirls
    float curvature = 0;     ///< 1/m: of the surface, where it is bent outward
    float vorticity = 0;     ///< m/s: times the scale
    Vec3f outward{};         ///< the surface's normal, unit length
  };
  At at(const Vec3f& p) const;

 private:
  /// Channels, of which the last ones follow from the first.
  enum : std::size_t { fill, vx, vy, vz, meeting, taken, gx, gy, gz, whirl, bend, count };
  void average();
  void meet(std::span<const Obstacle> obstacles);
  void differentiate();
  void bend_surfaces();

  LatticeField<count> field_;
  float scale_;
};

}  // namespace dreampm::foam

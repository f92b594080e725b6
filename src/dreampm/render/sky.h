// Sun and sky: what a ray that leaves the scene sees.
#pragma once
#include <optional>
#include <vector>

#include "dreampm/render/environment.h"
#include "dreampm/render/render.h"

namespace dreampm::trace {

/// Reads the light's environment. Throws InputError naming the file where it is missing, damaged,
/// not twice as wide as high, not finite or black.
Environment read_environment(const model::Light& light);

class Sky {
 public:
  /// `physical` gives the disc its true radiance; else it is dimmed to what the tone curve can
  /// show. Throws as read_environment.
  Sky(const model::Light& light, bool physical);
  /// Radiance from direction d (unit length).
  Vec3f radiance(const Vec3f& d, bool with_sun) const;
  /// The sky as a picture, where it has small or bright parts that paths must aim at; else null.
  const Environment* aimed_at() const { return environment_ ? &*environment_ : nullptr; }
  /// Its parts that are so bright that paths must not meet them by chance, or null.
  const Environment* bright_parts() const { return bright_ ? &*bright_ : nullptr; }
  /// Irradiance of open, level ground by the sky alone.
  const Vec3f& open_irradiance() const { return open_; }
  bool has_sun() const { return has_sun_; }
  /// Towards the middle of the sun.
  const Vec3f& sun_direction() const { return sun_; }
  /// On a plane that faces the sun.
  const Vec3f& sun_irradiance() const { return sun_irradiance_; }
  /// A direction towards the disc that casts shadows, for a, b in [0, 1).
  Vec3f sample_sun(float a, float b) const;

 private:
  static constexpr int columns = 1024, rows = 256;
  Vec3f clear(const Vec3f& d) const;
  Vec3f without_sun(const Vec3f& d) const;
  void fill_table();

  SkyKind kind_;
  bool has_sun_;
  Vec3f sun_, sun_irradiance_, disc_radiance_, open_;
  float disc_angle_, disc_cos_, shadow_tan_;
  std::vector<Vec3f> table_;                ///< of a clear sky and at night, above the horizon
  std::optional<Environment> environment_;  ///< in its place
  std::optional<Environment> bright_;       ///< of it
};

}  // namespace dreampm::trace

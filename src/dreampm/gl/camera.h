// The eye of a picture: a pinhole that a hand turns, shifts and brings nearer. Plain arithmetic,
// without OpenGL.
#pragma once
#include <array>
#include <numbers>
#include <optional>

#include "dreampm/math/vec.h"

namespace dreampm::gl {

/// A 4x4 matrix as OpenGL keeps it: m[4 * column + row].
using Mat4f = std::array<float, 16>;

struct Ray {
  Vec3f origin;     ///< m
  Vec3f direction;  ///< unit length
};

/// Where a point appears.
struct Projected {
  float x = 0, y = 0;  ///< pixels from the upper left corner of the picture
  float depth = 0;     ///< m in front of the eye, along the axis of view
};

/// Three unit vectors square to each other: to the right, up, and where the camera looks.
struct ViewAxes {
  Vec3f right, up, forward;
};

/// Looks from `eye` at `target`; +y is up. The default is the view of the unit box that the seed
/// systems are shown in.
struct Camera {
  Vec3f eye{0.5f, 1.0f, 1.95f};                             ///< m
  Vec3f target{0.5f, 0.3f, 0.5f};                           ///< m; not where the eye is
  float view_angle = 55 * std::numbers::pi_v<float> / 180;  ///< rad, from the lower to the upper edge, in (0, pi)

  float distance() const;  ///< m, from eye to target; positive
  ViewAxes axes() const;
  float near_plane() const;  ///< m; matter nearer than this is not drawn
  float far_plane() const;   ///< m

  /// World to eye: x right, y up, and -z forward.
  Mat4f view() const;
  /// Eye to clip space for a picture of width : height = aspect.
  Mat4f projection(float aspect) const;

  /// Turns the eye about the target: `right` about the vertical axis, `up` towards the pole [rad],
  /// which it comes no nearer than one degree.
  void orbit(float right, float up);
  /// Shifts eye and target by this share of the height that is seen at the target's distance.
  void pan(float right, float up);
  /// Multiplies the distance of the eye from the target by `factor` (> 0), within 1 mm and 1 km.
  void zoom(float factor);

  /// Through the place (x, y) of a picture, in pixels from its upper left corner; the middle of the
  /// first pixel is (0.5, 0.5).
  Ray ray(float x, float y, int width, int height) const;
  /// Nothing where p is not in front of the near plane.
  std::optional<Projected> project(const Vec3f& p, int width, int height) const;
  /// How many pixels a length of 1 m across the view takes at 1 m in front of the eye.
  float pixels_per_slope(int height) const;
};

}  // namespace dreampm::gl

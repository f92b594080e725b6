// Where the camera of a scene stands: one answer for pictures, exports and the playground.
#pragma once
#include <algorithm>
#include <cmath>
#include <numbers>

#include "dreampm/math/vec.h"
#include "dreampm/model/render.h"

namespace dreampm {

/// A pinhole in the scene. The axes are of unit length and square to each other.
struct CameraView {
  Vec3d eye;                 ///< m
  Vec3d right, up, forward;  ///< to the right and up in the picture, and where it looks
  double fov = 34;           ///< degrees, from the lower to the upper edge
};

namespace detail {

/// Moves the eye so that the corners of the box fill that share of the picture's width or height,
/// and lie in its middle. The extent on the screen is nearly one over the distance: fixed-point
/// rounds converge.
inline void fit(CameraView& view, const Box3d& box, double fill, double aspect) {
  constexpr int rounds = 40;
  const double tan_half = std::tan(view.fov * std::numbers::pi / 360);
  // Nearer than this a corner would lie behind the eye.
  const double nearest = 0.55 * length(box.size());
  Vec3d aim = box.center();
  double distance = 2 * length(box.size());
  for (int round = 0; round < rounds; ++round) {
    view.eye = aim - view.forward * distance;
    double x0 = 1e9, x1 = -1e9, y0 = 1e9, y1 = -1e9;
    for (int k = 0; k < 8; ++k) {
      const Vec3d corner{(k & 1) != 0 ? box.max.x : box.min.x, (k & 2) != 0 ? box.max.y : box.min.y,
                         (k & 4) != 0 ? box.max.z : box.min.z};
      const Vec3d q = corner - view.eye;
      const double z = dot(q, view.forward) * tan_half, x = dot(q, view.right) / (z * aspect), y = dot(q, view.up) / z;
      x0 = std::min(x0, x), x1 = std::max(x1, x), y0 = std::min(y0, y), y1 = std::max(y1, y);
    }
    const double half_height = distance * tan_half;
    aim += view.right * (0.5 * (x0 + x1) * half_height * aspect) + view.up * (0.5 * (y0 + y1) * half_height);
    const double size = 0.5 * std::max(x1 - x0, y1 - y0);
    distance = std::max(nearest, distance * (0.5 + 0.5 * size / fill));
  }
  view.eye = aim - view.forward * distance;
}

}  // namespace detail

/// `box` [m]: that of the scene, which a camera with fit_basin fits into pictures of width : height
/// = aspect. Where it looks straight up or down, -z is up in the picture.
inline CameraView camera_view(const model::Camera& camera, const Box3d& box, double aspect) {
  CameraView view;
  view.fov = camera.fov;
  if (camera.fit_basin) {
    const double around = camera.azimuth * std::numbers::pi / 180, high = camera.elevation * std::numbers::pi / 180;
    view.forward = -Vec3d{std::cos(high) * std::cos(around), std::sin(high), std::cos(high) * std::sin(around)};
  } else {
    view.eye = camera.from;
    view.forward = normalized(camera.to - camera.from);
  }
  const bool level = std::abs(view.forward.y) < 0.9999;
  view.right = normalized(cross(view.forward, level ? Vec3d{0, 1, 0} : Vec3d{0, 0, -1}));
  view.up = cross(view.right, view.forward);
  if (camera.fit_basin) detail::fit(view, box, camera.fill, aspect);
  return view;
}

}  // namespace dreampm

// A pinhole or a thin lens that looks at the basin.
#pragma once
#include "dreampm/render/render.h"

namespace dreampm::trace {

struct CameraRay {
  Vec3f origin, direction;  ///< m; unit length
};

class Camera {
 public:
  /// Of a width x height frame, as camera_view says.
  Camera(const model::Camera& camera, const Box3f& basin, int width, int height);
  const Vec3f& eye() const { return eye_; }
  /// Through the point (x, y) of the frame in pixels from the upper left, from the middle of the
  /// lens; unit length.
  Vec3f direction(float x, float y) const { return normalized(through(x, y)); }
  /// The same from a point of the lens: (a, b) in [0, 1)^2 is spread over it evenly. The rays of
  /// one (x, y) meet in the plane that is sharp.
  CameraRay ray(float x, float y, float a, float b) const;
  /// Where p appears, in pixels.
  std::pair<float, float> project(const Vec3f& p) const;
  /// How far p lies along the line of sight [m].
  float depth(const Vec3f& p) const { return dot(p - eye_, forward_); }
  /// The angle of a pixel [rad].
  float pixel_angle() const { return 2 * tan_half_ / static_cast<float>(height_); }
  /// m; 0 of a pinhole.
  float lens_radius() const { return lens_radius_; }
  /// m, along the line of sight.
  float focus() const { return focus_; }

 private:
  /// Of length 1 along the line of sight.
  Vec3f through(float x, float y) const;

  int width_, height_;
  float tan_half_;
  Vec3f eye_, forward_, right_, up_;
  float lens_radius_ = 0, focus_ = 1;
};

}  // namespace dreampm::trace

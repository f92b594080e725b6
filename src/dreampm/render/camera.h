// A pinhole that looks at the basin.
#pragma once
#include "dreampm/render/render.h"

namespace dreampm::trace {

class Camera {
 public:
  /// Of a width x height frame, as camera_view says.
  Camera(const model::Camera& camera, const Box3f& basin, int width, int height);
  const Vec3f& eye() const { return eye_; }
  /// Through the point (x, y) of the frame in pixels from the upper left; unit length.
  Vec3f direction(float x, float y) const;
  /// Where p appears, in pixels.
  std::pair<float, float> project(const Vec3f& p) const;
  /// The angle of a pixel [rad].
  float pixel_angle() const { return 2 * tan_half_ / static_cast<float>(height_); }

 private:
  int width_, height_;
  float tan_half_;
  Vec3f eye_, forward_, right_, up_;
};

}  // namespace dreampm::trace

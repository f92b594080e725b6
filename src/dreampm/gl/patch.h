// Which part of a picture a box takes. Plain arithmetic, without OpenGL.
#pragma once
#include "dreampm/gl/camera.h"

namespace dreampm::gl {

/// Pixels from the lower left corner.
struct Patch {
  int x = 0, y = 0, width = 0, height = 0;

  bool empty() const { return width <= 0 || height <= 0; }
};

/// Where a box and what is within `margin` [m] of it can be seen in a picture of width x height
/// pixels; all of it where the eye is near.
Patch seen_patch(const Camera& camera, const Box3f& box, float margin, int width, int height);

/// The same in a picture of half the size, width x height pixels, and `more` pixels on all sides.
Patch half_patch(const Patch& patch, int width, int height, int more = 1);

/// How far in front of the eye the box and what is within `margin` of it reach [m].
float farthest(const Camera& camera, const Box3f& box, float margin);

}  // namespace dreampm::gl

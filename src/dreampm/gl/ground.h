// Floor and background.
#pragma once
#include "dreampm/gl/objects.h"
#include "dreampm/gl/picture.h"
#include "dreampm/gl/sun_map.h"

namespace dreampm::gl {

class Ground {
 public:
  /// Behind all opaque matter, by the depth test.
  void draw(const Picture& picture, const SunMap& sun, const ScreenTriangle& screen);

 private:
  VertexArray none_;
  Program floor_{"floor.vert", "floor.frag"}, background_{"background.vert", "background.frag"};
};

}  // namespace dreampm::gl

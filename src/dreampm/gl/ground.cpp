#include "dreampm/gl/ground.h"

#include <epoxy/gl.h>

namespace dreampm::gl {

void Ground::draw(const Picture& picture, const SunMap& sun, const ScreenTriangle& screen) {
  if (picture.floor.shown) {
    floor_.use();
    floor_.texture("soft_shadow", 0, sun.soft());
    floor_.texture("softer_shadow", 1, sun.softer());
    none_.bind();
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
  }
  glDepthFunc(GL_LEQUAL);  // at the far plane
  glDepthMask(GL_FALSE);
  background_.use();
  screen.draw();
  glDepthMask(GL_TRUE);
  glDepthFunc(GL_LESS);
}

}  // namespace dreampm::gl

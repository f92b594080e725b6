#include "dreampm/gl/light_ball.h"

#include <epoxy/gl.h>

namespace dreampm::gl {

LightBall::LightBall() { texture_.resize(side, side * levels); }

void LightBall::draw(const ScreenTriangle& screen) {
  target_.bind();
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_BLEND);
  program_.use();
  program_.set("side", side);
  program_.set("levels", levels);
  screen.draw();
}

}  // namespace dreampm::gl

#include "dreampm/gl/occlusion.h"

#include <epoxy/gl.h>

namespace dreampm::gl {

void Occlusion::apply(const Framebuffer& framebuffer, float reach, const ScreenTriangle& screen) {
  const int width = (framebuffer.width() + 1) / 2, height = (framebuffer.height() + 1) / 2;
  raw_.resize(width, height);
  smooth_.resize(width, height);
  glDisable(GL_DEPTH_TEST);
  raw_target_.bind();
  find_.use();
  find_.texture("depth", 0, framebuffer.depth());
  find_.set("reach", reach);
  screen.draw();
  smooth_target_.bind();
  blur_.use();
  blur_.texture("source", 0, raw_);
  blur_.texture("depth", 1, framebuffer.depth());
  screen.draw();
  framebuffer.color_only().bind();
  apply_.use();
  apply_.texture("source", 0, smooth_);
  glEnable(GL_BLEND);
  glBlendEquation(GL_FUNC_ADD);
  glBlendFunc(GL_DST_COLOR, GL_ZERO);
  screen.draw();
  glDisable(GL_BLEND);
  framebuffer.target().bind();
  glEnable(GL_DEPTH_TEST);
}

}  // namespace dreampm::gl

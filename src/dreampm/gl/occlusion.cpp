#include "dreampm/gl/occlusion.h"

#include <epoxy/gl.h>

namespace dreampm::gl {

void Occlusion::apply(const Framebuffer& framebuffer, const Patch& patch, float reach, const ScreenTriangle& screen) {
  const int width = (framebuffer.width() + 1) / 2, height = (framebuffer.height() + 1) / 2;
  raw_.resize(width, height);
  smooth_.resize(width, height);
  // Each pass needs a margin of what it reads.
  const Patch found = half_patch(patch, width, height, 4), blurred = half_patch(patch, width, height, 1);
  glDisable(GL_DEPTH_TEST);
  glEnable(GL_SCISSOR_TEST);
  glScissor(found.x, found.y, found.width, found.height);
  raw_target_.bind();
  find_.use();
  find_.texture("depth", 0, framebuffer.depth());
  find_.set("reach", reach);
  screen.draw();
  smooth_target_.bind();
  glScissor(blurred.x, blurred.y, blurred.width, blurred.height);
  blur_.use();
  blur_.set("reach", reach);
  blur_.texture("source", 0, raw_);
  blur_.texture("depth", 1, framebuffer.depth());
  screen.draw();
  framebuffer.color_only().bind();
  glScissor(patch.x, patch.y, patch.width, patch.height);
  apply_.use();
  apply_.texture("source", 0, smooth_);
  glEnable(GL_BLEND);
  glBlendEquation(GL_FUNC_ADD);
  glBlendFunc(GL_DST_COLOR, GL_ZERO);
  screen.draw();
  glDisable(GL_BLEND);
  glDisable(GL_SCISSOR_TEST);
  framebuffer.target().bind();
  glEnable(GL_DEPTH_TEST);
}

}  // namespace dreampm::gl

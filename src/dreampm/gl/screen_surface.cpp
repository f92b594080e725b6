#include "dreampm/gl/screen_surface.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <cmath>

namespace dreampm::gl {

namespace {

/// Spheres are this much wider than the batch says, so that they close into a surface.
constexpr float wider = 1.25f;
/// On each side; the shader's bound.
constexpr float most_taps = 8;

}  // namespace

bool ScreenSurface::find(const FrameContext& frame, const BatchOnDevice& b) {
  const int width = frame.framebuffer->width(), height = frame.framebuffer->height();
  const int half_width = (width + 1) / 2, half_height = (height + 1) / 2;
  const float radius = wider * b.batch->radius;
  far_ = farthest(*frame.camera, b.bounds, 2 * radius);
  if (!(far_ > 0)) return false;
  patch_ = seen_patch(*frame.camera, b.bounds, radius, width, height);
  if (patch_.empty()) return false;
  half_ = half_patch(patch_, half_width, half_height, 2);
  for (Texture* t : {&front_, &filtered_, &normals_, &colors_}) t->resize(half_width, half_height);

  const float middle = dot(b.bounds.center() - frame.camera->eye, frame.camera->axes().forward);
  const float pixels = frame.camera->pixels_per_slope(half_height) * radius / std::max(middle, radius);
  tap_distance_ = std::clamp(static_cast<int>(std::ceil(5 * pixels / most_taps)), 1, 6);
  spread_near_ = std::clamp(static_cast<int>(0.5f * pixels + 0.5f), 1, 4);
  spread_away_ = std::clamp(static_cast<int>(1.2f * pixels + 0.5f), 2, 9);

  glDisable(GL_DEPTH_TEST);
  glEnable(GL_SCISSOR_TEST);
  glScissor(half_.x, half_.y, half_.width, half_.height);
  splat(b, radius);
  filter(front_, filtered_target_, tap_distance_, 0, radius, *frame.screen);
  filter(filtered_, front_target_, 0, tap_distance_, radius, *frame.screen);
  clean(radius, *frame.screen);
  normals_target_.bind();
  normal_.use();
  normal_.texture("field", 0, filtered_);
  normal_.set("far", far_);
  set_corners(normal_);
  frame.screen->draw();
  glScissor(patch_.x, patch_.y, patch_.width, patch_.height);
  return true;
}

void ScreenSurface::set_corners(const Program& program) const {
  program.set_pair("low_corner", half_.x, half_.y);
  program.set_pair("high_corner", half_.x + half_.width - 1, half_.y + half_.height - 1);
}

void ScreenSurface::splat(const BatchOnDevice& b, float r) {
  front_target_.bind();
  glClearColor(0, 0, 0, 0);
  glClear(GL_COLOR_BUFFER_BIT);
  glEnable(GL_BLEND);
  glBlendEquationSeparate(GL_MAX, GL_FUNC_ADD);
  glBlendFunc(GL_ONE, GL_ONE);
  const float spacing = b.batch->spacing > 0 ? b.batch->spacing : b.batch->radius / 0.8f;
  splat_.use();
  splat_.set("far", far_);
  splat_.set("fill", spacing * spacing * spacing / (4.18879f * r * r * r));
  set_particle_uniforms(splat_, *b.batch, wider);
  b.vertices->bind();
  glDrawArrays(GL_POINTS, 0, b.count);
  glDisable(GL_BLEND);
  glBlendEquation(GL_FUNC_ADD);
}

void ScreenSurface::filter(const Texture& from, const Target& to, int x, int y, float radius,
                           const ScreenTriangle& screen) {
  to.bind();
  filter_.use();
  filter_.texture("field", 0, from);
  filter_.set_pair("along", x, y);
  filter_.set_pair("spread", spread_near_, spread_away_);
  filter_.set("far", far_);
  set_corners(filter_);
  filter_.set("first", x > 0 ? 1.0f : 0.0f);
  filter_.set("range", 4 * radius);
  filter_.set("behind", radius);
  filter_.set("reach", 5 * radius);
  screen.draw();
}

void ScreenSurface::clean(float radius, const ScreenTriangle& screen) {
  filtered_target_.bind();
  clean_.use();
  clean_.texture("field", 0, front_);
  // A tent as wide as that takes a period of the distance between taps out.
  clean_.set_pair("wide", std::clamp(tap_distance_ - 1, 1, 3), std::clamp(tap_distance_ - 1, 1, 3));
  clean_.set("range", 6 * radius);
  set_corners(clean_);
  screen.draw();
}

void ScreenSurface::find_colors(const BatchOnDevice& b) {
  glScissor(half_.x, half_.y, half_.width, half_.height);
  colors_target_.bind();
  glClearColor(0, 0, 0, 0);
  glClear(GL_COLOR_BUFFER_BIT);
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ONE);
  color_.use();
  color_.texture("field", 0, filtered_);
  color_.set("far", far_);
  set_particle_uniforms(color_, *b.batch, wider);
  b.vertices->bind();
  glDrawArrays(GL_POINTS, 0, b.count);
  glDisable(GL_BLEND);
  glScissor(patch_.x, patch_.y, patch_.width, patch_.height);
}

}  // namespace dreampm::gl

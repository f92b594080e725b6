#include "dreampm/gl/screen_surface.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <cmath>

namespace dreampm::gl {

namespace {

/// Where a box and what is within `margin` of it can be seen, in pixels of a width x height target;
/// the whole target where the eye is near.
Patch seen_patch(const Camera& camera, const Box3f& box, float margin, int width, int height) {
  float x0 = 1e9f, y0 = 1e9f, x1 = -1e9f, y1 = -1e9f;
  for (int k = 0; k < 8; ++k) {
    const Vec3f corner{(k & 1) ? box.max.x + margin : box.min.x - margin,
                       (k & 2) ? box.max.y + margin : box.min.y - margin,
                       (k & 4) ? box.max.z + margin : box.min.z - margin};
    const auto p = camera.project(corner, width, height);
    if (!p) return {0, 0, width, height};
    x0 = std::min(x0, p->x), x1 = std::max(x1, p->x);
    y0 = std::min(y0, p->y), y1 = std::max(y1, p->y);
  }
  const auto clamped = [](float v, int most) {
    return static_cast<int>(std::clamp(v, 0.0f, static_cast<float>(most)));
  };
  const int left = clamped(x0 - 2, width), right = clamped(x1 + 2, width);
  const int top = clamped(y0 - 2, height), bottom = clamped(y1 + 2, height);
  return {left, height - bottom, right - left, bottom - top};
}

/// How far behind the eye's plane the box and a margin reach.
float farthest(const Camera& camera, const Box3f& box, float margin) {
  const Vec3f f = camera.axes().forward, c = box.center() - camera.eye, h = box.size() * 0.5f;
  return dot(c, f) + h.x * std::abs(f.x) + h.y * std::abs(f.y) + h.z * std::abs(f.z) + margin;
}

/// Spheres are this much wider than the batch says, so that they close into a surface.
constexpr float wider = 1.25f;

}  // namespace

bool ScreenSurface::find(const FrameContext& frame, const BatchOnDevice& b) {
  const int width = frame.framebuffer->width(), height = frame.framebuffer->height();
  const int half_width = (width + 1) / 2, half_height = (height + 1) / 2;
  const float radius = wider * b.batch->radius;
  far_ = farthest(*frame.camera, b.bounds, 2 * radius);
  if (!(far_ > 0)) return false;
  patch_ = seen_patch(*frame.camera, b.bounds, radius, width, height);
  if (patch_.width == 0 || patch_.height == 0) return false;
  half_ = {patch_.x / 2, patch_.y / 2, std::min(patch_.width / 2 + 2, half_width - patch_.x / 2),
           std::min(patch_.height / 2 + 2, half_height - patch_.y / 2)};
  for (Texture* t : {&front_, &filtered_, &normals_}) t->resize(half_width, half_height);

  glDisable(GL_DEPTH_TEST);
  glEnable(GL_SCISSOR_TEST);
  glScissor(half_.x, half_.y, half_.width, half_.height);
  splat(b, radius);
  filter(front_, filtered_target_, 1, 0, radius, *frame.screen);
  filter(filtered_, front_target_, 0, 1, radius, *frame.screen);
  normals_target_.bind();
  normal_.use();
  normal_.texture("field", 0, front_);
  normal_.set("far", far_);
  frame.screen->draw();
  glScissor(patch_.x, patch_.y, patch_.width, patch_.height);
  return true;
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
  filter_.set("far", far_);
  filter_.set("first", x > 0 ? 1.0f : 0.0f);
  filter_.set("range", 4 * radius);
  filter_.set("behind", radius);
  filter_.set("reach", 5 * radius);
  screen.draw();
}

void ScreenSurface::find_colors(const BatchOnDevice& b) {
  colors_.resize(front_.width(), front_.height());
  glScissor(half_.x, half_.y, half_.width, half_.height);
  colors_target_.bind();
  glClearColor(0, 0, 0, 0);
  glClear(GL_COLOR_BUFFER_BIT);
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ONE);
  color_.use();
  color_.texture("field", 0, front_);
  color_.set("far", far_);
  set_particle_uniforms(color_, *b.batch, wider);
  b.vertices->bind();
  glDrawArrays(GL_POINTS, 0, b.count);
  glDisable(GL_BLEND);
  glScissor(patch_.x, patch_.y, patch_.width, patch_.height);
}

}  // namespace dreampm::gl

#include "dreampm/gl/water.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <cmath>

namespace dreampm::gl {

namespace {

/// Pixels from the lower left corner.
struct Patch {
  int x = 0, y = 0, width = 0, height = 0;
};

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

/// Spheres of a liquid are this much wider than the batch says, so that they close into a surface.
constexpr float wider = 1.25f;

class Water final : public Look {
 public:
  std::string_view name() const override { return "water"; }
  bool see_through() const override { return true; }

  void draw(const FrameContext& frame, std::span<const BatchOnDevice> batches) override {
    // The farthest first: one liquid after the other is laid over what is there.
    for (const BatchOnDevice& b : batches) draw(frame, b);
  }

 private:
  void draw(const FrameContext& frame, const BatchOnDevice& b) {
    const Framebuffer& fb = *frame.framebuffer;
    const int width = fb.width(), height = fb.height();
    const int half_width = (width + 1) / 2, half_height = (height + 1) / 2;
    const float radius = wider * b.batch->radius;
    const float far = farthest(*frame.camera, b.bounds, 2 * radius);
    if (!(far > 0)) return;
    const Patch patch = seen_patch(*frame.camera, b.bounds, radius, width, height);
    if (patch.width == 0 || patch.height == 0) return;
    const Patch half{patch.x / 2, patch.y / 2, std::min(patch.width / 2 + 2, half_width - patch.x / 2),
                     std::min(patch.height / 2 + 2, half_height - patch.y / 2)};
    for (Texture* t : {&front_, &filtered_, &surface_}) t->resize(half_width, half_height);
    behind_.resize(width, height);

    glEnable(GL_SCISSOR_TEST);
    glScissor(half.x, half.y, half.width, half.height);
    glDisable(GL_DEPTH_TEST);
    splat(frame, b, far, radius);
    filter(front_, filtered_target_, 1, 0, far, radius, *frame.screen);
    filter(filtered_, front_target_, 0, 1, far, radius, *frame.screen);
    surface_target_.bind();
    normal_.use();
    normal_.texture("field", 0, front_);
    normal_.set("far", far);
    frame.screen->draw();

    glScissor(patch.x, patch.y, patch.width, patch.height);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, fb.color_only().name());
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, behind_target_.name());
    glDisable(GL_SCISSOR_TEST);
    glBlitFramebuffer(0, 0, width, height, 0, 0, width, height, GL_COLOR_BUFFER_BIT, GL_NEAREST);
    glEnable(GL_SCISSOR_TEST);
    compose(frame, *b.batch, far);
    glDisable(GL_SCISSOR_TEST);
    glEnable(GL_DEPTH_TEST);
  }

  void splat(const FrameContext& frame, const BatchOnDevice& b, float far, float r) {
    front_target_.bind();
    glClearColor(0, 0, 0, 0);
    glClear(GL_COLOR_BUFFER_BIT);
    glEnable(GL_BLEND);
    glBlendEquationSeparate(GL_MAX, GL_FUNC_ADD);
    glBlendFunc(GL_ONE, GL_ONE);
    const float spacing = b.batch->spacing > 0 ? b.batch->spacing : b.batch->radius / 0.8f;
    const Program& program = frame.opaque_matter ? splat_before_opaque_ : splat_;
    program.use();
    if (frame.opaque_matter) program.texture("depth", 0, frame.framebuffer->depth());
    program.set("far", far);
    program.set("fill", spacing * spacing * spacing / (4.18879f * r * r * r));
    set_particle_uniforms(program, *b.batch, wider);
    b.vertices->bind();
    glDrawArrays(GL_POINTS, 0, b.count);
    glDisable(GL_BLEND);
    glBlendEquation(GL_FUNC_ADD);
  }

  void filter(const Texture& from, const Target& to, int x, int y, float far, float radius,
              const ScreenTriangle& screen) {
    to.bind();
    filter_.use();
    filter_.texture("field", 0, from);
    filter_.set_pair("along", x, y);
    filter_.set("far", far);
    filter_.set("first", x > 0 ? 1.0f : 0.0f);
    filter_.set("range", 5 * radius);
    filter_.set("behind", radius);
    filter_.set("reach", 5 * radius);
    screen.draw();
  }

  void compose(const FrameContext& frame, const ParticleBatch& batch, float far) {
    frame.framebuffer->color_only().bind();
    glEnable(GL_BLEND);
    glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    const Liquid& liquid = batch.liquid;
    compose_.use();
    compose_.texture("surface", 0, surface_);
    compose_.texture("field", 1, front_);
    compose_.texture("behind", 2, behind_);
    compose_.texture("depth", 3, frame.framebuffer->depth());
    compose_.set("far", far);
    compose_.set("absorption", liquid.absorption);
    compose_.set("tint", liquid.tint);
    compose_.set("cloudiness", liquid.cloudiness);
    compose_.set("refractive_index", std::clamp(liquid.refractive_index, 1.0f, 3.0f));
    frame.screen->draw();
    glDisable(GL_BLEND);
  }

  Texture front_{Texel::rgba32f, Texture::Filter::linear}, filtered_{Texel::rgba32f, Texture::Filter::linear};
  Texture surface_{Texel::rgba16f, Texture::Filter::linear}, behind_{Texel::rgba8, Texture::Filter::linear};
  Target front_target_{&front_}, filtered_target_{&filtered_}, surface_target_{&surface_}, behind_target_{&behind_};
  Program splat_{"water_splat.vert", "water_splat.frag"},
      splat_before_opaque_{"water_splat_opaque.vert", "water_splat_opaque.frag"}, filter_{"screen.vert", "water_filter.frag"},
      normal_{"screen.vert", "water_normal.frag"}, compose_{"water.vert", "water.frag"};
};

}  // namespace

std::unique_ptr<Look> make_water() { return std::make_unique<Water>(); }

}  // namespace dreampm::gl

#include "dreampm/gl/surface_looks.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <utility>

#include "dreampm/gl/screen_surface.h"

namespace dreampm::gl {

namespace {

/// As Look::draw promises.
void leave(const FrameContext& frame) {
  glDisable(GL_BLEND);
  glDisable(GL_SCISSOR_TEST);
  glEnable(GL_DEPTH_TEST);
  frame.framebuffer->target().bind();
}

class Water final : public Look {
 public:
  std::string_view name() const override { return "water"; }
  Stage stage() const override { return Stage::liquid; }

  /// Lines would be bent into loops, which look like cracks.
  void keep_behind(const FrameContext& frame) override {
    copy(*frame.framebuffer);
    is_kept_ = true;
    leave(frame);
  }

  void draw(const FrameContext& frame, std::span<const BatchOnDevice> batches) override {
    for (const BatchOnDevice& b : batches) {
      if (surface_.find(frame, b)) {
        if (!std::exchange(is_kept_, false)) copy(*frame.framebuffer);
        compose(frame, *b.batch);
      }
      leave(frame);
    }
    is_kept_ = false;
  }

 private:
  /// What is drawn so far, to refract.
  void copy(const Framebuffer& fb) {
    behind_.resize(fb.width(), fb.height());
    glBindFramebuffer(GL_READ_FRAMEBUFFER, fb.color_only().name());
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, behind_target_.name());
    glDisable(GL_SCISSOR_TEST);  // a ray may leave the patch
    glBlitFramebuffer(0, 0, fb.width(), fb.height(), 0, 0, fb.width(), fb.height(), GL_COLOR_BUFFER_BIT, GL_NEAREST);
    glEnable(GL_SCISSOR_TEST);
  }

  void compose(const FrameContext& frame, const ParticleBatch& batch) {
    frame.framebuffer->color_only().bind();
    glEnable(GL_BLEND);
    glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    const Liquid& liquid = batch.liquid;
    compose_.use();
    compose_.texture("surface", 0, surface_.normals());
    compose_.texture("field", 1, surface_.field());
    compose_.texture("behind", 2, behind_);
    compose_.texture("depth", 3, frame.framebuffer->depth());
    compose_.set("far", surface_.far());
    compose_.set("softness", 0.5f * batch.radius);
    compose_.set("absorption", liquid.absorption);
    compose_.set("tint", liquid.tint);
    compose_.set("cloudiness", liquid.cloudiness);
    compose_.set("refractive_index", std::clamp(liquid.refractive_index, 1.0f, 3.0f));
    frame.screen->draw();
  }

  ScreenSurface surface_;
  Texture behind_{Texel::rgba8, Texture::Filter::linear};
  Target behind_target_{&behind_};
  bool is_kept_ = false;  ///< whether behind_ is of this frame
  Program compose_{"water.vert", "water.frag"};
};

/// Opaque matter without grains: jelly, stone, clay.
class Skin final : public Look {
 public:
  std::string_view name() const override { return "skin"; }
  Stage stage() const override { return Stage::blended; }
  bool wants_occlusion() const override { return true; }

  void draw(const FrameContext& frame, std::span<const BatchOnDevice> batches) override {
    for (const BatchOnDevice& b : batches) {
      if (surface_.find(frame, b)) {
        if (colored(*b.batch)) surface_.find_colors(b);
        compose(frame, *b.batch);
      }
      leave(frame);
    }
  }

 private:
  static bool colored(const ParticleBatch& batch) { return !batch.color.empty() || !batch.value.empty(); }

  void compose(const FrameContext& frame, const ParticleBatch& batch) {
    frame.framebuffer->target().bind();
    glEnable(GL_DEPTH_TEST);
    glEnable(GL_BLEND);
    glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    compose_.use();
    compose_.texture("surface", 0, surface_.normals());
    compose_.texture("field", 1, surface_.field());
    compose_.texture("colors", 2, surface_.colors());
    compose_.texture("sun_depth", 3, *frame.sun_map);
    compose_.texture("sun_darkness", 4, *frame.sun_darkness);
    compose_.set("far", surface_.far());
    compose_.set("softness", 4.0f * batch.radius);
    compose_.set("base_color", batch.base_color);
    compose_.set("opacity", batch.opacity);
    compose_.set("colored", colored(batch) ? 1.0f : 0.0f);
    frame.screen->draw();
  }

  ScreenSurface surface_;
  Program compose_{"screen.vert", "skin.frag"};
};

}  // namespace

std::unique_ptr<Look> make_water() { return std::make_unique<Water>(); }
std::unique_ptr<Look> make_skin() { return std::make_unique<Skin>(); }

}  // namespace dreampm::gl

#include <epoxy/gl.h>

#include "dreampm/gl/look.h"
#include "dreampm/gl/surface_looks.h"

namespace dreampm::gl {

namespace {

/// Draws the particles of a batch by the program in use; of one that lets light through only the
/// nearest: their depth first.
void draw_points(const BatchOnDevice& b, bool ordered) {
  const auto draw = [&] {
    if (ordered)
      glDrawElements(GL_POINTS, b.ordered_count, GL_UNSIGNED_INT, nullptr);
    else
      glDrawArrays(GL_POINTS, 0, b.count);
  };
  b.vertices->bind();
  if (b.batch->opacity >= 1) return draw();
  glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  draw();
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glDepthFunc(GL_LEQUAL);
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  draw();
  glDisable(GL_BLEND);
  glDepthFunc(GL_LESS);
}

/// A dot of two to four pixels for each particle, without light: quick, and nothing is hidden.
class Points final : public Look {
 public:
  std::string_view name() const override { return "points"; }
  void draw(const FrameContext&, std::span<const BatchOnDevice> batches) override {
    program_.use();
    for (const BatchOnDevice& b : batches) {
      set_particle_uniforms(program_, *b.batch, 0.6f);
      draw_points(b, false);
    }
  }

 private:
  Program program_{"points.vert", "points.frag"};
};

/// What makes one kind of balls differ from another.
struct BallStyle {
  std::string_view name;
  std::string_view vertex, fragment;  ///< spheres or grains
  float radius;                       ///< times the batch's
  float grain;                        ///< spread of brightness and size
  float gloss;
  bool occlusion;
};

/// A lit sphere for each particle.
class Spheres final : public Look {
 public:
  explicit Spheres(const BallStyle& style) : style_(style), program_(style.vertex, style.fragment) {}
  std::string_view name() const override { return style_.name; }
  bool wants_order() const override { return true; }
  bool wants_occlusion() const override { return style_.occlusion; }
  void draw(const FrameContext& frame, std::span<const BatchOnDevice> batches) override {
    program_.use();
    program_.texture("sun_depth", 0, *frame.sun_map);
    program_.texture("sun_darkness", 2, *frame.sun_darkness);
    program_.texture("light_ball", 1, *frame.light_ball);
    program_.set("grain", style_.grain);
    program_.set("gloss", style_.gloss);
    for (const BatchOnDevice& b : batches) {
      set_particle_uniforms(program_, *b.batch, style_.radius);
      draw_points(b, true);
    }
  }

 private:
  BallStyle style_;
  Program program_;
};

/// Balls of foam, white or as they are colored: each hides the share of its disc that the alpha of
/// its color is, also where it is smaller than a pixel. `value` is the radius of each [m];
/// without it they have that of the batch.
class FoamBalls final : public Look {
 public:
  FoamBalls(std::string_view name, Stage stage) : name_(name), stage_(stage) {}
  std::string_view name() const override { return name_; }
  Stage stage() const override { return stage_; }
  void draw(const FrameContext&, std::span<const BatchOnDevice> batches) override {
    program_.use();
    glDepthMask(GL_FALSE);
    glEnable(GL_BLEND);
    glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    for (const BatchOnDevice& b : batches) {
      set_particle_uniforms(program_, *b.batch, b.batch->value.empty() ? 1.0f : 0.0f);
      b.vertices->bind();
      glDrawArrays(GL_POINTS, 0, b.count);
    }
    glDisable(GL_BLEND);
    glDepthMask(GL_TRUE);
  }

 private:
  std::string_view name_;
  Stage stage_;
  Program program_{"foam.vert", "foam.frag"};
};

}  // namespace

std::vector<std::unique_ptr<Look>> make_looks() {
  std::vector<std::unique_ptr<Look>> looks;
  looks.push_back(std::make_unique<Points>());
  looks.push_back(
      std::make_unique<Spheres>(BallStyle{"spheres", "spheres.vert", "spheres.frag", 1.0f, 0.0f, 0.2f, false}));
  looks.push_back(
      std::make_unique<Spheres>(BallStyle{"grains", "spheres.vert", "grains.frag", 1.05f, 0.18f, 0.0f, true}));
  looks.push_back(make_skin());
  looks.push_back(make_water());
  looks.push_back(std::make_unique<FoamBalls>("bubbles", Stage::blended));
  looks.push_back(std::make_unique<FoamBalls>("foam", Stage::over));
  return looks;
}

}  // namespace dreampm::gl

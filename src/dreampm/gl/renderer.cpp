#include "dreampm/gl/renderer.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "dreampm/base/error.h"
#include "dreampm/gl/ground.h"
#include "dreampm/gl/headless.h"
#include "dreampm/gl/light_ball.h"
#include "dreampm/gl/line_pass.h"
#include "dreampm/gl/look.h"
#include "dreampm/gl/mesh_pass.h"
#include "dreampm/gl/occlusion.h"
#include "dreampm/gl/particle_store.h"
#include "dreampm/gl/sun_map.h"

namespace dreampm::gl {

namespace {

struct Vec4f {
  float x = 0, y = 0, z = 0, w = 0;
};
Vec4f with(const Vec3f& v, float w = 0) { return {v.x, v.y, v.z, w}; }
/// To linear light, as frame.glsl does.
Vec4f decoded(const Vec3f& c) { return with(c * c); }

/// The uniform block of frame.glsl, member by member.
struct FrameBlock {
  Mat4f view, projection;
  Vec4f eye, viewport, lens;
  Vec4f light_position[2], light_color[2];
  Vec4f ambient_middle, ambient_slope;
  Vec4f eye_up, eye_key, eye_fill;
  Vec4f sun, sun_map, sun_height;
  Vec4f background_low, background_high, sky_low, sky_high;
  Vec4f floor_bright, floor_dark, floor_grout, floor_shape;
};
static_assert(sizeof(FrameBlock) == (2 * 16 + 23 * 4) * sizeof(float), "std140 has no gaps here");

constexpr float shadow_darkness = 0.72f;

FrameBlock frame_block(const Picture& picture, const Camera& camera, const SunFrame& sun, int width, int height) {
  const float w = static_cast<float>(width), h = static_cast<float>(height);
  const Theme& theme = picture.theme;
  FrameBlock b;
  b.view = camera.view();
  b.projection = camera.projection(w / h);
  b.eye = with(camera.eye);
  b.viewport = {w, h, 1 / w, 1 / h};
  b.lens = {camera.pixels_per_slope(height), camera.near_plane(), camera.far_plane(), w / h};
  for (std::size_t k = 0; k < 2; ++k) {
    b.light_position[k] = with(picture.lights[k].position);
    b.light_color[k] = decoded(picture.lights[k].color);
  }
  const Vec3f low = theme.ambient_low * theme.ambient_low, high = theme.ambient_high * theme.ambient_high;
  b.ambient_middle = with((high + low) * 0.5f);
  b.ambient_slope = with((high - low) * 0.5f);
  const ViewAxes axes = camera.axes();
  const auto in_eye = [&](const Vec3f& v) {
    return with({dot(v, axes.right), dot(v, axes.up), -dot(v, axes.forward)});
  };
  const Vec3f middle = picture.domain.center();
  b.eye_up = in_eye({0, 1, 0});
  b.eye_key = in_eye(normalized(picture.lights[0].position - middle));
  b.eye_fill = in_eye(normalized(picture.lights[1].position - middle));
  b.sun = with(sun.to_light);
  b.sun_map = {sun.low_x, sun.low_z, 1 / sun.size_x, 1 / sun.size_z};
  b.sun_height = {sun.floor, 1 / sun.height, shadow_darkness, sun.texel};
  b.background_low = decoded(theme.background_low);
  b.background_high = decoded(theme.background_high);
  b.sky_low = decoded(theme.sky_low);
  b.sky_high = decoded(theme.sky_high);
  b.floor_bright = decoded(theme.floor_bright);
  b.floor_dark = decoded(theme.floor_dark);
  b.floor_grout = decoded(theme.floor_grout);
  const Vec3f size = picture.domain.size();
  b.floor_shape = {picture.floor.tile, middle.x, middle.z, 4 * std::max({size.x, size.y, size.z})};
  return b;
}

/// What the passes count on, whatever a window's other drawing has left.
void set_state() {
  glEnable(GL_PROGRAM_POINT_SIZE);
  for (const GLenum off : {GL_CULL_FACE, GL_STENCIL_TEST, GL_SCISSOR_TEST, GL_BLEND, GL_FRAMEBUFFER_SRGB,
                           GL_POLYGON_OFFSET_FILL, GL_PRIMITIVE_RESTART})
    glDisable(off);
  glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glBlendEquation(GL_FUNC_ADD);
  glClearDepth(1);
  glDepthRange(0, 1);
  for (GLuint unit = 0; unit < 8; ++unit) glBindSampler(unit, 0);
}

void check(const Picture& picture, const Camera& camera) {
  if (!is_finite(camera.eye) || !is_finite(camera.target) || !(camera.view_angle > 0 && camera.view_angle < 3.1f))
    fail_input("picture: the camera has no place to look from, or its view angle of {} rad is not within 0 and 3.1",
               camera.view_angle);
  if (picture.domain.empty() || !is_finite(picture.domain.min) || !is_finite(picture.domain.max))
    fail_input("picture: the domain is empty");
  if (!(picture.floor.tile > 0)) fail_input("picture: the floor's tiles are {} m wide", picture.floor.tile);
}

Box3f bounds_of(const MeshOnDevice& mesh) {
  Box3f box;
  for (const Vec3f& v : mesh.batch->vertices) box.add(static_cast<Vec3f>(mesh.batch->pose(static_cast<Vec3d>(v))));
  return box;
}

}  // namespace

struct Renderer::Impl {
  Buffer block;
  FrameBlock last{};  ///< of the frame before
  ParticleStore particles;
  MeshStore meshes;
  ScreenTriangle screen;
  SunMap sun;
  Ground ground;
  MeshPass mesh_pass;
  LinePass lines;
  Occlusion occlusion;
  LightBall light_ball;
  std::vector<std::unique_ptr<Look>> looks = make_looks();
  std::vector<BatchOnDevice> of_look;        ///< kept for its memory
  std::vector<MeshOnDevice> behind, before;  ///< meshes that let light through, on this and that side of liquids

  /// Liquids hide what is drawn before them and farther off, and are hidden by what is nearer:
  /// glass around them, or between them and the eye, comes after them.
  void part_glass(std::span<const MeshOnDevice> all, const Box3f& liquids, const Camera& camera) {
    behind.clear(), before.clear();
    const Vec3f middle = liquids.center(), forward = camera.axes().forward;
    for (const MeshOnDevice& m : all) {
      if (m.batch->opacity >= 1 || m.count == 0) continue;
      const Box3f box = bounds_of(m);
      const bool farther = dot(box.center() - middle, forward) > 0 && !box.contains(middle);
      (farther ? behind : before).push_back(m);
    }
  }

  /// The batches of a look that have particles and are drawn at that stage.
  std::span<const BatchOnDevice> batches_of(const Look& look, Stage stage, std::span<const BatchOnDevice> all) {
    of_look.clear();
    for (const BatchOnDevice& b : all)
      if (b.stage == stage && b.batch->look == look.name() && !b.bounds.empty()) of_look.push_back(b);
    return of_look;
  }
  const Look& look_of(const ParticleBatch& batch) const {
    std::string names;
    for (const auto& look : looks) {
      if (look->name() == batch.look) return *look;
      names += fmt::format("{}{}", names.empty() ? "" : ", ", look->name());
    }
    fail_input("picture: there is no look '{}'; there are: {}", batch.look, names);
  }

  /// A picture that is drawn, on the device.
  struct Work {
    const Picture& picture;
    const Camera& camera;
    const Framebuffer& framebuffer;
    std::span<BatchOnDevice> batches;
    std::span<const MeshOnDevice> meshes;
    FrameContext frame;
    Box3f occluded{};  ///< what ambient occlusion is wanted for
  };
  Work upload(const Picture& picture, const Camera& camera, const Framebuffer& framebuffer);
  void draw_shadows(const Work& work);
  void draw_looks(Work& work, Stage stage);
  void draw_opaque(Work& work);
  void draw_occlusion(const Work& work);
  void draw_liquids(Work& work);
};

Renderer::Impl::Work Renderer::Impl::upload(const Picture& picture, const Camera& camera,
                                            const Framebuffer& framebuffer) {
  const std::span<BatchOnDevice> batches = particles.upload(picture.particles);
  for (std::size_t k = 0; k < batches.size(); ++k) {
    const Look& look = look_of(*batches[k].batch);
    batches[k].stage = look.stage() == Stage::solid && picture.particles[k].opacity < 1 ? Stage::blended : look.stage();
    if (look.wants_order()) particles.order(camera, k);
  }
  const std::span<const MeshOnDevice> on_device = meshes.upload(picture.meshes);
  return {picture, camera,    framebuffer,
          batches, on_device, {&camera, &framebuffer, &sun.depth(), &sun.darkness(), &light_ball.texture(), &screen}};
}

void Renderer::Impl::draw_shadows(const Work& work) {
  const SunFrame from_sun = sun_frame(work.picture, SunMap::texels);
  const FrameBlock now =
      frame_block(work.picture, work.camera, from_sun, work.framebuffer.width(), work.framebuffer.height());
  block.fill(&now, sizeof now);
  glBindBufferBase(GL_UNIFORM_BUFFER, 0, block.name());
  set_state();
  sun.draw(work.batches, work.meshes, screen);
  if (std::memcmp(&now, &last, sizeof now) != 0) light_ball.draw(screen);
  last = now;
}

void Renderer::Impl::draw_looks(Work& work, Stage stage) {
  for (const auto& look : looks) {
    const std::span<const BatchOnDevice> mine = batches_of(*look, stage, work.batches);
    if (mine.empty()) continue;
    look->draw(work.frame, mine);
    if (look->wants_occlusion())
      for (const BatchOnDevice& b : mine) work.occluded.add(b.bounds.min), work.occluded.add(b.bounds.max);
  }
}

void Renderer::Impl::draw_opaque(Work& work) {
  work.framebuffer.target().bind();
  glEnable(GL_DEPTH_TEST);
  glClear(GL_DEPTH_BUFFER_BIT);
  draw_looks(work, Stage::solid);
  mesh_pass.draw(work.meshes, sun, true);
  ground.draw(work.picture, sun, screen);
  draw_looks(work, Stage::blended);
}

void Renderer::Impl::draw_occlusion(const Work& work) {
  if (work.occluded.empty()) return;
  const Vec3f size = work.picture.domain.size();
  const float reach = 0.06f * std::max({size.x, size.y, size.z});
  const Patch patch =
      seen_patch(work.camera, work.occluded, reach, work.framebuffer.width(), work.framebuffer.height());
  if (!patch.empty()) occlusion.apply(work.framebuffer, patch, reach, screen);
}

/// Liquids, with the glass and the edges of the box behind and before them.
void Renderer::Impl::draw_liquids(Work& work) {
  Box3f liquids;
  for (const BatchOnDevice& b : work.batches)
    if (b.stage == Stage::liquid && !b.bounds.empty()) liquids.add(b.bounds.min), liquids.add(b.bounds.max);
  if (liquids.empty()) {
    lines.draw_outline(work.picture, work.camera.eye, LinePass::Edges::all);
    mesh_pass.draw(work.meshes, sun, false);
    return;
  }
  part_glass(work.meshes, liquids, work.camera);
  mesh_pass.draw(behind, sun, false);
  for (const auto& look : looks)
    if (!batches_of(*look, Stage::liquid, work.batches).empty()) look->keep_behind(work.frame);
  lines.draw_outline(work.picture, work.camera.eye, LinePass::Edges::behind);
  draw_looks(work, Stage::liquid);
  mesh_pass.draw(before, sun, false);
  lines.draw_outline(work.picture, work.camera.eye, LinePass::Edges::before);
}

Renderer::Renderer() {
  require_opengl_3_3();
  impl_ = std::make_unique<Impl>();
}
Renderer::~Renderer() = default;

std::vector<std::string_view> Renderer::look_names() const {
  std::vector<std::string_view> names;
  for (const auto& look : impl_->looks) names.push_back(look->name());
  return names;
}

void Renderer::draw(const Picture& picture, const Camera& camera, const Framebuffer& framebuffer) {
  check_errors("before a picture is drawn");
  check(picture, camera);
  Impl::Work work = impl_->upload(picture, camera, framebuffer);
  impl_->draw_shadows(work);
  impl_->draw_opaque(work);
  impl_->draw_occlusion(work);
  impl_->draw_liquids(work);
  work.framebuffer.target().bind();
  glEnable(GL_DEPTH_TEST);
  impl_->draw_looks(work, Stage::over);
  impl_->lines.draw_marks(picture);

  glDisable(GL_DEPTH_TEST);
  glUseProgram(0);
  glBindVertexArray(0);
  glActiveTexture(GL_TEXTURE0);
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  check_errors("drawing a picture");
}

}  // namespace dreampm::gl

#include "dreampm/gl/sun_map.h"

#include <epoxy/gl.h>

#include <algorithm>

namespace dreampm::gl {

SunFrame sun_frame(const Picture& picture, int texels) {
  const Box3f& box = picture.domain;
  SunFrame f{};
  f.floor = picture.floor.height;
  f.height = std::max(box.max.y - f.floor, 1e-6f) * 1.05f;
  Vec3f d = normalized(picture.lights[0].position - box.center());
  // Rays nearer to the floor would make the patch endless.
  d.y = std::max(d.y, 0.25f);
  f.to_light = normalized(d);
  // The floor below the domain and where the rays through its upper corners end.
  const float reach = f.height / f.to_light.y, margin = 0.12f * std::max({box.size().x, box.size().y, box.size().z});
  const float shift_x = -f.to_light.x * reach, shift_z = -f.to_light.z * reach;
  f.low_x = box.min.x + std::min(shift_x, 0.0f) - margin;
  f.low_z = box.min.z + std::min(shift_z, 0.0f) - margin;
  f.size_x = std::max(box.size().x + std::abs(shift_x) + 2 * margin, 1e-6f);
  f.size_z = std::max(box.size().z + std::abs(shift_z) + 2 * margin, 1e-6f);
  f.size_x = f.size_z = std::max(f.size_x, f.size_z);
  f.texel = f.size_x / static_cast<float>(texels);
  return f;
}

namespace {
constexpr float clear_shadow = 0.5f;  // of liquids: most light goes through
}

SunMap::SunMap() {
  depth_.resize(texels, texels);
  darkness_.resize(texels, texels);
  for (Texture* t : {&soft_half_, &soft_}) t->resize(soft_texels, soft_texels);
  for (Texture* t : {&softer_half_, &softer_}) t->resize(softer_texels, softer_texels);
}

void SunMap::draw_depth(std::span<const BatchOnDevice> batches, std::span<const MeshOnDevice> meshes) {
  depth_target_.bind();
  glDisable(GL_BLEND);
  glDisable(GL_SCISSOR_TEST);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
  glDepthMask(GL_TRUE);
  glClear(GL_DEPTH_BUFFER_BIT);
  particles_.use();
  for (const BatchOnDevice& b : batches) {
    if (b.thinned_count == 0 || b.stage == Stage::over) continue;
    set_particle_uniforms(particles_, *b.batch, b.thinned_radius);
    particles_.set("darkness", b.stage == Stage::liquid ? clear_shadow : b.batch->opacity);
    b.thinned->bind();
    glDrawArrays(GL_POINTS, 0, b.thinned_count);
  }
  meshes_.use();
  for (const MeshOnDevice& m : meshes) {
    if (m.count == 0) continue;
    meshes_.set("pose", m.pose);
    meshes_.set("darkness", m.batch->opacity);
    m.vertices->bind();
    glDrawElements(GL_TRIANGLES, m.count, GL_UNSIGNED_INT, nullptr);
  }
  glDisable(GL_DEPTH_TEST);
}

void SunMap::blur(const Program& program, const Texture& from, const Target& to, float stride_x, float stride_y,
                  int taps, const ScreenTriangle& screen) {
  to.bind();
  program.use();
  program.texture("source", 0, from);
  program.texture("darkness", 1, darkness_);
  program.set("stride", stride_x, stride_y);
  program.set("taps", taps);
  screen.draw();
}

void SunMap::draw(std::span<const BatchOnDevice> batches, std::span<const MeshOnDevice> meshes,
                  const ScreenTriangle& screen) {
  draw_depth(batches, meshes);
  depth_.compare(false);
  constexpr float narrow = 1.2f / soft_texels, wide = 1.6f / softer_texels;
  blur(first_blur_, depth_, soft_half_target_, narrow, 0, 3, screen);
  blur(blur_, soft_half_, soft_target_, 0, narrow, 3, screen);
  blur(blur_, soft_, softer_half_target_, wide, 0, 6, screen);
  blur(blur_, softer_half_, softer_target_, 0, wide, 6, screen);
  depth_.compare(true);
}

}  // namespace dreampm::gl

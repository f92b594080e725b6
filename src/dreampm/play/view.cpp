#include "dreampm/play/view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace dreampm::play {
namespace {

/// From the best look to the quickest, as look_choices() has them, with the looks of gl/ that clear
/// liquids, grains and all else have there.
struct Rung {
  std::string_view choice, clear, grains, solid;
};
constexpr std::array<Rung, 3> ladder{{{"matter", "water", "grains", "skin"},
                                      {"spheres", "spheres", "spheres", "spheres"},
                                      {"points", "points", "points", "points"}}};
/// ms: a picture that takes longer for a while goes down a rung; one that is much quicker goes up.
constexpr double slow_ms = 70, quick_ms = 20;
constexpr int patience = 20;  ///< pictures

/// Of a clear liquid: what it scatters back is what a hand's breadth of it lets through.
gl::Liquid liquid_of(const MatterLook& look) {
  gl::Liquid liquid;
  liquid.absorption = look.absorption, liquid.refractive_index = look.refractive_index;
  const Vec3f& a = look.absorption;
  if (const float thick = std::max({a.x, a.y, a.z}); thick > 20) {
    constexpr float breadth = 0.04f;
    liquid.tint = {std::exp(-a.x * breadth), std::exp(-a.y * breadth), std::exp(-a.z * breadth)};
    liquid.cloudiness = 3;
  }
  return liquid;
}

Vec3f color_of(const MatterLook& look) {
  if (!look.clear) return look.color;
  const Vec3f& a = look.absorption;
  const float breadth = std::max({a.x, a.y, a.z}) > 20 ? 0.04f : 0.12f;
  return {0.9f * std::exp(-a.x * breadth), 0.9f * std::exp(-a.y * breadth), 0.95f * std::exp(-a.z * breadth)};
}

}  // namespace

gl::Camera camera_of(const Frame& frame) {
  gl::Camera camera;
  camera.eye = static_cast<Vec3f>(frame.eye), camera.target = static_cast<Vec3f>(frame.target);
  camera.view_angle = static_cast<float>(frame.view_angle);
  return camera;
}

void View::draw(const Frame& frame, const gl::Camera& camera, const std::optional<HandMark>& hand,
                const gl::Framebuffer& framebuffer) {
  const std::string& choice = look_choices()[static_cast<std::size_t>(frame.settings.look)];
  const auto asked = std::find_if(ladder.begin(), ladder.end(), [&](const Rung& r) { return r.choice == choice; });
  automatic_ = asked == ladder.end();
  if (!automatic_) level_ = static_cast<int>(asked - ladder.begin());
  const Rung& rung = ladder[static_cast<std::size_t>(level_)];

  gl::Picture picture;
  std::vector<gl::ParticleBatch> batches;
  const auto spacing = static_cast<float>(frame.spacing);
  for (const MatterFrame& m : frame.matter) {
    if (m.position.empty()) continue;
    gl::ParticleBatch batch;
    batch.position = m.position;
    batch.base_color = color_of(*m.look);
    batch.spacing = spacing;
    if (!m.look->clear) batch.opacity = m.look->opacity;
    if (!m.color.empty()) {
      batch.color = m.color;
      batch.look = rung.clear == "water" ? "spheres" : rung.clear;
    } else if (!m.value.empty()) {
      batch.value = m.value, batch.value_min = frame.value_min, batch.value_max = frame.value_max;
      // Clear matter does not show colors.
      batch.look = rung.clear == "water" ? "spheres" : rung.clear;
    } else {
      batch.look = m.look->clear ? rung.clear : m.look->grains ? rung.grains : rung.solid;
      if (m.look->clear) batch.liquid = liquid_of(*m.look);
    }
    batch.radius = batch.look == "spheres" || batch.look == "points" ? 0.6f * spacing : 0.8f * spacing;
    if (batch.look == "grains") batch.radius = 0.5f * spacing;
    batches.push_back(batch);
  }
  std::vector<gl::MeshBatch> meshes;
  for (const BodyFrame& b : frame.bodies)
    meshes.push_back({b.mesh->vertices, b.mesh->triangles, {}, b.pose, b.color, b.opacity});
  picture.particles = batches, picture.meshes = meshes;
  picture.domain = {static_cast<Vec3f>(frame.domain.min), static_cast<Vec3f>(frame.domain.max)};
  picture.outline = frame.settings.outline != 0;
  picture.floor.height = picture.domain.min.y;
  picture.lights = gl::lights_for(picture.domain);
  picture.theme = frame.settings.dark != 0 ? gl::dark_theme() : gl::light_theme();
  if (hand) picture.ring = {hand->center, hand->normal, hand->radius};
  renderer_.draw(picture, camera, framebuffer);
}

void View::took(double ms) {
  drawn_ms_ = frames_ == 0 ? ms : 0.8 * drawn_ms_ + 0.2 * ms;
  if (++frames_ < patience || !automatic_) return;
  const int last = static_cast<int>(ladder.size()) - 1;
  const int next = drawn_ms_ > slow_ms    ? std::min(level_ + 1, last)
                   : drawn_ms_ < quick_ms ? std::max(level_ - 1, 0)
                                          : level_;
  if (next != level_) level_ = next, frames_ = 0;
}

std::string_view View::look() const { return ladder[static_cast<std::size_t>(level_)].choice; }

}  // namespace dreampm::play

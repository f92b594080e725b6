#include "dreampm/play/view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <vector>

namespace dreampm::play {
namespace {

/// From the best look to the quickest, as look_choices() has them, with the looks of gl/ that clear
/// liquids, grains and all else have there.
struct Rung {
  std::string_view choice, clear, grains, solid;
};
constexpr std::array<Rung, LookLadder::rungs> ladder{{{"matter", "water", "grains", "skin"},
                                                      {"spheres", "spheres", "spheres", "spheres"},
                                                      {"points", "points", "points", "points"}}};
constexpr int patience = 20;  ///< pictures
/// A particle costs as much as that number of pixels, about.
constexpr double pixels_of_particle = 10;

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

/// A level circle about each pin, and a cross in it.
std::vector<gl::LineSegment> marks_of(std::span<const PinFrame> pins) {
  constexpr int sides = 32;
  const Vec3f color{0.9f, 0.25f, 0.2f};
  std::vector<gl::LineSegment> lines;
  for (const PinFrame& pin : pins) {
    const auto at = [&](int n) {
      const float angle = 2 * std::numbers::pi_v<float> * static_cast<float>(n) / sides;
      return pin.at + Vec3f{std::cos(angle), 0, std::sin(angle)} * pin.radius;
    };
    for (int n = 0; n < sides; ++n) lines.push_back({at(n), at(n + 1), color});
    for (const int n : {0, sides / 4}) lines.push_back({at(n), at(n + sides / 2), color});
  }
  return lines;
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
  if (!automatic_) ladder_.stand_on(static_cast<int>(asked - ladder.begin()));
  const Rung& rung = ladder[static_cast<std::size_t>(ladder_.rung())];

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
    // Balls of a size of their own.
    if (m.look->ball > 0 && (batch.look == "skin" || batch.look == "spheres"))
      batch.look = "spheres", batch.radius = m.look->ball * spacing;
    batches.push_back(batch);
  }
  std::vector<gl::MeshBatch> meshes;
  if (drawn_.size() < frame.bodies.size()) drawn_.resize(frame.bodies.size());
  for (const BodyFrame& b : frame.bodies) {
    drawn_[meshes.size()] = b.mesh;
    meshes.push_back({b.mesh->vertices, b.mesh->triangles, {}, b.pose, b.color, b.opacity});
  }
  picture.particles = batches, picture.meshes = meshes;
  picture.domain = {static_cast<Vec3f>(frame.domain.min), static_cast<Vec3f>(frame.domain.max)};
  picture.outline = frame.settings.outline != 0;
  picture.floor.height = picture.domain.min.y;
  picture.lights = gl::lights_for(picture.domain);
  picture.theme = frame.settings.dark != 0 ? gl::dark_theme() : gl::light_theme();
  const std::vector<gl::LineSegment> pins = marks_of(frame.pins);
  picture.segments = pins;
  if (hand) picture.ring = {hand->center, hand->normal, hand->radius};
  load_ = static_cast<double>(framebuffer.width()) * framebuffer.height() +
          pixels_of_particle * static_cast<double>(frame.particles);
  renderer_.draw(picture, camera, framebuffer);
}

void LookLadder::took(double ms, double load) {
  mean_ms_ = pictures_ == 0 ? ms : 0.8 * mean_ms_ + 0.2 * ms;
  if (++pictures_ < patience) return;
  const auto at = static_cast<std::size_t>(rung_);
  if (mean_ms_ > slow_ms && rung_ + 1 < rungs) {
    slow_of_[at] = mean_ms_ / load;
    if (tries_) wait_ = std::min(2 * wait_, longest_wait);
    stand_on(rung_ + 1);
    tries_ = false;
  } else if (mean_ms_ < quick_ms && rung_ > 0) {
    const double expected = slow_of_[at - 1] * load;
    if (expected > 0.8 * slow_ms && pictures_ < wait_) return;
    tries_ = expected > 0;
    stand_on(rung_ - 1);
  } else if (pictures_ > wait_) {
    wait_ = first_wait, tries_ = false;  // it holds
  }
}

void View::took(double ms) {
  if (automatic_) ladder_.took(ms, load_);
}

std::string_view View::look() const { return ladder[static_cast<std::size_t>(ladder_.rung())].choice; }

}  // namespace dreampm::play

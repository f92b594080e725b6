#include "dreampm/play/window/view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <utility>
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
/// Of the ladder: pictures and seconds that a rung is judged after, and seconds that it is kept at
/// least where a better one may be in time.
constexpr int fewest = 4;
constexpr double settled = 0.5, hold = 2;
/// s: for how long a picture counts at most.
constexpr double longest_shown = 0.5;
/// By how much a rung down must be quicker, and s: for how long it is not tried again where it is
/// not.
constexpr double least_gain = 1.25, useless_for = 60;
/// Times what is slow, of a better rung that is not tried.
constexpr double hopeless = 3;
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

/// A level circle about each place, and a cross in it.
std::vector<gl::LineSegment> lines_of(std::span<const PlaceMark> marks) {
  constexpr int sides = 32;
  const Vec3f color{0.9f, 0.25f, 0.2f};
  std::vector<gl::LineSegment> lines;
  for (const PlaceMark& mark : marks) {
    const auto at = [&](int n) {
      const float angle = 2 * std::numbers::pi_v<float> * static_cast<float>(n) / sides;
      return mark.at + Vec3f{std::cos(angle), 0, std::sin(angle)} * mark.radius;
    };
    for (int n = 0; n < sides; ++n) lines.push_back({at(n), at(n + 1), color});
    for (const int n : {0, sides / 4}) lines.push_back({at(n), at(n + sides / 2), color});
  }
  return lines;
}

}  // namespace

void View::draw(const Frame& frame, const gl::Camera& camera, const std::optional<CursorMark>& mark,
                const gl::Framebuffer& framebuffer) {
  const std::string& choice = look_choices()[static_cast<std::size_t>(frame.settings.look)];
  const auto asked = std::find_if(ladder.begin(), ladder.end(), [&](const Rung& r) { return r.choice == choice; });
  const bool was_chosen = !automatic_;
  automatic_ = asked == ladder.end();
  if (automatic_ && was_chosen) ladder_.stand_on(0);
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
  for (const auto& [sprites, look] : {std::pair{&frame.bubbles, "bubbles"}, std::pair{&frame.foam, "foam"}}) {
    if (sprites->size() == 0) continue;
    gl::ParticleBatch batch;
    batch.position = sprites->position, batch.value = sprites->radius, batch.color = sprites->color;
    batch.look = look;
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
  picture.outline = frame.settings.outline;
  picture.floor.height = picture.domain.min.y;
  picture.lights = gl::lights_for(picture.domain);
  picture.theme = frame.settings.dark ? gl::dark_theme() : gl::light_theme();
  const std::vector<gl::LineSegment> marks = lines_of(frame.marks);
  picture.segments = marks;
  if (mark) picture.ring = {mark->center, mark->normal, mark->radius};
  load_ = static_cast<double>(framebuffer.width()) * framebuffer.height() +
          pixels_of_particle * static_cast<double>(frame.particles);
  renderer_.draw(picture, camera, framebuffer);
}

void LookLadder::go_to(int rung) { rung_ = rung, pictures_ = 0, stood_ = slow_for_ = 0; }

void LookLadder::stand_on(int rung) {
  go_to(rung);
  left_ms_ = stays_ = 0;
}

double LookLadder::expected(double load) const {
  const auto better = static_cast<std::size_t>(rung_ - 1);
  const double own = cost_[better] * load, beside = ratio_[better] * mean_ms_;
  // The machine was as busy then as it was: the lower of the two.
  return own > 0 && beside > 0 ? std::min(own, beside) : std::max(own, beside);
}

void LookLadder::took(double ms, double load, double seconds) {
  seconds = std::min(seconds, longest_shown);
  stood_ += seconds, stays_ = std::max(0.0, stays_ - seconds);
  // The first picture of a rung makes its programs and textures.
  if (++pictures_ < 2) return;
  mean_ms_ = pictures_ == 2 ? ms : 0.8 * mean_ms_ + 0.2 * ms;
  slow_for_ = mean_ms_ > slow_ms ? slow_for_ + seconds : 0;
  if (pictures_ < fewest || stood_ < settled) return;
  const auto at = static_cast<std::size_t>(rung_);
  cost_[at] = mean_ms_ / load;
  if (left_ms_ > 0) {
    ratio_[at - 1] = cost_[at - 1] / cost_[at];
    const bool gains = left_ms_ / mean_ms_ >= least_gain;
    // Perhaps the next one does.
    if (!gains && mean_ms_ > slow_ms && rung_ + 1 < rungs) return go_to(rung_ + 1);
    left_ms_ = 0;
    if (!gains) {
      stays_ = useless_for;
      return go_to(left_rung_);
    }
  }
  if (slow_for_ >= patience && rung_ + 1 < rungs && stays_ == 0) {
    if (tries_) wait_ = std::min(2 * wait_, longest_wait);
    left_ms_ = mean_ms_, left_rung_ = rung_, tries_ = false;
    return go_to(rung_ + 1);
  }
  if (rung_ > 0 && mean_ms_ < slow_ms && stood_ >= hold) {
    const double ms_up = expected(load);
    if ((ms_up > 0 && ms_up < 0.85 * slow_ms) || (stood_ > wait_ && ms_up < hopeless * slow_ms)) {
      tries_ = true;
      return go_to(rung_ - 1);
    }
  }
  if (tries_ && stood_ > wait_) wait_ = first_wait, tries_ = false;  // it holds
}

void View::took(double ms, double seconds) {
  if (automatic_) ladder_.took(ms, load_, seconds);
}

std::string_view View::look() const { return ladder[static_cast<std::size_t>(ladder_.rung())].choice; }

}  // namespace dreampm::play

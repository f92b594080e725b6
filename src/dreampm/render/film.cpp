#include "dreampm/render/film.h"

#include <algorithm>
#include <cmath>

#include "dreampm/base/error.h"
#include "dreampm/base/interrupt.h"
#include "dreampm/base/parallel.h"
#include "dreampm/render/tone.h"

namespace dreampm::trace {
namespace {

constexpr int tile = 16;
/// Few samples may all lie on one side of an edge, and so look sure, and a few levels of an edge
/// show as steps. Where pixels beside each other differ by `edge_step`, surer than their errors,
/// `edge_samples` times the least samples are taken, and in proportion less where they differ less.
constexpr float edge_step = 0.06f, edge_samples = 5;
/// Brighter samples are fireflies.
constexpr float brightest = 10;

/// A tent filter a bit narrower than a pixel each way.
float tent(float u) { return 0.9f * (u < 0.5f ? std::sqrt(2 * u) - 1 : 1 - std::sqrt(2 - 2 * u)); }

}  // namespace

Film::Film(const RenderSettings& settings, const PixelBox& box, const View& view, bool clamp)
    : settings_(settings),
      box_(box),
      view_(view),
      clamp_(clamp),
      width_(static_cast<std::size_t>(box.width())),
      height_(static_cast<std::size_t>(box.height())),
      pixels_(width_ * height_),
      asides_(view.firsts != nullptr ? width_ * height_ : 0),
      wanted_(width_ * height_, settings.min_samples) {}

float Film::Pixel::error() const {
  const float n = static_cast<float>(count);
  const Vec3f mean = shown / n, variance = max(Vec3f{}, shown2 / n - mean * mean);
  return std::sqrt((variance.x + variance.y + variance.z) / (3 * (n - 1)));
}

void Film::expose(const std::function<void(double)>& progress) {
  const std::size_t across = (width_ + tile - 1) / tile, down = (height_ + tile - 1) / tile;
  constexpr std::size_t band = 4;
  for (std::size_t row = 0; row < down; row += band) {
    if (interrupted()) throw Interrupted("interrupted while rendering");
    const std::size_t rows = std::min(band, down - row);
    parallel_for(across * rows, 1, [&](std::size_t i) { expose_tile(i % across, row + i / across); });
    progress(static_cast<double>(row + rows) / static_cast<double>(down));
  }
}

void Film::expose_tile(std::size_t tx, std::size_t ty) {
  for (std::size_t y = ty * tile; y < std::min(height_, (ty + 1) * tile); ++y)
    for (std::size_t x = tx * tile; x < std::min(width_, (tx + 1) * tile); ++x)
      expose_pixel(y * width_ + x, box_.x0 + static_cast<int>(x), box_.y0 + static_cast<int>(y));
}

void Film::expose_pixel(std::size_t i, int x, int y) {
  const Camera& camera = view_.camera;
  Pixel& pixel = pixels_[i];
  const auto stream = static_cast<std::uint32_t>(static_cast<std::size_t>(y) * std::size_t(settings_.width) +
                                                 static_cast<std::size_t>(x));
  for (; pixel.count < wanted_[i]; ++pixel.count) {
    Sampler random(stream_of(settings_.seed, 0, stream), static_cast<std::uint32_t>(pixel.count));
    const float a = random.next(), b = random.next();
    const float px = static_cast<float>(x) + 0.5f + tent(a), py = static_cast<float>(y) + 0.5f + tent(b);
    float time = 0.5f;
    if (view_.moves) time = random.next();
    CameraRay ray{camera.eye(), {}};
    if (camera.lens_radius() > 0) {
      const float u = random.next(), v = random.next();
      ray = camera.ray(px, py, u, v);
    } else {
      ray.direction = camera.direction(px, py);
    }
    Vec3f c = view_.integrator.radiance(ray.origin, ray.direction, random, time);
    if (!is_finite(c)) c = {};
    if (const float m = largest(c); clamp_ && m > brightest) c *= brightest / m;
    const Vec3f shown = as_shown(c);
    pixel.sum += c, pixel.shown += shown, pixel.shown2 += shown * shown;
    if (!asides_.empty()) {
      const FirstHit first = view_.firsts->at(ray.origin, ray.direction, time);
      asides_[i].normal += first.normal, asides_[i].albedo += first.albedo;
    }
  }
}

float Film::edge_at(std::size_t x, std::size_t y, const std::vector<float>& error) const {
  const std::size_t i = y * width_ + x;
  const Vec3f here = pixels_[i].shown / static_cast<float>(pixels_[i].count);
  float edge = 0;
  const auto beside = [&](std::size_t j) {
    const Vec3f step = pixels_[j].shown / static_cast<float>(pixels_[j].count) - here;
    edge = std::max(edge, std::sqrt(length2(step) / 3) - 2 * (error[i] + error[j]));
  };
  if (x > 0) beside(i - 1);
  if (x + 1 < width_) beside(i + 1);
  if (y > 0) beside(i - width_);
  if (y + 1 < height_) beside(i + width_);
  return edge;
}

void Film::ask_more() {
  std::vector<float> error(pixels_.size());
  for (std::size_t i = 0; i < pixels_.size(); ++i) error[i] = pixels_[i].error();
  for (std::size_t y = 0; y < height_; ++y)
    for (std::size_t x = 0; x < width_; ++x) {
      float worst = error[y * width_ + x];
      for (std::size_t yy = y > 0 ? y - 1 : 0; yy < std::min(y + 2, height_); ++yy)
        for (std::size_t xx = x > 0 ? x - 1 : 0; xx < std::min(x + 2, width_); ++xx)
          worst = std::max(worst, 0.7f * error[yy * width_ + xx]);
      const float k = worst / settings_.noise, steep = std::min(1.0f, edge_at(x, y, error) / edge_step);
      const float n = static_cast<float>(settings_.min_samples) * std::max(k * k, edge_samples * steep);
      wanted_[y * width_ + x] = static_cast<int>(
          std::clamp(n, static_cast<float>(settings_.min_samples), static_cast<float>(settings_.samples)));
    }
}

std::vector<Vec3f> Film::linear() const {
  std::vector<Vec3f> out(pixels_.size());
  for (std::size_t i = 0; i < pixels_.size(); ++i) out[i] = pixels_[i].sum * (1 / static_cast<float>(pixels_[i].count));
  return out;
}

FirstSurfaces Film::surfaces() const {
  FirstSurfaces out;
  const std::size_t n = pixels_.size();
  out.depth.assign(n, sky_depth), out.motion.resize(n), out.normal.resize(n), out.albedo.resize(n);
  const Camera& camera = view_.camera;
  const auto half = static_cast<float>(0.5 * view_.frame_time);
  parallel_for(height_, 1, [&](std::size_t y) {
    for (std::size_t x = 0; x < width_; ++x) {
      const std::size_t i = y * width_ + x;
      const float each = 1 / static_cast<float>(pixels_[i].count);
      out.normal[i] = asides_[i].normal * each, out.albedo[i] = asides_[i].albedo * each;
      const Vec3f d = camera.direction(static_cast<float>(box_.x0) + static_cast<float>(x) + 0.5f,
                                       static_cast<float>(box_.y0) + static_cast<float>(y) + 0.5f);
      const FirstHit first = view_.firsts->at(camera.eye(), d, 0.5f);
      if (!first.found) continue;
      out.depth[i] = camera.depth(first.point);
      const Vec3f before = first.point - first.velocity * half, after = first.point + first.velocity * half;
      if (first.velocity == Vec3f{} || camera.depth(before) <= 0 || camera.depth(after) <= 0) continue;
      const auto from = camera.project(before), to = camera.project(after);
      out.motion[i] = {to.first - from.first, from.second - to.second};
    }
  });
  return out;
}

RenderReport Film::report(const PixelBox& part) const {
  RenderReport out;
  double samples = 0, error2 = 0, stopped = 0;
  for (int y = part.y0; y < part.y1; ++y)
    for (int x = part.x0; x < part.x1; ++x) {
      const Pixel& p = pixels_[static_cast<std::size_t>(y - box_.y0) * width_ + static_cast<std::size_t>(x - box_.x0)];
      const double error = static_cast<double>(p.error());
      samples += p.count, error2 += error * error;
      if (p.count >= settings_.samples && error > static_cast<double>(settings_.noise)) ++stopped;
    }
  const auto n = static_cast<double>(part.size());
  return {samples / n, std::sqrt(error2 / n), stopped / n};
}

}  // namespace dreampm::trace

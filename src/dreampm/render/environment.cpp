#include "dreampm/render/environment.h"

#include <algorithm>

#include "dreampm/render/color.h"

namespace dreampm::trace {
namespace {

/// The entry of running sums that holds the share a of the last, and where within it.
std::pair<std::size_t, float> find_share(const double* sums, std::size_t n, float a) {
  const double target = static_cast<double>(a) * sums[n];
  const double* const above = std::upper_bound(sums + 1, sums + n + 1, target);
  const auto i = std::min(static_cast<std::size_t>(above - sums) - 1, n - 1);
  const double width = sums[i + 1] - sums[i];
  return {i, width > 0 ? static_cast<float>(std::clamp((target - sums[i]) / width, 0.0, 1.0)) : 0.5f};
}

}  // namespace

Environment::Environment(int width, int height, std::vector<Vec3f> pixels, float turn)
    : width_(static_cast<std::size_t>(width)),
      height_(static_cast<std::size_t>(height)),
      pixels_(std::move(pixels)),
      turn_(turn),
      solid_angle_(height_),
      in_row_((width_ + 1) * height_),
      rows_(height_ + 1) {
  for (std::size_t y = 0; y < height_; ++y) {
    // Radiance is drawn between the middles of pixels, so that a pixel reaches into the next ones.
    const auto latitude = [&](std::size_t row) {
      return std::cos(std::numbers::pi * static_cast<double>(row) / static_cast<double>(height_));
    };
    solid_angle_[y] = (latitude(y) - latitude(y + 1)) * 2 * std::numbers::pi / static_cast<double>(width_);
    double* const sums = &in_row_[y * (width_ + 1)];
    for (std::size_t x = 0; x < width_; ++x) {
      double brightness = 0;
      for (std::size_t j = y > 0 ? y - 1 : 0; j < std::min(y + 2, height_); ++j)
        for (const std::size_t i : {(x + width_ - 1) % width_, x, (x + 1) % width_})
          brightness += static_cast<double>(luminance(pixels_[j * width_ + i])) * (i == x && j == y ? 4 : 1);
      sums[x + 1] = sums[x] + brightness * solid_angle_[y];
    }
    rows_[y + 1] = rows_[y] + sums[width_];
  }
  pool_.resize(pool_side * pool_side);
  for (std::size_t i = 0; i < pool_.size(); ++i) {
    const auto inside = [&](std::size_t k, std::size_t dimension) {
      const auto h = hash32(static_cast<std::uint32_t>(2 * i + dimension));
      return (static_cast<float>(k) + unit_float(h)) / static_cast<float>(pool_side);
    };
    pool_[i] = draw(inside(i / pool_side, 0), inside(i % pool_side, 1));
  }
}

std::optional<Environment> Environment::bright_parts(float times) const {
  constexpr double little = 0.02;
  double all = 0, bright = 0;
  for (std::size_t i = 0; i < pixels_.size(); ++i)
    all += static_cast<double>(luminance(pixels_[i])) * solid_angle_[i / width_];
  const float limit = times * static_cast<float>(all / (4 * std::numbers::pi));
  std::vector<Vec3f> pixels(pixels_.size());
  for (std::size_t i = 0; i < pixels_.size(); ++i) {
    const float l = luminance(pixels_[i]);
    if (l <= limit) continue;
    pixels[i] = pixels_[i] * (1 - limit / l);
    bright += static_cast<double>(l - limit) * solid_angle_[i / width_];
  }
  if (bright < little * all) return std::nullopt;
  return Environment(static_cast<int>(width_), static_cast<int>(height_), std::move(pixels), turn_);
}

Environment::Place Environment::place_of(const Vec3f& d) const {
  float u = (std::atan2(d.z, d.x) + turn_) / (2 * pi) + 0.5f;
  u -= std::floor(u);
  const float v = std::acos(std::clamp(d.y, -1.0f, 1.0f)) / pi;
  return {u * static_cast<float>(width_), v * static_cast<float>(height_)};
}

Vec3f Environment::direction_at(const Place& place) const {
  const float phi = 2 * pi * (place.u / static_cast<float>(width_) - 0.5f) - turn_,
              theta = pi * place.v / static_cast<float>(height_), s = std::sin(theta);
  return {s * std::cos(phi), std::cos(theta), s * std::sin(phi)};
}

Vec3f Environment::radiance(const Vec3f& d) const {
  const Place at = place_of(d);
  const float u = at.u - 0.5f, v = std::clamp(at.v - 0.5f, 0.0f, static_cast<float>(height_ - 1));
  const float fu = std::floor(u), fv = std::min(std::floor(v), static_cast<float>(height_ - 1));
  const int w = static_cast<int>(width_), x = (static_cast<int>(fu) + w) % w, x1 = (x + 1) % w,
            y = static_cast<int>(fv), y1 = std::min(y + 1, static_cast<int>(height_) - 1);
  return mix(mix(pixels_[pixel(x, y)], pixels_[pixel(x1, y)], u - fu),
             mix(pixels_[pixel(x, y1)], pixels_[pixel(x1, y1)], u - fu), v - fv);
}

Environment::Drawn Environment::draw(float a, float b) const {
  if (!(rows_.back() > 0)) return {};
  const auto [y, fy] = find_share(rows_.data(), height_, a);
  const auto [x, fx] = find_share(&in_row_[y * (width_ + 1)], width_, b);
  Drawn out;
  // Even by solid angle within the pixel's row.
  const float top = std::cos(pi * static_cast<float>(y) / static_cast<float>(height_)),
              bottom = std::cos(pi * static_cast<float>(y + 1) / static_cast<float>(height_));
  const float c = mix(top, bottom, fy), s = std::sqrt(std::max(0.0f, 1 - c * c)),
              phi = 2 * pi * ((static_cast<float>(x) + fx) / static_cast<float>(width_) - 0.5f) - turn_;
  out.direction = {s * std::cos(phi), c, s * std::sin(phi)};
  out.radiance = radiance(out.direction);
  out.density = density(out.direction);
  return out;
}

float Environment::density(const Vec3f& d) const {
  if (!(rows_.back() > 0)) return 0;
  const Place at = place_of(d);
  const std::size_t x = std::min(static_cast<std::size_t>(at.u), width_ - 1),
                    y = std::min(static_cast<std::size_t>(at.v), height_ - 1);
  const double* const sums = &in_row_[y * (width_ + 1)];
  return static_cast<float>((sums[x + 1] - sums[x]) / (rows_.back() * solid_angle_[y]));
}

Vec3f Environment::irradiance(const Vec3f& n) const {
  Vec3d sum;
  for (std::size_t y = 0; y < height_; ++y)
    for (std::size_t x = 0; x < width_; ++x) {
      const float c = dot(n, direction_at({static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f}));
      if (c > 0) sum += static_cast<Vec3d>(pixels_[y * width_ + x]) * (static_cast<double>(c) * solid_angle_[y]);
    }
  return static_cast<Vec3f>(sum);
}

}  // namespace dreampm::trace

#include "dreampm/render/backdrop.h"

#include <algorithm>
#include <cmath>

#include "dreampm/render/color.h"

namespace dreampm::trace {

Backdrop::Backdrop(const Box3f& basin, const Vec3f& eye) : scale_(std::max(basin.size().x, basin.size().z)) {
  Vec3f back = basin.center() - eye;
  back.y = 0;
  back_ = length(back) > 1e-6f * scale_ ? normalized(back) : Vec3f{0, 0, -1};
  side_ = {-back_.z, 0, back_.x};
  foot_ = {basin.center().x, basin.min.y, basin.center().z};
  begin_ = 1.5f * scale_, bend_ = 1.2f * scale_, high_ = 6 * scale_, wide_ = 9 * scale_;
}

float Backdrop::quarter() const { return 0.5f * pi * bend_; }

TriMesh Backdrop::mesh() const {
  constexpr int steps = 32;
  TriMesh mesh;
  const auto add = [&](float along) {
    for (const float across : {-wide_, wide_}) mesh.vertices.push_back(point_at({along, across}));
  };
  for (int i = 0; i <= steps; ++i) add(begin_ + quarter() * static_cast<float>(i) / steps);
  add(end());
  for (std::uint32_t i = 0; i <= steps; ++i) {
    mesh.triangles.push_back({2 * i, 2 * i + 1, 2 * i + 3});
    mesh.triangles.push_back({2 * i, 2 * i + 3, 2 * i + 2});
  }
  return mesh;
}

Backdrop::Place Backdrop::place_of(const Vec3f& p) const {
  const Vec3f off = p - foot_;
  const float far = dot(off, back_), across = dot(off, side_);
  if (far <= begin_) return {far, across};
  if (off.y >= bend_) return {begin_ + quarter() + off.y - bend_, across};
  const float angle = std::atan2(far - begin_, bend_ - off.y);
  return {begin_ + bend_ * std::clamp(angle, 0.0f, 0.5f * pi), across};
}

Vec3f Backdrop::point_at(const Place& place) const {
  const float angle = std::clamp((place.along - begin_) / bend_, 0.0f, 0.5f * pi);
  const float behind = std::min(place.along, begin_) + bend_ * std::sin(angle),
              above = bend_ * (1 - std::cos(angle)) + std::max(0.0f, place.along - begin_ - quarter());
  return foot_ + back_ * behind + side_ * place.across + Vec3f{0, above, 0};
}

Vec3f Backdrop::normal_at(const Place& place) const {
  const float angle = std::clamp((place.along - begin_) / bend_, 0.0f, 0.5f * pi);
  return Vec3f{0, std::cos(angle), 0} - back_ * std::sin(angle);
}

}  // namespace dreampm::trace

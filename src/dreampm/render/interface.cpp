#include "dreampm/render/interface.h"

#include "dreampm/render/color.h"

namespace dreampm::trace {
namespace {

/// The outer face of the glass behind a water face adds this.
constexpr float glass_face = 0.02f;
const Vec3f bar_tint{0.45f, 0.72f, 0.66f};

/// A shading normal may send light through the face itself; bend it back.
Vec3f keep_side(Vec3f d, const Vec3f& face, float sign) {
  const float below = sign * dot(d, face);
  if (below < 0) d = d - face * (1.02f * sign * below);
  return normalized(d);
}

}  // namespace

void Media::add(const Geometry& geometry, int object) {
  if (object == top()) return;
  const auto end = objects_.begin() + size_;
  if (std::find(objects_.begin(), end, object) != end) return;
  auto at = std::find_if(objects_.begin(), end, [&](int o) { return geometry.rank(o) > geometry.rank(object); });
  if (end == objects_.end()) {
    if (at == objects_.begin()) return;
    std::copy(objects_.begin() + 1, at, objects_.begin());
    *--at = static_cast<std::int16_t>(object);
    return;
  }
  std::copy_backward(at, end, end + 1);
  *at = static_cast<std::int16_t>(object);
  ++size_;
}

void Media::remove(int object) {
  if (size_ == 0) return;
  const auto end = objects_.begin() + size_, at = std::find(objects_.begin(), end, object);
  if (at == end) return;
  std::copy(at + 1, end, at);
  --size_;
}

float ior(const Geometry& geometry, const Media& media) {
  return media.top() == air ? 1 : geometry.interior(media.top())->ior;
}

Media across(const Geometry& geometry, const Hit& hit, Media media) {
  if (hit.back)
    media.remove(hit.object);
  else
    media.add(geometry, hit.object);
  return media;
}

void pass_hidden(const Geometry& geometry, Vec3f o, const Vec3f& d, Media& media, Hit& hit, float reach,
                 PassedGrains* passed) {
  constexpr int most_hidden = 64;
  float before = 0;
  for (int hidden = 0; hit.object != air && hit.kind != Kind::opaque; ++hidden) {
    if (hit.back)
      media.add(geometry, hit.object);
    else
      media.remove(hit.object);
    const int top = media.top();
    if (hit.kind != Kind::dielectric || top == air || top == hit.object || hidden == most_hidden ||
        geometry.rank(top) < geometry.rank(hit.object))
      break;
    media = across(geometry, hit, media);
    before += hit.t;
    o = o + d * hit.t;
    hit = geometry.cast(o, d, media.top(), media.time, reach - before, passed);
  }
  hit.t += before;
}

Split split_light(const Geometry& geometry, const Hit& hit, const Vec3f& d, const Media& media) {
  Split s;
  const Vec3f n = hit.back ? -hit.normal : hit.normal;
  s.side = hit.back ? -hit.geometric : hit.geometric;
  const float cos_in = std::clamp(-dot(n, d), 0.0f, 1.0f);
  float cos_out = cos_in, eta = 1;
  s.refracted_media = media;
  if (hit.kind == Kind::dielectric) {
    s.refracted_media = across(geometry, hit, media);
    eta = ior(geometry, media) / ior(geometry, s.refracted_media);
    s.reflectance = fresnel(cos_in, eta, cos_out);
    if (hit.glass && s.reflectance < 1) s.reflectance = std::min(1.0f, s.reflectance + glass_face);
  } else if (hit.kind == Kind::pane) {
    s.reflectance = pane_reflectance(cos_in);
    s.tint = pane_tint;
  } else {
    s.reflectance = fresnel(cos_in, 1 / 1.5f, cos_out);
    s.tint = bar_tint;
  }
  s.reflected = keep_side(d + n * (2 * cos_in), s.side, 1);
  s.refracted = hit.kind == Kind::dielectric ? keep_side(d * eta + n * (eta * cos_in - cos_out), s.side, -1) : d;
  return s;
}

}  // namespace dreampm::trace

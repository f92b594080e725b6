#include "dreampm/render/first_hit.h"

#include "dreampm/render/color.h"
#include "dreampm/render/interface.h"

namespace dreampm::trace {
namespace {

constexpr int most_surfaces = 16;

Vec3f at_most_one(const Vec3f& c) { return min(c, Vec3f{1, 1, 1}); }

}  // namespace

FirstHit FirstHits::at(Vec3f o, Vec3f d, float time) const {
  FirstHit out;
  Media media;
  media.time = time;
  Vec3f weight{1, 1, 1};
  float way = 0;
  for (int k = 0; k < most_surfaces; ++k) {
    const Hit hit = cast_visible(geometry_, o, d, media);
    if (hit.kind == Kind::none) {
      out.albedo = weight * at_most_one(sky_.radiance(d, false));
      return out;
    }
    const Vec3f p = o + d * hit.t;
    way += hit.t;
    weight = weight * geometry_.left(media.top(), o, d, hit.t);
    if (hit.kind == Kind::pane || (hit.grain > 0 && hit.opacity < 0.5f)) {
      if (hit.kind == Kind::pane) weight = weight * pane_tint;
      o = p + d * geometry_.epsilon();
      continue;
    }
    if (!out.found) {
      out.found = true;
      out.point = p;
      out.velocity = geometry_.velocity(hit);
      out.normal = hit.back ? -hit.normal : hit.normal;
    }
    if (hit.kind != Kind::dielectric) {
      out.albedo = weight * albedo_of(hit, p, d, way);
      return out;
    }
    if (const Interior* in = geometry_.interior(hit.object); in->scatters && !hit.back) {
      const Vec3f &s = in->scattering, &all = in->extinction;
      const auto share = [](float a, float b) { return b > 0 ? a / b : 1; };
      out.albedo = weight * Vec3f{share(s.x, all.x), share(s.y, all.y), share(s.z, all.z)};
      return out;
    }
    // Behind a clear surface lies what the picture mostly shows there.
    const Split s = split_light(geometry_, hit, d, media);
    const bool all_back = s.reflectance >= 0.9999f;
    weight = weight * s.tint;
    o = p + s.side * (all_back ? geometry_.epsilon() : -geometry_.epsilon());
    d = all_back ? s.reflected : s.refracted;
    if (!all_back) media = s.refracted_media;
  }
  out.albedo = weight;
  return out;
}

Vec3f FirstHits::albedo_of(const Hit& hit, const Vec3f& p, const Vec3f& d, float way) const {
  if (hit.kind == Kind::bar) return bar_shade;
  if (hit.kind == Kind::floor) {
    const Vec3f far = at_most_one(sky_.radiance(normalized(Vec3f{d.x, 0, d.z}), false));
    return mix(pattern_.albedo(p.x, p.z, way * pixel_angle_ / std::max(0.05f, -d.y)), far, pattern_.fade(p.x, p.z));
  }
  return geometry_.look(hit.object)
      .color_at({p - hit.moved, hit.color, geometry_.frame(hit.object),
                 way * pixel_angle_ / std::max(0.1f, std::fabs(dot(hit.geometric, d)))});
}

}  // namespace dreampm::trace

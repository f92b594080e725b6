// Light that arrives at surfaces straight from the sun, the lamps and the bright parts of the sky,
// and by photons.
#include "dreampm/render/integrator.h"
#include "dreampm/render/path.h"

namespace dreampm::trace {

Vec3f Integrator::lit(const Path& r, const Shading& at, Sampler& random) const {
  Vec3f sum = lit_by(sunlight(at.p, at.n, at.face, r.media, random), at);
  if (options_.lamps != nullptr) {
    LightSample lamp = options_.lamps->draw(at.p, random);
    if (dot(at.n, lamp.direction) > 0 && dot(at.face, lamp.direction) > 0) {
      lamp.irradiance =
          lamp.irradiance * transmitted(at.p + at.face * geometry_.epsilon(), lamp.direction, lamp.direction, r.media,
                                        lamp.distance, options_.photons == nullptr);
      sum += lit_by(lamp, at);
    }
  }
  sum += lit_by_sky(r, at, random);
  return sum + lit_by_photons(r, at);
}

Vec3f Integrator::lit_by(const LightSample& light, const Shading& at) {
  if (!(largest(light.irradiance) > 0)) return {};
  return light.irradiance * at.bsdf.eval(at.view, at.frame.local(light.direction), at.color);
}

/// By multiple importance sampling with the bounce, which Path::density says of it (Veach 1997,
/// the balance heuristic), lobe by lobe.
Vec3f Integrator::lit_by_sky(const Path& r, const Shading& at, Sampler& random) const {
  const Environment* const sky = sky_.aimed_at();
  if (sky == nullptr) return {};
  const float a = random.next(), b = random.next();
  const Environment::Drawn drawn = sky->draw(a, b);
  const Vec3f light = at.frame.local(drawn.direction);
  if (!(drawn.density > 0) || light.z <= 0 || dot(at.face, drawn.direction) <= 0) return {};
  Vec3f scattered;
  for (int lobe = 0; lobe < at.bsdf.lobes(); ++lobe)
    scattered +=
        at.bsdf.eval(lobe, at.view, light, at.color) * (1 / (drawn.density + at.bsdf.pdf(lobe, at.view, light)));
  if (!(largest(scattered) > 0)) return {};
  return drawn.radiance * scattered *
         transmitted(at.p + at.face * geometry_.epsilon(), drawn.direction, drawn.direction, r.media, 1e9f, false);
}

// Paths count radiance over the square of the index where they are.
Vec3f Integrator::lit_by_photons(const Path& r, const Shading& at) const {
  Vec3f sum;
  if (options_.photons == nullptr) return sum;
  const float n = ior(geometry_, r.media);
  options_.photons->at(at.p, at.face, [&](const Vec3f& from, const Vec3f& irradiance) {
    const Vec3f light = at.frame.local(from);
    if (light.z > 0) sum += irradiance * at.bsdf.eval(at.view, light, at.color) * (1 / std::max(0.05f, light.z));
  });
  return sum * (1 / (n * n));
}

// Along the straight line to the sun; in a medium along the line that a level surface would bend,
// which is right on the average but draws no caustics: with photons, these light what is there.
LightSample Integrator::sunlight(const Vec3f& p, const Vec3f& n, const Vec3f& face, const Media& media, Sampler& random,
                                 float away) const {
  if (!sky_.has_sun()) return {};
  const float a = random.next(), b = random.next();
  const Vec3f to_sun = sky_.sample_sun(a, b);
  LightSample s{to_sun};
  const bool through_clear = options_.photons == nullptr || away > 0;
  float gain = 1;
  if (media.top() != air) {
    if (!through_clear) return s;
    const float eta = ior(geometry_, media), y = std::sqrt(1 - (1 - to_sun.y * to_sun.y) / (eta * eta));
    s.direction = {to_sun.x / eta, y, to_sun.z / eta};
    gain = to_sun.y / (y * eta * eta);
  }
  if (dot(n, s.direction) > 0 && dot(face, s.direction) > 0)
    s.irradiance =
        transmitted(p + face * (away + geometry_.epsilon()), s.direction, to_sun, media, s.distance, through_clear) *
        sky_.sun_irradiance() * gain;
  return s;
}

Vec3f Integrator::transmitted(Vec3f o, Vec3f d, const Vec3f& outside, Media media, float reach,
                              bool through_clear) const {
  Vec3f share{1, 1, 1};
  for (int step = 0; step < 24; ++step) {
    const Hit hit = cast_visible(geometry_, o, d, media, reach);
    if (hit.kind == Kind::none) return share;
    reach -= hit.t;
    const Vec3f p = o + d * hit.t;
    if (hit.grain > 0) {
      share *= 1 - hit.opacity;
      if (largest(share) < 1e-3f) return {};
      o = p + d * geometry_.epsilon();
      continue;
    }
    if (hit.kind == Kind::opaque || hit.kind == Kind::floor) return {};
    if (hit.kind == Kind::dielectric) {
      if (!through_clear) return {};
      if (const Interior* in = geometry_.interior(media.top())) share = share * transmission(in->extinction, hit.t);
      const float before = ior(geometry_, media);
      media = across(geometry_, hit, media);
      if (media.top() == air) d = outside;
      const float after = ior(geometry_, media);
      float cos_out;
      share *= 1 - fresnel(std::min(1.0f, std::fabs(dot(hit.normal, outside))),
                           std::min(before, after) / std::max(before, after), cos_out);
    } else if (hit.kind == Kind::pane) {
      share = share * pane_tint * (1 - pane_reflectance(std::fabs(dot(hit.normal, d))));
    } else if (!hit.back) {
      share = share * bar_shade;
    }
    if (largest(share) < 1e-3f) return {};
    o = p + d * geometry_.epsilon();
  }
  return {};
}

}  // namespace dreampm::trace

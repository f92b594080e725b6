// Light that arrives at surfaces straight from the sun, the lamps and the bright parts of the sky,
// and by photons.
#include "dreampm/render/integrator.h"
#include "dreampm/render/path.h"

namespace dreampm::trace {
namespace {

/// Rays to the sky from a surface that a path meets early, and directions drawn for each.
constexpr int most_sky_rays = 4, draws_each = 4;
constexpr float golden = 0.618033989f;

/// One of several directions, each with a chance in proportion to its weight.
struct Choice {
  Vec3f direction, chosen;  ///< and the light that it would send
  float all = 0, of_chosen = 1;
  float lot = 0;  ///< uniform in [0, 1); what a choice leaves of it is so again

  void offer(const Vec3f& d, const Vec3f& sent, float inverse_density) {
    const float sum = sent.x + sent.y + sent.z, weight = sum * inverse_density;
    if (!(weight > 0)) return;
    all += weight;
    if (const float share = weight / all; lot < share)
      chosen = sent, direction = d, of_chosen = sum, lot /= share;
    else
      lot = (lot - share) / (1 - share);
  }
};

}  // namespace

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

/// Draws directions by the sky's brightness and by narrow lobes, and of these the ones that are
/// followed, by what each would send to the path if nothing were in the way: resampled importance
/// sampling (Talbot, Cline and Egbert 2005), with the balance heuristic (Veach 1997) over where a
/// direction came from. What is left to chance is little more than what is in the way.
Vec3f Integrator::lit_by_sky(const Path& r, const Shading& at, Sampler& random) const {
  const Environment* const sky = sky_.aimed_at();
  if (sky == nullptr) return {};
  const int rays = r.bounces <= options_.splits
                       ? std::clamp(static_cast<int>(std::ceil(most_sky_rays * largest(r.weight))), 1, most_sky_rays)
                       : 1;
  const int drawn = draws_each * rays;
  std::array<Choice, most_sky_rays> choices;
  const float a = random.next(), b = random.next();
  for (int i = 0; i < rays; ++i) choices[static_cast<std::size_t>(i)].lot = random.next();
  const auto offer = [&](Choice& choice, const Vec3f& d, const Vec3f& light, const Vec3f& radiance, float density) {
    if (light.z <= 0 || dot(at.face, d) <= 0) return;
    Vec3f scattered;
    float densities = static_cast<float>(drawn) * density;
    for (int lobe = 0; lobe < at.bsdf.lobes(); ++lobe) {
      scattered += at.bsdf.eval(lobe, at.view, light, at.color);
      if (!at.bsdf.wide(lobe)) densities += at.bsdf.pdf(lobe, at.view, light);
    }
    if (densities > 0) choice.offer(d, radiance * scattered, 1 / densities);
  };
  for (int k = 0; k < drawn; ++k) {  // a lattice of rank 1, shifted
    const float u = a + (static_cast<float>(k) + 0.5f) / static_cast<float>(drawn),
                v = b + static_cast<float>(k) * golden;
    const Environment::Drawn& one = sky->drawn_before(u - std::floor(u), v - std::floor(v));
    if (one.density > 0)
      offer(choices[static_cast<std::size_t>(k / draws_each)], one.direction, at.frame.local(one.direction),
            one.radiance, one.density);
  }
  for (int lobe = 0; lobe < at.bsdf.lobes(); ++lobe) {
    if (at.bsdf.mirror(lobe) || at.bsdf.wide(lobe)) continue;
    const float c = random.next(), e = random.next();
    const Bsdf::Sample s = at.bsdf.sample(lobe, at.view, at.color, c, e);
    if (!(largest(s.weight) > 0)) continue;
    const Vec3f d = at.frame.world(s.light.x, s.light.y, s.light.z);
    offer(choices[static_cast<std::size_t>(lobe % rays)], d, s.light, sky->radiance(d), sky->density(d));
  }
  Vec3f sum;
  for (const Choice& choice : choices)
    if (choice.all > 0)
      sum +=
          choice.chosen * (choice.all / choice.of_chosen) *
          transmitted(at.p + at.face * geometry_.epsilon(), choice.direction, choice.direction, r.media, 1e9f, false);
  return sum;
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
    PassedGrains passed;
    const Hit hit = cast_visible(geometry_, o, d, media, reach, &passed);
    share *= passed.left;
    if (hit.kind == Kind::none || largest(share) < 1e-3f) return share;
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
      share = share * geometry_.left(media.top(), o, d, hit.t);
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

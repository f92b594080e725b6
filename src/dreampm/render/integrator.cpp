#include "dreampm/render/integrator.h"

#include <array>

#include "dreampm/render/color.h"
#include "dreampm/render/wood.h"

namespace dreampm::trace {
namespace {

constexpr int most_bounces = 15, most_bounces_physical = 48;
/// Below this weight paths go on by lot.
constexpr float weak = 0.02f;
/// A branch of weight w is followed with chance min(1, keep w): it never costs more than it shows.
constexpr float keep = 50;
/// Glow builds up at this rate [1/m].
constexpr float glow_rate = 0.8f;
/// A coat narrower than this mirrors the sun's disc; a wider one is lit by it directly.
constexpr float mirror_below = 0.01f;
const Vec3f bar_glow{0.08f, 0.16f, 0.144f};

/// A normal about `n` after Trowbridge and Reitz (GGX) of width alpha.
Vec3f rough_normal(const Vec3f& n, float alpha, float a, float b) {
  const float tan2 = alpha * alpha * a / std::max(1e-6f, 1 - a), c = 1 / std::sqrt(1 + tan2),
              s = std::sqrt(std::max(0.0f, 1 - c * c));
  const float phi = 2 * pi * b;
  return Frame(n).world(s * std::cos(phi), s * std::sin(phi), c);
}

/// A direction that a shading normal would send into the surface, bent back.
Vec3f leaving(const Vec3f& d, const Vec3f& face) {
  return dot(d, face) > 0 ? d : normalized(d - face * (2.02f * dot(d, face)));
}

/// What such a coat throws of a light of irradiance 1 (square to it): D F cos / (4 (h . l)^2),
/// after Kelemen.
float coat_highlight(const Vec3f& n, const Vec3f& view, const Vec3f& light, float alpha, float eta) {
  const float cos_light = dot(n, light);
  if (cos_light <= 0) return 0;
  const Vec3f h = normalized(view + light);
  const float c = dot(n, h), lh = std::max(0.05f, dot(light, h)), k = c * c * (alpha * alpha - 1) + 1;
  float cos_out;
  return fresnel(lh, eta, cos_out) * alpha * alpha / (pi * k * k) * cos_light / (4 * lh * lh);
}

}  // namespace

struct Integrator::Path {
  Vec3f o, d, weight{1, 1, 1};
  Media media;
  int bounces = 0;
  float distance = 0;
  bool sun_disc = true;
  bool polished = false;  ///< no further reflection in the floor's polish
};

struct Integrator::Stack {
  std::array<Path, 16> paths;
  std::size_t size = 0;
  bool room() const { return size < paths.size(); }
};

Vec3f Integrator::radiance(const Vec3f& o, const Vec3f& d, Sampler& random, float time) const {
  const int limit = options_.physical ? most_bounces_physical : most_bounces;
  const bool glows = options_.looks && !options_.physical;
  Stack stack;
  Path& first = stack.paths[stack.size++];
  first.o = o, first.d = d, first.media.time = time;
  first.sun_disc = options_.sun_disc;
  first.polished = !options_.looks;
  Vec3f sum;
  while (stack.size > 0) {
    Path r = stack.paths[--stack.size];
    for (bool alive = true; alive;) {
      const Hit hit = cast_visible(geometry_, r.o, r.d, r.media);
      if (hit.kind == Kind::none) {
        sum += r.weight * sky_.radiance(r.d, r.sun_disc);
        break;
      }
      r.distance += hit.t;
      const int medium = r.media.top();
      if (medium != air) {
        const auto& look = std::get<Dielectric>(geometry_.look(medium));
        if (glows) sum += r.weight * look.glow * (1 - std::exp(-glow_rate * hit.t));
        r.weight = r.weight * transmission(look.absorption, hit.t);
      }
      const Vec3f p = r.o + r.d * hit.t;
      if (hit.kind == Kind::floor) {
        alive = at_floor(r, p, random, sum);
      } else {
        if (++r.bounces > limit) {
          if (glows && medium != air) sum += r.weight * std::get<Dielectric>(geometry_.look(medium)).glow;
          break;
        }
        if (const float w = largest(r.weight); w < weak) {
          if (random.next() * weak >= w) break;
          r.weight *= weak / w;
        }
        if (hit.grain > 0)
          alive = at_grain(r, hit, p, random, sum, stack);
        else if (hit.kind != Kind::opaque)
          alive = at_clear(r, hit, p, random, sum, stack);
        else if (std::holds_alternative<Opaque>(geometry_.look(hit.object)))
          alive = at_opaque(r, hit, p, random, sum, stack);
        else
          alive = at_rough(r, hit, p, random, sum, stack);
      }
    }
  }
  return sum;
}

bool Integrator::at_floor(Path& r, const Vec3f& p, Sampler& random, Vec3f& sum) const {
  const float fade = pattern_.fade(p.x, p.z);
  const Vec3f far = sky_.radiance(normalized(Vec3f{r.d.x, 0, r.d.z}), false);
  const float footprint = r.distance * options_.pixel_angle / std::max(0.05f, -r.d.y);
  const Vec3f albedo = pattern_.albedo(p.x, p.z, footprint);
  if (options_.floor_light == nullptr) {
    sum += r.weight * far * fade;
    r.weight *= 1 - fade;
    if (++r.bounces > most_bounces) return false;
    const Vec3f up{0, 1, 0};
    return scatter_matte(r, p, up, up, albedo, sunlight(p, up, up, r.media, random), random, sum);
  }
  Vec3f c = mix(albedo * options_.floor_light->irradiance(p.x, p.z, ior(geometry_, r.media)) * (1 / pi), far, fade);
  if (r.polished || r.media.top() != air || r.distance > 12 * scale_) {
    sum += r.weight * c;
    return false;
  }
  const float polish = 0.8f * (0.04f + 0.6f * std::pow(1 + r.d.y, 5.0f)) * std::exp(-0.5f * r.distance / scale_);
  sum += r.weight * c * (1 - polish);
  r.weight *= polish;
  if (largest(r.weight) < 0.01f) return false;
  r.o = p + Vec3f{0, 10 * geometry_.epsilon(), 0};
  r.d = normalized(Vec3f{r.d.x, -r.d.y, r.d.z});
  r.bounces += 3;
  r.sun_disc = false, r.polished = true;
  return true;
}

bool Integrator::at_opaque(Path& r, const Hit& hit, const Vec3f& p, Sampler& random, Vec3f& sum, Stack& stack) const {
  const float roughness = std::get<Opaque>(geometry_.look(hit.object)).roughness;
  const Vec3f n = hit.back ? -hit.normal : hit.normal, face = hit.back ? -hit.geometric : hit.geometric;
  const SunSample sun = sunlight(p, n, face, r.media, random);
  if (roughness < 1) {
    const float alpha = std::max(1e-3f, roughness * roughness), eta = ior(geometry_, r.media) / 1.5f;
    const bool mirror = alpha < mirror_below;
    if (!mirror) sum += r.weight * sun.irradiance * coat_highlight(n, -r.d, sun.direction, alpha, eta);
    const float a = random.next(), b = random.next();
    const Vec3f m = rough_normal(n, alpha, a, b);
    const float c = -dot(m, r.d);
    Path coat = r;
    coat.o = p + face * geometry_.epsilon(), coat.d = normalized(r.d + m * (2 * c));
    coat.polished = true, coat.sun_disc = r.sun_disc && mirror;
    float share = 0, cos_out;
    // light that the microfacet sends into the surface comes back as matte
    if (c > 0 && dot(coat.d, face) > 0) share = fresnel(c, eta, cos_out);
    if (share > 0 && r.bounces <= options_.splits && stack.room()) {
      coat.weight *= share;
      const float chance = std::min(1.0f, keep * largest(coat.weight));
      if (random.next() < chance) {
        coat.weight *= 1 / chance;
        stack.paths[stack.size++] = coat;
      }
      r.weight *= 1 - share;
    } else if (share > 0) {
      const float chance = std::max(share, 0.25f);
      if (random.next() < chance) {
        coat.weight *= share / chance;
        r = coat;
        return true;
      }
      r.weight *= (1 - share) / (1 - chance);
    }
  }
  return scatter_matte(r, p, n, face, hit.color, sun, random, sum);
}

bool Integrator::at_rough(Path& r, const Hit& hit, const Vec3f& p, Sampler& random, Vec3f& sum, Stack& stack) const {
  const RoughSurface& surface = surfaces_.at(hit.object, r.media.top());
  const Vec3f n = hit.back ? -hit.normal : hit.normal, face = hit.back ? -hit.geometric : hit.geometric;
  const Frame frame(n);
  Vec3f color = hit.color;
  if (const auto* wood = std::get_if<Wood>(&geometry_.look(hit.object))) {
    const float slant = std::max(0.1f, std::fabs(dot(face, r.d)));
    color = wood_color(*wood, geometry_.frame(hit.object), p - hit.moved, r.distance * options_.pixel_angle / slant);
  }
  const Vec3f view = frame.local(-r.d);
  if (const SunSample sun = sunlight(p, n, face, r.media, random); largest(sun.irradiance) > 0)
    sum += r.weight * sun.irradiance * surface.scattered(view, frame.local(sun.direction), color);
  const float a = random.next(), b = random.next();
  const RoughSurface::Sample gloss = surface.sample_gloss(view, color, a, b);
  const bool reflects = largest(gloss.weight) > 0;
  Path coat = r;
  coat.polished = true, coat.sun_disc = r.sun_disc && surface.mirror();
  coat.o = p + face * geometry_.epsilon();
  if (reflects) coat.d = leaving(frame.world(gloss.light.x, gloss.light.y, gloss.light.z), face);
  coat.weight = r.weight * gloss.weight;
  if (!surface.has_base()) {
    r = coat;
    return reflects;
  }
  if (r.bounces <= options_.splits && stack.room()) {
    const float chance = std::min(1.0f, keep * largest(coat.weight));
    if (random.next() < chance) {
      coat.weight *= 1 / chance;
      stack.paths[stack.size++] = coat;
    }
  } else {
    const float chance = std::clamp(surface.gloss_share(view.z), 0.1f, 0.9f);
    if (random.next() < chance) {
      coat.weight *= 1 / chance;
      r = coat;
      return reflects;
    }
    r.weight *= 1 / (1 - chance);
  }
  const float c = random.next(), d = random.next();
  const Vec3f light = cosine_direction(frame, c, d);
  r.weight = r.weight * surface.base_weight(view, frame.local(light), color);
  r.o = coat.o, r.d = leaving(light, face);
  r.sun_disc = false, r.polished = true;
  return true;
}

bool Integrator::scatter_matte(Path& r, const Vec3f& p, const Vec3f& n, const Vec3f& face, const Vec3f& albedo,
                               const SunSample& sun, Sampler& random, Vec3f& sum) const {
  r.weight = r.weight * albedo;
  sum += r.weight * sun.irradiance * (std::max(0.0f, dot(n, sun.direction)) / pi);
  const float a = random.next(), b = random.next();
  r.d = cosine_direction(Frame(n), a, b);
  r.d = leaving(r.d, face);
  r.o = p + face * geometry_.epsilon();
  r.sun_disc = false, r.polished = true;
  return true;
}

// What a grain covers scatters, and the rest goes on: both ways are followed, so that a grain
// smaller than a pixel is a share of it and no noise.
bool Integrator::at_grain(Path& r, const Hit& hit, const Vec3f& p, Sampler& random, Vec3f& sum, Stack& stack) const {
  --r.bounces;  // passing is no bounce
  Path passed = r;
  passed.o = p + r.d * geometry_.epsilon();
  passed.weight *= 1 - hit.opacity;
  r.weight *= hit.opacity;
  if (hit.opacity < 1) {
    const bool both = r.bounces <= options_.splits && stack.room();
    const float chance = both ? std::min(1.0f, keep * largest(r.weight)) : std::clamp(hit.opacity, 0.1f, 0.9f);
    if (both) stack.paths[stack.size++] = passed;
    if (random.next() >= chance) {
      if (both) return false;
      r = passed;
      r.weight *= 1 / (1 - chance);
      return true;
    }
    r.weight *= 1 / chance;
  }
  ++r.bounces;
  const Vec3f off = (p - hit.center) / hit.grain;
  const float out = std::sqrt(std::max(0.0f, 1 - dot(off, off)));
  const Vec3f n = normalized(off - r.d * out), view = -r.d;
  r.weight = r.weight * hit.color;
  // Half of the light comes back as from a matte ball, and half goes through as if from its other
  // side: foam against the sun is bright. The sun on a whole matte ball is seen at the phase angle
  // between sun and view (Schoenberg 1929).
  if (sky_.has_sun()) {
    const SunSample sun = sunlight(hit.center, sky_.sun_direction(), sky_.sun_direction(), r.media, random, hit.grain);
    const float c = std::clamp(dot(view, sun.direction), -1.0f, 1.0f), phase = std::acos(c);
    const float both_sides = 2 * std::sqrt(1 - c * c) + (pi - 2 * phase) * c;
    sum += r.weight * sun.irradiance * (both_sides / (3 * pi * pi));
  }
  const Vec3f side = random.next() < 0.5f ? n : -n;
  const float a = random.next(), b = random.next();
  r.d = cosine_direction(Frame(side), a, b);
  r.o = hit.center + side * (hit.grain + geometry_.epsilon());
  r.sun_disc = false, r.polished = true;
  return true;
}

// Along the straight line to the sun; in a medium along the line that a level surface would bend,
// which is right on the average but draws no caustics on bodies.
Integrator::SunSample Integrator::sunlight(const Vec3f& p, const Vec3f& n, const Vec3f& face, const Media& media,
                                           Sampler& random, float away) const {
  if (!sky_.has_sun()) return {};
  const float a = random.next(), b = random.next();
  const Vec3f to_sun = sky_.sample_sun(a, b);
  SunSample s{to_sun, {}};
  float gain = 1;
  if (media.top() != air) {
    const float eta = ior(geometry_, media), y = std::sqrt(1 - (1 - to_sun.y * to_sun.y) / (eta * eta));
    s.direction = {to_sun.x / eta, y, to_sun.z / eta};
    gain = to_sun.y / (y * eta * eta);
  }
  if (dot(n, s.direction) > 0 && dot(face, s.direction) > 0)
    s.irradiance = transmitted_sun(p + face * (away + geometry_.epsilon()), s.direction, to_sun, media) *
                   sky_.sun_irradiance() * gain;
  return s;
}

Vec3f Integrator::transmitted_sun(Vec3f o, Vec3f d, const Vec3f& to_sun, Media media) const {
  Vec3f share{1, 1, 1};
  for (int step = 0; step < 24; ++step) {
    const Hit hit = cast_visible(geometry_, o, d, media);
    if (hit.kind == Kind::none) return share;
    const Vec3f p = o + d * hit.t;
    if (hit.grain > 0) {
      share *= 1 - hit.opacity;
      if (largest(share) < 1e-3f) return {};
      o = p + d * geometry_.epsilon();
      continue;
    }
    if (hit.kind == Kind::opaque || hit.kind == Kind::floor) return {};
    if (hit.kind == Kind::dielectric) {
      const int medium = media.top();
      if (medium != air) share = share * transmission(std::get<Dielectric>(geometry_.look(medium)).absorption, hit.t);
      const float before = ior(geometry_, media);
      media = across(geometry_, hit, media);
      if (media.top() == air) d = to_sun;
      const float after = ior(geometry_, media);
      float cos_out;
      share *= 1 - fresnel(std::min(1.0f, std::fabs(dot(hit.normal, to_sun))),
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

bool Integrator::at_clear(Path& r, const Hit& hit, const Vec3f& p, Sampler& random, Vec3f& sum, Stack& stack) const {
  if (hit.kind == Kind::bar) {
    if (hit.back) {
      r.o = p + r.d * geometry_.epsilon();
      --r.bounces;
      return true;
    }
    if (options_.looks && !options_.physical) sum += r.weight * bar_glow;
  }
  const Split s = split_light(geometry_, hit, r.d, r.media);
  Path reflected = r, passed = r;
  reflected.o = p + s.side * geometry_.epsilon(), reflected.d = s.reflected;
  passed.o = p - s.side * geometry_.epsilon(), passed.d = s.refracted, passed.media = s.refracted_media;
  reflected.weight *= s.reflectance;
  passed.weight = passed.weight * s.tint * (1 - s.reflectance);
  if (s.reflectance >= 0.9999f) {
    r = reflected;
    r.weight *= 1 / s.reflectance;
    return true;
  }
  if (r.bounces <= options_.splits && stack.room()) {
    const float chance = std::min(1.0f, keep * largest(reflected.weight));
    if (random.next() < chance) {
      reflected.weight *= 1 / chance;
      ++reflected.bounces;
      stack.paths[stack.size++] = reflected;
    }
    const float go_on = std::min(1.0f, keep * largest(passed.weight));
    if (random.next() >= go_on) return false;
    r = passed;
    r.weight *= 1 / go_on;
    return true;
  }
  const float chance = std::clamp(s.reflectance, 0.05f, 0.95f);
  if (random.next() < chance) {
    r = reflected;
    r.weight *= 1 / chance;
  } else {
    r = passed;
    r.weight *= 1 / (1 - chance);
  }
  return true;
}

}  // namespace dreampm::trace

#include "dreampm/render/integrator.h"

#include "dreampm/render/path.h"

namespace dreampm::trace {
namespace {

constexpr int most_bounces = 15, most_bounces_physical = 48;
/// A branch of weight w is followed with chance min(1, keep w): it never costs more than it shows.
constexpr float keep = 50;
/// Glow builds up at this rate [1/m].
constexpr float glow_rate = 0.8f;
const Vec3f bar_glow{0.08f, 0.16f, 0.144f};

/// A direction that a shading normal would send into the surface, bent back.
Vec3f leaving(const Vec3f& d, const Vec3f& face) {
  return dot(d, face) > 0 ? d : normalized(d - face * (2.02f * dot(d, face)));
}

}  // namespace

Vec3f Integrator::radiance(const Vec3f& o, const Vec3f& d, Sampler& random, float time) const {
  PathStack stack;
  Path& first = stack.paths[stack.size++];
  first.o = o, first.d = d, first.media.time = time;
  first.sun_disc = options_.sun_disc;
  first.polished = !options_.looks;
  Vec3f sum;
  follow(stack, random, sum);
  return sum;
}

void Integrator::follow(PathStack& stack, Sampler& random, Vec3f& sum) const {
  while (stack.size > 0) {
    Path r = stack.paths[--stack.size];
    while (step(r, random, sum, stack)) {
    }
  }
}

Vec3f Integrator::arriving(const Vec3f& p, const Vec3f& n, Sampler& random, float time) const {
  PathStack stack;
  Path r;
  r.media.time = time;
  r.sun_disc = false;
  const Shading white{p, n, n, Frame(n), {0, 0, 1}, {1, 1, 1}, matte_};
  Vec3f sum = lit(r, white, random);
  if (bounce(r, white, random, stack)) {
    stack.paths[stack.size++] = r;
    follow(stack, random, sum);
  }
  return sum * pi;
}

/// Radiance of what lies beyond all surfaces.
Vec3f Integrator::beyond(const Path& r) const {
  if (r.sky_counted && sky_.aimed_at() != nullptr) return {};
  const Vec3f sky = sky_.radiance(r.d, r.sun_disc);
  if (!r.gathered || options_.photons == nullptr || sky_.bright_parts() == nullptr) return sky;
  return max(Vec3f{}, sky - sky_.bright_parts()->radiance(r.d));
}

/// To the next surface, or the next place in cloudy matter that scatters. False: the path ends.
bool Integrator::step(Path& r, Sampler& random, Vec3f& sum, PathStack& stack) const {
  const bool glows = options_.looks && !options_.physical;
  const Interior* const before = geometry_.interior(r.media.top());
  const bool cloudy = before != nullptr && before->scatters;
  FreePath free;
  if (cloudy) free = free_path(r, *before, random);
  if (cloudy && free.length < r.clear) return scatter(r, *before, free, random, sum);
  // Grains are met by lot: to follow both what one covers and the rest would cost a path each.
  PassedGrains grains;
  if (geometry_.has_grains()) grains.lot = 1 | static_cast<std::uint32_t>(random.next() * 0x1p32f);
  const Hit hit = cast_visible(geometry_, r.o, r.d, r.media, free.length, geometry_.has_grains() ? &grains : nullptr);
  if (cloudy && hit.kind == Kind::none) return scatter(r, *before, free, random, sum);
  r.clear = 0;
  if (options_.lamps != nullptr && r.sun_disc)
    if (const Vec3f* lamp = options_.lamps->met(r.o, r.d, hit.t)) {
      sum += r.weight * *lamp;
      return false;
    }
  if (hit.kind == Kind::none) {
    sum += r.weight * beyond(r);
    return false;
  }
  r.distance += hit.t;
  const Interior* const in = geometry_.interior(r.media.top());
  if (cloudy) {
    const Vec3f left = transmission(before->extinction, hit.t);
    r.weight = r.weight * left * (1 / std::max(1e-30f, dot(free.share, left)));
  } else if (in != nullptr) {
    const Vec3f left = geometry_.left(r.media.top(), r.o, r.d, hit.t);
    if (glows) sum += r.weight * geometry_.glow(r.media.top(), left, hit.t) * (1 - std::exp(-glow_rate * hit.t));
    r.weight = r.weight * left;
  }
  const Vec3f p = r.o + r.d * hit.t;
  if (hit.kind == Kind::floor) return at_floor(r, p, random, sum, stack);
  if (++r.bounces > (options_.physical ? most_bounces_physical : most_bounces)) {
    if (glows && in != nullptr) sum += r.weight * in->glow;
    return false;
  }
  if (const float w = largest(r.weight); w < weak) {
    if (random.next() * weak >= w) return false;
    r.weight *= weak / w;
  }
  if (hit.grain > 0) return at_grain(r, hit, p, random, sum);
  if (hit.kind != Kind::opaque) return at_clear(r, hit, p, random, sum, stack);
  return at_surface(r, hit, p, random, sum, stack);
}

bool Integrator::at_floor(Path& r, const Vec3f& p, Sampler& random, Vec3f& sum, PathStack& stack) const {
  const float fade = pattern_.fade(p.x, p.z);
  const Vec3f far = sky_.radiance(normalized(Vec3f{r.d.x, 0, r.d.z}), false);
  const float footprint = r.distance * options_.pixel_angle / std::max(0.05f, -r.d.y);
  const Vec3f albedo = pattern_.albedo(p.x, p.z, footprint);
  if (options_.floor_light == nullptr && options_.paper_light != nullptr) {
    sum += r.weight * mix(albedo * options_.paper_light->irradiance(p, r.media.top() == air) * (1 / pi), far, fade);
    return false;
  }
  if (options_.floor_light == nullptr) {
    sum += r.weight * far * fade;
    r.weight *= 1 - fade;
    if (++r.bounces > most_bounces) return false;
    const Vec3f up{0, 1, 0};
    const Frame frame(up);
    const Shading at{p, up, up, frame, frame.local(-r.d), albedo, matte_};
    sum += r.weight * lit(r, at, random);
    return bounce(r, at, random, stack);
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

bool Integrator::at_surface(Path& r, const Hit& hit, const Vec3f& p, Sampler& random, Vec3f& sum,
                            PathStack& stack) const {
  const Vec3f n = hit.back ? -hit.normal : hit.normal, face = hit.back ? -hit.geometric : hit.geometric;
  if (options_.paper_light != nullptr && hit.object == options_.paper) {
    sum += r.weight * studio_paper * options_.paper_light->irradiance(p, r.media.top() == air) * (1 / pi);
    return false;
  }
  const Frame frame(n);
  const float slant = std::max(0.1f, std::fabs(dot(face, r.d)));
  const Vec3f color =
      geometry_.look(hit.object)
          .color_at({p - hit.moved, hit.color, geometry_.frame(hit.object), r.distance * options_.pixel_angle / slant});
  const Shading at{p, n, face, frame, frame.local(-r.d), color, surfaces_.at(hit.object, r.media.top())};
  sum += r.weight * lit(r, at, random);
  return bounce(r, at, random, stack);
}

/// Follows the lobes of a surface: all of them early on, later one by lot.
bool Integrator::bounce(Path& r, const Shading& at, Sampler& random, PathStack& stack) const {
  const Path before = r;
  r.polished = true;
  r.o = at.p + at.face * geometry_.epsilon();
  const auto along = [&](int lobe, Path& path) {
    const float a = random.next(), b = random.next();
    const Bsdf::Sample s = at.bsdf.sample(lobe, at.view, at.color, a, b);
    path.weight = path.weight * s.weight;
    path.d = leaving(at.frame.world(s.light.x, s.light.y, s.light.z), at.face);
    path.sun_disc = before.sun_disc && at.bsdf.mirror(lobe);
    path.gathered = path.sky_counted = !at.bsdf.mirror(lobe);
    return largest(s.weight) > 0;
  };
  int lobe = 0;
  for (; lobe + 1 < at.bsdf.lobes(); ++lobe) {
    Path branch = r;
    const bool goes_on = along(lobe, branch);
    if (r.bounces <= options_.splits && stack.room()) {
      const float chance = std::min(1.0f, keep * largest(branch.weight));
      if (random.next() < chance) {
        branch.weight *= 1 / chance;
        stack.paths[stack.size++] = branch;
      }
      continue;
    }
    const float chance = std::clamp(at.bsdf.share(lobe, at.view.z), 0.1f, 0.9f);
    if (random.next() < chance) {
      branch.weight *= 1 / chance;
      r = branch;
      return goes_on;
    }
    r.weight *= 1 / (1 - chance);
  }
  return along(lobe, r);
}

bool Integrator::at_grain(Path& r, const Hit& hit, const Vec3f& p, Sampler& random, Vec3f& sum) const {
  const Vec3f off = (p - hit.center) / hit.grain;
  const float out = std::sqrt(std::max(0.0f, 1 - dot(off, off)));
  const Vec3f n = normalized(off - r.d * out), view = -r.d;
  r.weight = r.weight * hit.color;
  // Half of the light comes back as from a matte ball, and half goes through as if from its other
  // side: foam against the sun is bright. A light on a whole matte ball is seen at the phase angle
  // between light and view (Schoenberg 1929).
  const auto lights = [&](const LightSample& light) {
    const float c = std::clamp(dot(view, light.direction), -1.0f, 1.0f), angle = std::acos(c);
    const float both_sides = 2 * std::sqrt(1 - c * c) + (pi - 2 * angle) * c;
    sum += r.weight * light.irradiance * (both_sides / (3 * pi * pi));
  };
  if (sky_.has_sun())
    lights(sunlight(hit.center, sky_.sun_direction(), sky_.sun_direction(), r.media, random, hit.grain));
  if (options_.lamps != nullptr) {
    LightSample lamp = options_.lamps->draw(hit.center, random);
    lamp.irradiance =
        lamp.irradiance * transmitted(hit.center + lamp.direction * (hit.grain + geometry_.epsilon()), lamp.direction,
                                      lamp.direction, r.media, lamp.distance - hit.grain, true);
    lights(lamp);
  }
  const Vec3f side = random.next() < 0.5f ? n : -n;
  const float a = random.next(), b = random.next();
  r.d = cosine_direction(Frame(side), a, b);
  r.o = hit.center + side * (hit.grain + geometry_.epsilon());
  r.bounces = std::max(r.bounces, options_.splits + 1);
  r.sun_disc = false, r.polished = true, r.gathered = r.sky_counted = false;
  return true;
}

bool Integrator::at_clear(Path& r, const Hit& hit, const Vec3f& p, Sampler& random, Vec3f& sum,
                          PathStack& stack) const {
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
  // Only glass of the basin lets light through straight, so that the sky lit the last surface
  // through it.
  reflected.sky_counted = false;
  if (hit.kind == Kind::dielectric) passed.sky_counted = false;
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

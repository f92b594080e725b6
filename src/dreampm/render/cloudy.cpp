// Matter that scatters light: a random walk through it, with the true faces of the matter around
// it, and light from the sun and the lamps at each step (Kajiya and Von Herzen 1984; Novak et al.
// 2018, "Monte Carlo methods for volumetric light transport simulation", 3.1 and 4).
#include "dreampm/render/integrator.h"
#include "dreampm/render/path.h"
#include "dreampm/render/phase.h"

namespace dreampm::trace {
namespace {

/// Steps of one path.
constexpr int most_scatterings = 4096;

/// The steps after which a path asks how far the surfaces are.
constexpr int look_around = 8;
/// Light that starts this many mean free paths within a ball leaves it as diffusion says.
constexpr float diffuse_depth = 8;

/// The chances with which channels choose a free path: as much as each still carries.
Vec3f shares_of(const Vec3f& weight) {
  const float sum = weight.x + weight.y + weight.z;
  return sum > 0 ? weight / sum : Vec3f{1, 1, 1} / 3.0f;
}

/// The free path that a channel draws.
float draw_length(const Vec3f& share, const Vec3f& extinction, Sampler& random) {
  const float channel = random.next(), a = random.next();
  const float sigma = channel < share.x ? extinction.x : channel < share.x + share.y ? extinction.y : extinction.z;
  return sigma > 0 ? std::min(1e9f, -std::log(1 - a) / sigma) : 1e9f;
}

}  // namespace

FreePath Integrator::free_path(const Path& r, const Interior& in, Sampler& random) const {
  FreePath free;
  free.share = shares_of(r.weight);
  free.length = draw_length(free.share, in.extinction, random);
  return free;
}

/// The channels share the path by the balance heuristic.
bool Integrator::scatter(Path& r, const Interior& in, const FreePath& free, Sampler& random, Vec3f& sum) const {
  if (++r.scatterings > most_scatterings) return false;
  const Vec3f left = transmission(in.extinction, free.length);
  const float density = dot(free.share, in.extinction * left);
  if (!(density > 0)) return false;
  r.weight = r.weight * in.scattering * left * (1 / density);
  if (const float w = largest(r.weight); w < weak) {
    if (random.next() * weak >= w) return false;
    r.weight *= weak / w;
  }
  r.o = r.o + r.d * free.length;
  r.distance += free.length;
  r.clear = std::max(0.0f, r.clear - free.length);
  if (r.scatterings % look_around == 0) leap(r, in, random);
  if (sky_.has_sun()) {
    const float a = random.next(), b = random.next();
    sum += r.weight * lit_within(r, in, {sky_.sample_sun(a, b), 1e9f, sky_.sun_irradiance()}, random);
  }
  if (options_.lamps != nullptr) sum += r.weight * lit_within(r, in, options_.lamps->draw(r.o, random), random);
  const float a = random.next(), b = random.next();
  r.d = sample_phase(r.d, in.anisotropy, a, b);
  r.sun_disc = false, r.polished = true, r.gathered = r.sky_counted = false;
  r.bounces = std::max(r.bounces, options_.splits + 1);
  return true;
}

// From the middle of a ball that is large beside the mean free path light diffuses to its surface,
// evenly by symmetry, and what is not absorbed on the way is x/sinh x with x = R sqrt(3 sigma_a
// (sigma_a + sigma_s')): walk on spheres (Muller 1956; with absorption, Elepov and Mikhailov 1969).
// Sunlight that has not scattered yet does not come so deep.
void Integrator::leap(Path& r, const Interior& in, Sampler& random) const {
  const Vec3f reduced = in.scattering * (1 - in.anisotropy) + in.absorption;
  const float least = std::min({reduced.x, reduced.y, reduced.z});
  if (!(least > 0)) return;
  const float worth = diffuse_depth / least;
  if (r.clear < worth) r.clear = geometry_.clearance(r.o, 64 * worth);
  if (r.clear < worth) return;
  const auto left = [&](float absorbed, float all) {
    const float x = r.clear * std::sqrt(3 * absorbed * all);
    return x < 1e-3f ? 1 : x > 60 ? 0 : x / std::sinh(x);
  };
  r.weight = r.weight * Vec3f{left(in.absorption.x, reduced.x), left(in.absorption.y, reduced.y),
                              left(in.absorption.z, reduced.z)};
  const float a = random.next(), b = random.next();
  r.d = sample_phase({0, 1, 0}, 0, a, b);
  r.o = r.o + r.d * r.clear;
  r.clear = 0;
}

// The line from a light bends at the face where it comes in. That face is looked for along the
// straight line, no further than a free path; the light's line is then the one that a flat face
// there would bend. Flat faces get it exactly; a curved one gathers or spreads no light.
Vec3f Integrator::lit_within(const Path& r, const Interior& in, const LightSample& light, Sampler& random) const {
  const Vec3f share = shares_of(r.weight);
  const float reach = draw_length(share, in.extinction, random);
  if (reach < r.clear) return {};
  Media media = r.media;
  const Hit face = cast_visible(geometry_, r.o, light.direction, media, std::min(reach, light.distance));
  if (face.kind != Kind::dielectric || !face.back) return {};
  const float cos_in = dot(face.normal, light.direction), n = in.ior;
  if (cos_in <= 0) return {};
  const float cos_within = std::sqrt(std::max(0.0f, 1 - (1 - cos_in * cos_in) / (n * n)));
  const Vec3f d = normalized(light.direction / n + face.normal * (cos_within - cos_in / n));
  // What of the lot found the face, and the narrower beam; paths count radiance over n^2.
  const float found = dot(share, transmission(in.extinction, face.t)), gain = cos_in / (cos_within * n * n);
  if (!(found > 0)) return {};
  return light.irradiance * transmitted(r.o, d, light.direction, r.media, light.distance, true) *
         (gain * phase(dot(r.d, d), in.anisotropy) / found);
}

}  // namespace dreampm::trace

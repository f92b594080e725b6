#include "dreampm/render/photons.h"

#include "dreampm/base/parallel.h"

namespace dreampm::trace {
namespace {

constexpr std::size_t parts = 16;  // fixed, so that the order does not depend on the threads
/// On a surface that faces an unhindered light, as many photons lie within the filter's radius.
constexpr float in_radius = 32;
/// The same of light from wide parts of the sky, whose caustics are soft.
constexpr float in_radius_soft = 48;

}  // namespace

/// The light of one lamp, of the sun, or of the bright parts of the sky, towards a ball.
struct PhotonMap::Beam {
  Vec3f target;  ///< m, the ball's middle
  float radius;  ///< m, of the ball
  const Sky* sun = nullptr;
  const Lamp* lamp = nullptr;
  const Environment* bright = nullptr;

  struct Start {
    Vec3f origin, direction, power;  ///< power: of one of N, times N
  };
  /// c, d: even over the ball as seen from the light.
  Start start(float c, float d, Sampler& random) const {
    const float a = random.next(), b = random.next();
    if (sun != nullptr) {
      const Vec3f to_sun = sun->sample_sun(a, b);
      const float r = radius * std::sqrt(c), phi = 2 * pi * d;
      const Vec3f across = Frame(to_sun).world(r * std::cos(phi), r * std::sin(phi), 0);
      return {target + across + to_sun * (2 * radius), -to_sun, sun->sun_irradiance() * (pi * radius * radius)};
    }
    if (bright != nullptr) {
      const Environment::Drawn drawn = bright->draw(a, b);
      if (!(drawn.density > 0)) return {};
      const float r = radius * std::sqrt(c), phi = 2 * pi * d;
      const Vec3f across = Frame(drawn.direction).world(r * std::cos(phi), r * std::sin(phi), 0);
      return {target + across + drawn.direction * (2 * radius), -drawn.direction,
              drawn.radiance * (pi * radius * radius / drawn.density)};
    }
    // From a disc that faces the ball, within the cone of the ball as seen from its middle.
    const Vec3f to = target - lamp->center;
    const float far = length(to), s2 = std::min(0.99f, radius * radius / (far * far)),
                angle = 2 * pi * (1 - std::sqrt(1 - s2));
    const float cos_off = 1 - c * angle / (2 * pi), sin_off = std::sqrt(std::max(0.0f, 1 - cos_off * cos_off)),
                phi = 2 * pi * d, r = lamp->radius * std::sqrt(a);
    const Vec3f direction = Frame(to / far).world(sin_off * std::cos(phi), sin_off * std::sin(phi), cos_off);
    const Vec3f on_disc = Frame(direction).world(r * std::cos(2 * pi * b), r * std::sin(2 * pi * b), 0);
    return {lamp->center + on_disc, direction, lamp->radiance * (pi * lamp->radius * lamp->radius * angle)};
  }
  /// m^2, where the ball is.
  float area() const { return pi * radius * radius; }
};

PhotonMap::PhotonMap(const Geometry& geometry, const Sky& sky, const Lamps& lamps, const Box3f& clear, bool on_floor,
                     int photons, std::uint64_t seed) {
  Beam beam{clear.center(), 0.5f * length(clear.size())};
  const bool soft = sky.bright_parts() != nullptr;
  if (soft) photons /= 2;
  radius_ = std::max(20 * geometry.epsilon(),
                     std::sqrt((soft ? in_radius_soft : in_radius) * beam.area() / (pi * static_cast<float>(photons))));
  std::uint32_t pass = 3;
  if (sky.has_sun()) {
    beam.sun = &sky;
    follow(geometry, beam, on_floor, photons, seed, pass++);
    beam.sun = nullptr;
  }
  if (soft) {
    beam.bright = sky.bright_parts();
    follow(geometry, beam, on_floor, photons, seed, pass++);
    beam.bright = nullptr;
  }
  for (const Lamp& lamp : lamps.all()) {
    beam.lamp = &lamp;
    follow(geometry, beam, on_floor, photons / static_cast<int>(lamps.all().size()), seed, pass++);
  }
  sort();
}

void PhotonMap::follow(const Geometry& geometry, const Beam& beam, bool on_floor, int photons, std::uint64_t seed,
                       std::uint32_t pass) {
  std::array<std::vector<Landed>, parts> landed;
  parallel_for(parts, 1, [&](std::size_t part) {
    for (auto k = static_cast<std::uint32_t>(part); k < static_cast<std::uint32_t>(photons); k += parts) {
      Sampler random(stream_of(seed, pass, k), 0);
      // on a lattice of rank 1 (golden ratio), which a disc winds up to a spiral
      const Beam::Start start =
          beam.start((static_cast<float>(k) + 0.5f) / static_cast<float>(photons), unit_float(k * 2654435769u), random);
      const float time = geometry.moves() ? random.next() : 0.5f;
      follow_photon(geometry, start.origin, start.direction, time, true,
                    [&](const Hit& hit, const Vec3f& p, const Vec3f& d, const Vec3f& weight, bool bent) {
                      if (!bent || (hit.kind == Kind::floor && !on_floor)) return;
                      Vec3f n = hit.geometric;
                      if (dot(n, d) > 0) n = -n;
                      landed[part].push_back({p, n, d, start.power * weight * (1 / static_cast<float>(photons))});
                    });
    }
  });
  for (const auto& of_part : landed) photons_.insert(photons_.end(), of_part.begin(), of_part.end());
}

void PhotonMap::sort() {
  std::size_t buckets = 1024;
  while (buckets < photons_.size()) buckets *= 2;
  first_.assign(buckets + 1, 0);
  std::vector<std::uint32_t> bucket(photons_.size());
  for (std::size_t i = 0; i < photons_.size(); ++i) {
    bucket[i] = static_cast<std::uint32_t>(bucket_of(cell_of(photons_[i].position)));
    ++first_[bucket[i] + 1];
  }
  for (std::size_t b = 0; b < buckets; ++b) first_[b + 1] += first_[b];
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  std::vector<Landed> sorted(photons_.size());
  for (std::size_t i = 0; i < photons_.size(); ++i) sorted[next[bucket[i]]++] = photons_[i];
  photons_ = std::move(sorted);
}

}  // namespace dreampm::trace

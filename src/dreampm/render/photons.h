// Photons: light that is followed from a light, where paths from the camera would hardly find it.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "dreampm/render/color.h"
#include "dreampm/render/interface.h"
#include "dreampm/render/lamps.h"
#include "dreampm/render/sky.h"

namespace dreampm::trace {

/// Photons weaker than this are dropped.
inline constexpr float weakest_photon = 0.02f;

/// Follows light from `origin` through clear matter, both ways at each of its faces, to the matte
/// surfaces and the floor, where it ends: land(hit, point, direction, weight, bent), `bent` where a
/// straight line would not have led there. `time`: through the exposure, 0 to 1. `bend` false:
/// straight on, only dimmed.
template <class Land>
void follow_photon(const Geometry& geometry, const Vec3f& origin, const Vec3f& direction, float time, bool bend,
                   Land&& land) {
  struct Photon {
    Vec3f o, d, weight;
    Media media;
    int bounces;
    bool bent;
  };
  std::array<Photon, 24> stack;
  std::size_t n = 0;
  Photon& first = stack[n++] = {origin, direction, {1, 1, 1}, {}, 0, false};
  first.media.time = time;
  while (n > 0) {
    Photon r = stack[--n];
    for (; r.bounces < 12; ++r.bounces) {
      PassedGrains passed;
      const Hit hit = cast_visible(geometry, r.o, r.d, r.media, 1e9f, &passed);
      r.weight *= passed.left;
      if (hit.grain > 0) {  // what it does not cover goes on
        r.weight *= 1 - hit.opacity;
        if (largest(r.weight) < weakest_photon) break;
        r.o = r.o + r.d * (hit.t + geometry.epsilon()), --r.bounces;
        continue;
      }
      if (hit.kind == Kind::none) break;
      r.weight = r.weight * geometry.left(r.media.top(), r.o, r.d, hit.t);
      const Vec3f p = r.o + r.d * hit.t;
      if (hit.kind == Kind::floor || hit.kind == Kind::opaque) {
        land(hit, p, r.d, r.weight, r.bent);
        break;
      }
      if (largest(r.weight) < weakest_photon) break;
      if (hit.kind == Kind::bar) {
        if (!hit.back) r.weight = r.weight * bar_shade;
        r.o = p;
        continue;
      }
      const Split s = split_light(geometry, hit, r.d, r.media);
      const Vec3f above = p + s.side * geometry.epsilon(), below = p - s.side * geometry.epsilon();
      if (s.reflectance >= 0.999f && bend) {
        r.o = above, r.d = s.reflected, r.bent = true;
        continue;
      }
      if (bend && s.reflectance * largest(r.weight) > weakest_photon && n < stack.size())
        stack[n++] = {above, s.reflected, r.weight * s.reflectance, r.media, r.bounces + 1, true};
      // straight on, a ray that would be reflected totally is dimmed as one that enters
      const float lost = s.reflectance >= 0.999f ? 0.06f : s.reflectance;
      r.weight = r.weight * s.tint * (1 - lost);
      r.o = below, r.media = s.refracted_media;
      if (bend) r.d = s.refracted;
      r.bent = r.bent || hit.kind == Kind::dielectric;
    }
  }
}

/// Where light ends that clear matter has bent: caustics (Jensen 1996, "Global illumination using
/// photon maps"). It holds what arrives through clear matter alone; the rest is sampled directly.
class PhotonMap {
 public:
  /// Follows about `photons` from each of the sun and the lamps, towards the box around all clear
  /// matter. `on_floor`: those on the floor are kept, too.
  PhotonMap(const Geometry& geometry, const Sky& sky, const Lamps& lamps, const Box3f& clear, bool on_floor,
            int photons, std::uint64_t seed);
  /// Calls each(direction, irradiance) for the photons about the point p of a surface: where they
  /// come from, and their share of its irradiance, by a cone filter.
  template <class Each>
  void at(const Vec3f& p, const Vec3f& n, Each&& each) const {
    if (photons_.empty()) return;
    const Cell middle = cell_of(p);
    for (int j = -1; j <= 1; ++j)
      for (int k = -1; k <= 1; ++k)
        for (int i = -1; i <= 1; ++i) {
          const Cell cell{middle[0] + i, middle[1] + j, middle[2] + k};
          const std::size_t bucket = bucket_of(cell);
          for (std::uint32_t a = first_[bucket]; a < first_[bucket + 1]; ++a) {
            const Landed& photon = photons_[a];
            const Vec3f off = photon.position - p;
            const float far2 = length2(off);
            if (far2 >= radius_ * radius_ || dot(photon.normal, n) < 0.5f || cell_of(photon.position) != cell) continue;
            each(-photon.direction, photon.power * ((1 - std::sqrt(far2) / radius_) * 3 / (pi * radius_ * radius_)));
          }
        }
  }

 private:
  using Cell = std::array<int, 3>;
  struct Landed {
    Vec3f position, normal, direction, power;
  };
  struct Beam;
  void follow(const Geometry& geometry, const Beam& beam, bool on_floor, int photons, std::uint64_t seed,
              std::uint32_t pass);
  void sort();
  Cell cell_of(const Vec3f& p) const {
    const auto one = [&](float x) { return static_cast<int>(std::floor(x / radius_)); };
    return {one(p.x), one(p.y), one(p.z)};
  }
  std::size_t bucket_of(const Cell& c) const {
    const auto bits = [](int i) { return static_cast<std::uint32_t>(i); };
    // Cells along x are neighbors in memory, too.
    return (hash32(bits(c[1]) * 0xd8163841u ^ bits(c[2]) * 0xcb1ab31fu) + bits(c[0])) &
           (first_.size() - 2);  // a power of two, and one more
  }

  float radius_ = 1;             ///< m, of the filter
  std::vector<Landed> photons_;  ///< by bucket, within it in the order in which they were sent
  std::vector<std::uint32_t> first_;
};

}  // namespace dreampm::trace

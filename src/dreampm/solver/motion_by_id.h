// The motion of particles kept while their order changes.
#pragma once
#include <algorithm>
#include <span>
#include <utility>
#include <vector>

#include "dreampm/backend/motion.h"
#include "dreampm/base/parallel.h"
#include "dreampm/state/particle_view.h"
#include "dreampm/state/regroup.h"

namespace dreampm {

/// Adds the motion of particle `p` of `from`.
template <class Set>
void append(Set& to, const Set& from, std::size_t p) {
  to.velocity.push_back(from.velocity[p]);
  to.gradient.push_back(from.gradient[p]);
  to.energy.push_back(from.energy[p]);
  to.volume_ratio.push_back(from.volume_ratio[p]);
}

/// Remembers each particle's motion by its id. Particles may be sorted, removed and inserted
/// meanwhile.
template <class R>
class MotionById {
 public:
  /// Makes a motion of `sets` sets without particles.
  explicit MotionById(std::size_t sets) : place_(sets) { motion_.sets.resize(sets); }
  /// `motion`: in the order of the world's particles.
  MotionById(const World<R>& world, Motion<R> motion) : motion_(std::move(motion)), place_(world.sets.size()) {
    for (std::size_t s = 0; s < world.sets.size(); ++s) {
      const std::span<const std::uint32_t> ids = ParticleSetView<R>(world, s).ids();
      if (ids.empty()) continue;
      const std::uint32_t last = parallel_reduce(
          ids.size(), std::uint32_t{0}, [&](std::uint32_t& most, std::size_t p) { most = std::max(most, ids[p]); },
          [](std::uint32_t& most, std::uint32_t other) { most = std::max(most, other); });
      place_[s].resize(last + std::size_t{1});
      parallel_for(ids.size(), at_once, [&](std::size_t p) { place_[s][ids[p]] = static_cast<std::uint32_t>(p); });
    }
  }
  /// Adds matter that comes into set `s` at its rest state.
  void add(std::size_t s, std::span<const ParticleSeed> seeds) {
    auto& m = motion_.sets[s];
    const std::size_t first = m.velocity.size();
    resize(m, first + seeds.size());
    std::size_t last = 0;
    for (const ParticleSeed& seed : seeds) last = std::max<std::size_t>(last, seed.id);
    if (!seeds.empty() && last >= place_[s].size()) place_[s].resize(last + 1);
    parallel_for(seeds.size(), at_once, [&](std::size_t i) {
      place_[s][seeds[i].id] = static_cast<std::uint32_t>(first + i);
      m.velocity[first + i] = static_cast<Vec3<R>>(seeds[i].velocity);
      m.gradient[first + i] = static_cast<Mat3<R>>(seeds[i].gradient);
      m.energy[first + i] = R(0);
      m.volume_ratio[first + i] = R(1);
    });
  }
  /// Returns the motion in the present order of the particles, each of which must have been there.
  Motion<R> ordered(const World<R>& world) const {
    Motion<R> out;
    order(world, out);
    return out;
  }
  /// The same in memory that is there.
  void order(const World<R>& world, Motion<R>& out) const {
    out.sets.resize(world.sets.size());
    for (std::size_t s = 0; s < world.sets.size(); ++s) {
      const std::span<const std::uint32_t> ids = ParticleSetView<R>(world, s).ids();
      auto& to = out.sets[s];
      const auto& from = motion_.sets[s];
      resize(to, ids.size());
      parallel_for(ids.size(), at_once, [&](std::size_t i) {
        const std::uint32_t p = place_[s].at(ids[i]);
        to.velocity[i] = from.velocity[p], to.gradient[i] = from.gradient[p];
        to.energy[i] = from.energy[p], to.volume_ratio[i] = from.volume_ratio[p];
      });
    }
  }
  /// Gives back the motion that it was made of.
  Motion<R> release() && { return std::move(motion_); }

 private:
  static constexpr std::size_t at_once = 1 << 12;
  static void resize(typename Motion<R>::Set& m, std::size_t size) {
    m.velocity.resize(size), m.gradient.resize(size), m.energy.resize(size), m.volume_ratio.resize(size);
  }
  Motion<R> motion_;
  std::vector<std::vector<std::uint32_t>> place_;  ///< by set and id
};

/// The motion of matter just inserted: from the velocities of its seeds.
template <class R>
Motion<R> initial_velocities(const World<R>& world, const std::vector<std::vector<ParticleSeed>>& seeds) {
  MotionById<R> motion(world.sets.size());
  for (std::size_t s = 0; s < world.sets.size(); ++s) motion.add(s, seeds[s]);
  return motion.ordered(world);
}

}  // namespace dreampm

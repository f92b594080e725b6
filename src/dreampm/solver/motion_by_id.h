// The motion of particles kept while their order changes.
#pragma once
#include <span>
#include <vector>

#include "dreampm/backend/motion.h"
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
  /// Of no particle yet, in `sets` sets.
  explicit MotionById(std::size_t sets) : place_(sets) { motion_.sets.resize(sets); }
  /// `motion`: in the order of the world's particles.
  MotionById(const World<R>& world, const Motion<R>& motion) : motion_(motion), place_(world.sets.size()) {
    for (std::size_t s = 0; s < world.sets.size(); ++s) {
      const ParticleSetView<R> particles(world, s);
      for (std::size_t p = 0; p < particles.size(); ++p) remember(s, particles.id(p), p);
    }
  }
  /// Of matter that comes into set `s` at rest state.
  void add(std::size_t s, std::span<const ParticleSeed> seeds) {
    for (const ParticleSeed& seed : seeds) {
      auto& m = motion_.sets[s];
      remember(s, seed.id, m.velocity.size());
      m.velocity.push_back(static_cast<Vec3<R>>(seed.velocity));
      m.gradient.push_back(static_cast<Mat3<R>>(seed.gradient));
      m.energy.push_back(R(0));
      m.volume_ratio.push_back(R(1));
    }
  }
  /// In the order of the particles now, each of which must have been there.
  Motion<R> ordered(const World<R>& world) const {
    Motion<R> out;
    out.sets.resize(world.sets.size());
    for (std::size_t s = 0; s < world.sets.size(); ++s)
      for (const std::uint32_t id : ParticleSetView<R>(world, s).ids())
        append(out.sets[s], motion_.sets[s], place_[s].at(id));
    return out;
  }

 private:
  void remember(std::size_t s, std::uint32_t id, std::size_t p) {
    if (id >= place_[s].size()) place_[s].resize(id + std::size_t{1});
    place_[s][id] = static_cast<std::uint32_t>(p);
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

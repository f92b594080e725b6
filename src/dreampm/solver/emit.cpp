#include "dreampm/solver/emit.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "dreampm/base/hash.h"
#include "dreampm/state/particle_view.h"

namespace dreampm {
namespace {

/// The lattice of one emitter: planes of sites across its velocity, `spacing` apart.
class Lattice {
 public:
  Lattice(const Emitter& emitter, double spacing) : emitter_(emitter), spacing_(spacing) {
    speed_ = length(emitter.velocity);
    along_ = emitter.velocity / speed_;
    across_ = normalized(cross(along_, std::abs(along_.x) < 0.6 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0}));
    over_ = cross(along_, across_);
    const Box3d box = emitter.shape->bounds();
    middle_ = box.center();
    const Vec3d half = box.size() * 0.5;
    const auto reach = [&](const Vec3d& axis) {
      return std::abs(axis.x) * half.x + std::abs(axis.y) * half.y + std::abs(axis.z) * half.z;
    };
    depth_ = reach(along_);
    columns_ = static_cast<int>(std::ceil(reach(across_) / spacing)),
    rows_ = static_cast<int>(std::ceil(reach(over_) / spacing));
  }
  /// Calls body(place) for each site that is in the shape at `now` and was not, or was not yet
  /// given, at `before` [s].
  template <class Body>
  void for_entering(double before, double now, const Body& body) const {
    const bool first = before < emitter_.start;
    // Where the lattice was at a time is computed in one way, so that no site on the rim of the
    // shape is missed between two calls by rounding.
    const double to = std::min(now, emitter_.stop), moved = moved_at(to), moved_before = first ? 0 : moved_at(before);
    const int low = static_cast<int>(std::ceil((-depth_ - moved) / spacing_ - 1)),
              high = static_cast<int>(std::floor((depth_ - moved) / spacing_ + 1));
    for (int k = low; k <= high; ++k)
      for (int i = -columns_; i < columns_; ++i)
        for (int j = -rows_; j < rows_; ++j) {
          const Vec3d p = site(k, i, j, moved);
          if (!(emitter_.shape->distance(p) < 0)) continue;
          if (!first && emitter_.shape->distance(site(k, i, j, moved_before)) < 0) continue;
          body(p + along_ * (speed_ * (now - to)));
        }
  }

 private:
  double moved_at(double time) const { return speed_ * (time - emitter_.start); }
  Vec3d site(int k, int i, int j, double moved) const {
    return middle_ + along_ * ((k + 0.5) * spacing_ + moved) + across_ * ((i + 0.5) * spacing_) +
           over_ * ((j + 0.5) * spacing_);
  }
  const Emitter& emitter_;
  double spacing_, speed_, depth_;
  Vec3d along_, across_, over_, middle_;
  int columns_, rows_;
};

/// Places, to be asked whether there is one within a distance.
class Places {
 public:
  explicit Places(double reach) : reach_(reach) {}
  void add(const Vec3d& p) { cells_[cell_of(p)].push_back(p); }
  bool any_near(const Vec3d& p) const {
    const Vec3i c = cell_of(p);
    for (int n = 0; n < 27; ++n) {
      const auto found = cells_.find(c + Vec3i{n / 9 - 1, n / 3 % 3 - 1, n % 3 - 1});
      if (found == cells_.end()) continue;
      for (const Vec3d& q : found->second)
        if (dot(q - p, q - p) < reach_ * reach_) return true;
    }
    return false;
  }

 private:
  struct Key {
    std::size_t operator()(const Vec3i& c) const {
      return static_cast<std::size_t>(mix64((std::uint64_t(std::uint32_t(c.x)) << 40) ^
                                            (std::uint64_t(std::uint32_t(c.y)) << 20) ^ std::uint32_t(c.z)));
    }
  };
  Vec3i cell_of(const Vec3d& p) const {
    return {static_cast<std::int32_t>(std::floor(p.x / reach_)), static_cast<std::int32_t>(std::floor(p.y / reach_)),
            static_cast<std::int32_t>(std::floor(p.z / reach_))};
  }
  double reach_;
  std::unordered_map<Vec3i, std::vector<Vec3d>, Key> cells_;
};

/// The matter that is there within a box.
template <class R>
Places matter_in(const World<R>& world, const Box3d& box, double reach) {
  Places all(reach);
  for (std::size_t s = 0; s < world.sets.size(); ++s)
    ParticleSetView<R>(world, s).for_each([&](std::size_t, const Vec3d& x) {
      if (box.contains(x)) all.add(x);
    });
  return all;
}

}  // namespace

Entered& Entered::operator+=(const Entered& b) {
  particles += b.particles, mass += b.mass, energy += b.energy;
  momentum += b.momentum, angular += b.angular;
  return *this;
}

template <class R>
Entered emit(World<R>& world, Backend<R>& backend, Motion<R>& motion) {
  Entered entered;
  const double before = world.emitted_until, now = world.time;
  world.emitted_until = now;
  const Vec3d gravity = world.gravity_at(now);
  for (Emitter& emitter : world.emitters) {
    if (!emitter.gives_within(before, now)) continue;
    ParticleSet<R>& set = world.sets[emitter.set];
    const double spacing = set.spacing();
    std::vector<Vec3d> sites;
    Lattice(emitter, spacing).for_entering(before, now, [&](const Vec3d& p) { sites.push_back(p); });
    if (sites.empty()) continue;
    Box3d box;
    for (const Vec3d& p : sites) box.add(p);
    // Less than half a spacing, so that rounding blocks no site beside one before it.
    const double reach = 0.5 * spacing;
    box.min -= Vec3d{reach, reach, reach}, box.max += Vec3d{reach, reach, reach};
    backend.download(world, motion, MatterFields::position);
    const Places matter = matter_in(world, box, reach);
    const std::uint64_t used = emitter.recycle ? set.size() : emitter.born;
    std::vector<ParticleSeed> seeds;
    for (const Vec3d& p : sites) {
      if (used + seeds.size() >= emitter.pool || matter.any_near(p)) {
        ++emitter.blocked;
        continue;
      }
      seeds.push_back({world.next_id + static_cast<std::uint32_t>(seeds.size()), p, emitter.velocity, {}});
    }
    if (seeds.empty()) continue;
    const PassStats stats = backend.insert_particles(world, emitter.set, seeds);
    world.next_id += static_cast<std::uint32_t>(seeds.size());
    emitter.born += seeds.size();
    world.wave_speed = std::max(world.wave_speed, stats.wave_speed);
    world.viscosity = std::max(world.viscosity, stats.viscosity);
    for (const ParticleSeed& s : seeds) {
      const Vec3d momentum = s.velocity * set.mass;
      entered += {1, set.mass, momentum, cross(s.position, momentum),
                  set.mass * (0.5 * dot(s.velocity, s.velocity) - dot(gravity, s.position))};
      if (set.transfer.keeps_velocity()) world.keeping += kinetic_energy(set, world.dx, s.velocity, s.gradient);
    }
  }
  return entered;
}

template <class R>
double emission_speed(const World<R>& world, double ahead) {
  double speed = 0;
  for (const Emitter& e : world.emitters)
    if (e.gives_within(world.time, world.time + ahead)) speed = std::max(speed, length(e.velocity));
  return speed;
}

#define DM_INSTANTIATE(R)                                    \
  template Entered emit(World<R>&, Backend<R>&, Motion<R>&); \
  template double emission_speed(const World<R>&, double);
DM_INSTANTIATE(float)
DM_INSTANTIATE(double)
#undef DM_INSTANTIATE

}  // namespace dreampm

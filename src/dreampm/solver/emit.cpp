#include "dreampm/solver/emit.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <unordered_map>

#include "dreampm/base/hash.h"
#include "dreampm/base/log.h"
#include "dreampm/base/narrow.h"
#include "dreampm/math/vec_hash.h"
#include "dreampm/solver/emission_pattern.h"
#include "dreampm/solver/solids_in_the_way.h"
#include "dreampm/solver/solver.h"
#include "dreampm/state/mechanics.h"
#include "dreampm/state/node_view.h"
#include "dreampm/state/particle_view.h"

namespace dreampm {
namespace {

/// Places, to be asked whether there is one within a distance.
class Places {
 public:
  explicit Places(double reach) : reach_(reach) {}
  void add(const Vec3d& p) { cells_[cell_of(p)].push_back(p); }
  bool any_near(const Vec3d& p) const {
    return any_near(p, [](const Vec3d&) { return true; });
  }
  /// True if any of the counted points is near.
  template <class Counts>
  bool any_near(const Vec3d& p, const Counts& counts) const {
    const Vec3i c = cell_of(p);
    for (int n = 0; n < 27; ++n) {
      const auto found = cells_.find(c + Vec3i{n / 9 - 1, n / 3 % 3 - 1, n % 3 - 1});
      if (found == cells_.end()) continue;
      for (const Vec3d& q : found->second)
        if (dot(q - p, q - p) < reach_ * reach_ && counts(q)) return true;
    }
    return false;
  }

 private:
  Vec3i cell_of(const Vec3d& p) const {
    return {static_cast<std::int32_t>(std::floor(p.x / reach_)), static_cast<std::int32_t>(std::floor(p.y / reach_)),
            static_cast<std::int32_t>(std::floor(p.z / reach_))};
  }
  double reach_;
  std::unordered_map<Vec3i, std::vector<Vec3d>, Vec3iHash> cells_;
};

/// Spacings that matter comes in between two insertions: each lays the grid anew, which would cost
/// more than the step.
constexpr double batch = 0.25;

/// True if matter that entered since `before` [s] is enough for a batch, or is the last, or the
/// first.
bool is_due(const Emitter& emitter, double spacing, double before, double now) {
  if (!emitter.gives_within(before, now)) return false;
  return before < emitter.start || now >= emitter.stop || emitter.moved(now) - emitter.moved(before) >= batch * spacing;
}

/// Returns the sites of matter that comes in from `before` to `now` [s], in the frame of the
/// emitter's shape.
std::vector<Vec3d> entering_sites(const Emitter& emitter, double spacing, double before, double now) {
  const double to = std::min(now, emitter.stop);
  // Matter that came in at the stop has gone on since.
  const Vec3d since = emitter.along * (emitter.speed_at(to) * (now - to));
  std::vector<Vec3d> sites;
  Hash64 seed;
  seed.add(std::string_view(emitter.name));
  EmissionPattern(*emitter.shape, emitter.along, spacing, seed.value())
      .for_entering(emitter.moved(before), emitter.moved(to), before < emitter.start,
                    [&](const Vec3d& p) { sites.push_back(p + since); });
  return sites;
}

/// Spacings along each axis: two places of the pattern, both moved so far towards one another, keep
/// half a spacing.
constexpr double most_moved = 0.11;

/// Returns the place at which particle `id` of a site comes in: off the site by the emitter's
/// jitter, unless a wall or a collider is there.
template <class R>
Vec3d jittered(const World<R>& world, const Emitter& emitter, double spacing, const Vec3d& site, std::uint32_t id) {
  if (emitter.jitter == 0) return site;
  const double off = std::min(emitter.jitter, most_moved) * spacing;
  Vec3d p = site;
  for (int a = 0; a < 3; ++a) {
    const double unit =
        static_cast<double>(mix64(std::uint64_t{id} * 3 + static_cast<std::uint64_t>(a)) >> 11) * 0x1p-53;
    p[a] += (2 * unit - 1) * off;
  }
  const bool free = world.domain().contains(p) && std::none_of(world.colliders.begin(), world.colliders.end(),
                                                               [&](const Collider& c) { return c.distance(p) < 0; });
  return free ? p : site;
}

/// Returns the shifts that bring matter into the box: zero, and a period where the box reaches over
/// the end of a periodic axis.
template <class R>
std::vector<Vec3d> shifts_into(const World<R>& world, const Box3d& box) {
  std::vector<Vec3d> shifts{Vec3d{}};
  const Box3d domain = world.domain();
  for (int a = 0; a < 3; ++a) {
    if (!world.periodic[static_cast<std::size_t>(a)]) continue;
    const double period = domain.max[a] - domain.min[a];
    const std::size_t before = shifts.size();
    for (const double by : {box.min[a] < domain.min[a] ? -period : 0, box.max[a] > domain.max[a] ? period : 0})
      for (std::size_t i = 0; by != 0 && i < before; ++i) {
        Vec3d shift = shifts[i];
        shift[a] += by;
        shifts.push_back(shift);
      }
  }
  return shifts;
}

/// Makes the places of the matter current that there may be within a box.
template <class R>
void download_matter_in(World<R>& world, Backend<R>& backend, const Box3d& box) {
  std::vector<Box3d> boxes;
  for (const Vec3d& shift : shifts_into(world, box)) boxes.push_back({box.min - shift, box.max - shift});
  backend.download_near(world, boxes);
}

/// The matter that is there within a box.
template <class R>
Places matter_in(const World<R>& world, const Box3d& box, double reach) {
  Places all(reach);
  const std::vector<Vec3d> shifts = shifts_into(world, box);
  for (std::size_t s = 0; s < world.sets.size(); ++s)
    for (const Vec3d& shift : shifts)
      ParticleSetView<R>(world, s).for_each_near({box.min - shift, box.max - shift}, [&](std::size_t, const Vec3d& x) {
        if (box.contains(x + shift)) all.add(x + shift);
      });
  return all;
}

/// The matter that comes to a tap from behind along a periodic axis, as its own jet does that has
/// gone round. It fills the tap as it goes on: places between its particles are no room for more.
template <class R>
class ComingRound {
 public:
  /// Looks at the World's nodes, and at places in looked_at(): they are current.
  ComingRound(const World<R>& world, const Emitter& emitter, const Pose& pose, double speed, const Box3d& box)
      : world_(world),
        emitter_(emitter),
        pose_(pose),
        along_(pose.rotation(emitter.along)),
        speed_(speed),
        reach_(reach_of(world, emitter)),
        matter_(matter_in(world, looked_at(world, emitter, box), reach_)) {}
  /// Where it looks for matter, for sites in the box.
  static Box3d looked_at(const World<R>& world, const Emitter& emitter, const Box3d& box) {
    const double reach = reach_of(world, emitter);
    return {box.min - Vec3d{reach, reach, reach}, box.max + Vec3d{reach, reach, reach}};
  }
  static bool may_be(const World<R>& world, const Vec3d& along) {
    for (int a = 0; a < 3; ++a)
      if (world.periodic[static_cast<std::size_t>(a)] && std::abs(along[a]) > 0.5) return true;
    return false;
  }
  bool fills(const Vec3d& site) const {
    const bool is_behind = matter_.any_near(site, [&](const Vec3d& q) {
      return dot(q - site, along_) < 0 && emitter_.shape->distance(pose_.inverse(q)) > 0;
    });
    if (!is_behind) return false;
    const Vec3d velocity = velocity_near(world_, world_.sets[emitter_.set], site - along_ * world_.dx);
    return dot(velocity, along_) > as_fast * speed_;
  }

 private:
  /// Spacings: no place within matter is as far from all of it. Of the speed of the tap, what comes
  /// round has at least; what is dragged along from rest does not.
  static constexpr double far = 1.25, as_fast = 0.5;
  static double reach_of(const World<R>& world, const Emitter& emitter) {
    return far * world.sets[emitter.set].spacing();
  }

  const World<R>& world_;
  const Emitter& emitter_;
  Pose pose_;
  Vec3d along_;
  double speed_, reach_;
  Places matter_;
};

}  // namespace

Entered& Entered::operator+=(const Entered& b) {
  particles += b.particles, mass += b.mass, energy += b.energy;
  momentum += b.momentum, angular += b.angular;
  return *this;
}

template <class R>
Entered emit(World<R>& world, Backend<R>& backend, Solver<R>& solver, Motion<R>& motion) {
  Entered entered;
  const double before = world.emitted_until, now = world.time;
  if (std::none_of(world.emitters.begin(), world.emitters.end(),
                   [&](const Emitter& e) { return is_due(e, world.sets[e.set].spacing(), before, now); }))
    return entered;
  world.emitted_until = now;
  const Vec3d gravity = world.gravity_at(now);
  for (Emitter& emitter : world.emitters) {
    if (!emitter.gives_within(before, now)) continue;
    ParticleSet<R>& set = world.sets[emitter.set];
    const double spacing = set.spacing();
    std::vector<Vec3d> sites = entering_sites(emitter, spacing, before, now);
    const Pose pose = emitter.pose_at(now);
    if (emitter.path) {
      for (Vec3d& p : sites) p = pose(p);
      // One that moves may have left the space.
      std::erase_if(sites, [&](const Vec3d& p) { return !world.domain().contains(p); });
    }
    if (sites.empty()) continue;
    Box3d box;
    for (const Vec3d& p : sites) box.add(p);
    // So that neither rounding nor jitter blocks a site beside one before it.
    const double reach = 0.5 * spacing;
    box.min -= Vec3d{reach, reach, reach}, box.max += Vec3d{reach, reach, reach};
    const Vec3d along = pose.rotation(emitter.along);
    const bool may_come_round = ComingRound<R>::may_be(world, along);
    if (may_come_round) backend.download(world, motion, MatterFields::nodes);
    download_matter_in(world, backend, may_come_round ? ComingRound<R>::looked_at(world, emitter, box) : box);
    std::optional<ComingRound<R>> round;
    if (may_come_round) round.emplace(world, emitter, pose, emitter.speed_at(now), box);
    const Places matter = matter_in(world, box, reach);
    const SolidsInTheWay solids(world, box);
    const std::uint64_t used = emitter.recycle ? set.size() : emitter.born;
    const Twist twist = emitter.twist_at(now);
    const Vec3d velocity = along * emitter.speed_at(now), swirl = along * emitter.swirl,
                middle = pose(emitter.shape->bounds().center()), spin = swirl + twist.spin;
    const Mat3d turning{{0, -spin.z, spin.y, spin.z, 0, -spin.x, -spin.y, spin.x, 0}};
    std::vector<ParticleSeed> seeds;
    for (const Vec3d& site : sites) {
      if (matter.any_near(site) || solids.cover(site) || (round && round->fills(site))) continue;
      if (used + seeds.size() >= emitter.pool) {
        if (!emitter.dry)
          warn("emitter {}: its pool of {} particles is used up at t = {:.4g} s{}", emitter.name, emitter.pool, now,
               emitter.recycle ? "; it goes on when sinks have taken some" : "");
        emitter.dry = true;
        break;
      }
      const auto id = narrow<std::uint32_t>(world.next_id + seeds.size(), "particles");
      const Vec3d p = jittered(world, emitter, spacing, site, id);
      seeds.push_back({id, p, velocity + cross(swirl, p - middle) + twist.at(p), turning});
    }
    if (seeds.empty()) continue;
    const PassStats stats = solver.insert(world, emitter.set, seeds);
    world.next_id = narrow<std::uint32_t>(world.next_id + seeds.size(), "particles");
    emitter.born += seeds.size();
    world.arrivals.push_back({seeds.front().id, static_cast<std::uint32_t>(seeds.size()),
                              static_cast<std::uint32_t>(&emitter - world.emitters.data()), now});
    world.wave_speed = std::max(world.wave_speed, stats.wave_speed);
    world.viscosity = std::max(world.viscosity, stats.viscosity);
    for (const ParticleSeed& s : seeds) {
      const Vec3d momentum = s.velocity * set.mass;
      entered += {1, set.mass, momentum, angular_momentum(set, world.dx, s.position, s.velocity, s.gradient),
                  kinetic_energy(set, world.dx, s.velocity, s.gradient) - set.mass * dot(gravity, s.position)};
      if (set.has_own_velocity()) world.kept_kinetic_energy += kinetic_energy(set, world.dx, s.velocity, s.gradient);
    }
  }
  return entered;
}

template <class R>
double emission_speed(const World<R>& world, double ahead) {
  double speed = 0;
  for (const Emitter& e : world.emitters)
    if (e.gives_within(world.time, world.time + ahead))
      speed = std::max(speed, e.fastest(world.time, world.time + ahead));
  return speed;
}

#define DM_INSTANTIATE(R)                                                \
  template Entered emit(World<R>&, Backend<R>&, Solver<R>&, Motion<R>&); \
  template double emission_speed(const World<R>&, double);
DM_INSTANTIATE(float)
DM_INSTANTIATE(double)
#undef DM_INSTANTIATE

}  // namespace dreampm

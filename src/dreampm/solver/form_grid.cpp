#include "dreampm/solver/form_grid.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "dreampm/base/error.h"
#include "dreampm/base/parallel.h"
#include "dreampm/solver/choose_dt.h"
#include "dreampm/solver/motion_by_id.h"

namespace dreampm {
namespace {

/// The largest speed and the energies of all particles.
struct Pace {
  double fastest = 0;  ///< m/s: no node is faster than a particle together with its affine motion over a cell
  double kept = 0;     ///< J, kinetic, of sets that keep velocities
};
template <class R>
Pace pace_of(const World<R>& world, const Motion<R>& motion) {
  Pace all;
  const auto join = [](Pace& to, const Pace& from) {
    to.fastest = std::max(to.fastest, from.fastest), to.kept += from.kept;
  };
  for (std::size_t s = 0; s < world.sets.size(); ++s) {
    const ParticleSet<R>& set = world.sets[s];
    const auto& m = motion.sets[s];
    const bool keeps = set.transfer.keeps_velocity();
    join(all, parallel_reduce(
                  set.size(), Pace{},
                  [&](Pace& sum, std::size_t p) {
                    const auto v = static_cast<Vec3d>(m.velocity[p]);
                    const auto c = static_cast<Mat3d>(m.gradient[p]);
                    sum.fastest = std::max(sum.fastest, length(v) + std::sqrt(norm2(c)) * world.dx);
                    if (keeps) sum.kept += kinetic_energy(set, world.dx, v, c);
                  },
                  join));
  }
  return all;
}

}  // namespace

template <class R>
void form_grid(World<R>& world, Backend<R>& backend, Motion<R>& motion, Motion<R>& spare) {
  backend.download(world, motion, MatterFields::id | MatterFields::motion);
  // Calls that may throw come before the sort, so that world and motion stay in one order.
  const PassStats stats = backend.state_bounds(world);
  if (!stats.finite)
    throw NumericalFailure(fmt::format("an edit at t = {:.6g} s leaves particles that are not finite", world.time));
  world.wave_speed = stats.wave_speed;
  world.viscosity = stats.viscosity;
  const Pace pace = pace_of(world, motion);
  world.kept_kinetic_energy = pace.kept;
  choose_dt(world, pace.fastest, frame_end(world) - world.time);
  if (const double longest = longest_stable_dt(world, pace.fastest);
      world.settings.fixed_dt > 0 && world.dt_next > longest)
    fail_input(
        "time.dt is {:.4g}: after the edit at t = {:.6g} s it must be at most {:.3g} s, for sound and matter may cross "
        "{} of a cell in a step; or give time.cfl instead",
        world.settings.fixed_dt, world.time, longest, largest_cfl);

  world.aim_colliders();
  MotionById<R> by_id(world, std::move(motion));
  motion = std::move(spare);
  backend.sort(world);
  backend.download(world, motion, MatterFields::id);
  by_id.order(world, motion);
  spare = std::move(by_id).release();
  backend.upload(world, motion, MatterFields::motion);
  backend.scatter_particles(world, motion);
  world.formed_for(world.dt_next);
}

template void form_grid(World<float>&, Backend<float>&, Motion<float>&, Motion<float>&);
template void form_grid(World<double>&, Backend<double>&, Motion<double>&, Motion<double>&);

}  // namespace dreampm

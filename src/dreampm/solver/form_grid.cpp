#include "dreampm/solver/form_grid.h"

#include <algorithm>
#include <cmath>

#include "dreampm/base/error.h"
#include "dreampm/solver/choose_dt.h"
#include "dreampm/solver/motion_by_id.h"

namespace dreampm {

template <class R>
void form_grid(World<R>& world, Backend<R>& backend, Motion<R>& motion) {
  backend.download(world, motion, MatterFields::id | MatterFields::motion);
  // What throws comes before the sort, so that world and motion stay in one order.
  const PassStats stats = backend.state_bounds(world);
  if (!stats.finite)
    throw NumericalFailure(fmt::format("an edit at t = {:.6g} s leaves particles that are not finite", world.time));
  world.wave_speed = stats.wave_speed;
  world.viscosity = stats.viscosity;
  double fastest = 0;
  world.keeping = 0;
  for (std::size_t s = 0; s < world.sets.size(); ++s) {
    const ParticleSet<R>& set = world.sets[s];
    const auto& m = motion.sets[s];
    for (std::size_t p = 0; p < set.size(); ++p) {
      const auto v = static_cast<Vec3d>(m.velocity[p]);
      const auto c = static_cast<Mat3d>(m.gradient[p]);
      // No node is faster than a particle together with its affine motion over a cell.
      fastest = std::max(fastest, length(v) + std::sqrt(norm2(c)) * world.dx);
      if (set.transfer.keeps_velocity()) world.keeping += kinetic_energy(set, world.dx, v, c);
    }
  }
  choose_dt(world, fastest, frame_end(world) - world.time);
  if (const double longest = longest_stable_dt(world, fastest); world.settings.fixed_dt > 0 && world.dt_next > longest)
    fail_input(
        "time.dt is {:.4g}: after the edit at t = {:.6g} s it must be at most {:.3g} s, for sound and matter may cross "
        "{} of a cell in a step; or give time.cfl instead",
        world.settings.fixed_dt, world.time, longest, largest_cfl);

  world.aim_colliders();
  const MotionById<R> by_id(world, motion);
  backend.sort(world);
  backend.download(world, motion, MatterFields::id);
  motion = by_id.ordered(world);
  backend.upload(world, motion, MatterFields::motion);
  backend.scatter_particles(world, motion);
  world.formed_for(world.dt_next);
}

template void form_grid(World<float>&, Backend<float>&, Motion<float>&);
template void form_grid(World<double>&, Backend<double>&, Motion<double>&);

}  // namespace dreampm

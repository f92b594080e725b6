#include "dreampm/solver/projection/step_length.h"

#include <algorithm>

#include "dreampm/solver/choose_dt.h"
#include "dreampm/solver/emit.h"
#include "dreampm/state/force_fields.h"

namespace dreampm {

template <class R>
void choose_projection_dt(World<R>& world, FlowSpeeds flow, double left, double crowding) {
  const StepSettings& s = world.settings;
  const double ahead = world.dt_next + left;
  flow.usual = std::max(flow.usual, emission_speed(world, ahead));
  // A collider crosses a cell at most.
  flow.fastest = std::max(flow.fastest, block_width * world.collider_speed(ahead));
  StepBound bound{s.fixed_dt, Limiter::user};
  if (!(s.fixed_dt > 0)) {
    const auto bound_for = [&] {
      return projection_bound(crowded_cfl(s.cfl, crowding), world.dx, length(world.gravity_at(world.time)), flow,
                              block_width);
    };
    bound = bound_for();
    if (!world.fields.empty()) {
      flow.fastest = fastest_after_fields(world, flow.fastest, bound.dt);
      bound = bound_for();
    }
    if (s.dt_max < bound.dt) bound = {s.dt_max, Limiter::user};
  }
  split_frame(world, bound, left);
}

template void choose_projection_dt(World<float>&, FlowSpeeds, double, double);
template void choose_projection_dt(World<double>&, FlowSpeeds, double, double);

}  // namespace dreampm

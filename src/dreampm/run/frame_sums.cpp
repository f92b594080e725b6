#include "dreampm/run/frame_sums.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace dreampm {

void FrameSums::add(const StepSums& step, double heaviest) {
  ++substeps;
  if (step.dt < dt_min) dt_min = step.dt, limiter = step.limiter;
  dt_max = std::max(dt_max, step.dt);
  stages = std::max(stages, step.stages);
  contact += step.grid.contact();
  body += step.body;
  left += step.left;
  entered += step.entered;
  left_mass += step.left_mass;
  damping -= step.grid.damping.work;
  lost += step.pass.energy;
  transfer += step.transfer;
  rounding += step.rounding;
  // The sums over steps are rounded too, in double: a reference run sees it.
  rounding += 0.5 * std::numeric_limits<double>::epsilon() *
              (length(contact.impulse) + length(body.impulse) + length(left.impulse));
  // None is pushed further than it moved.
  if (step.pass.pushed > 0)
    jumps += heaviest * static_cast<double>(step.pass.pushed) * step.grid.max_speed * step.grid.max_speed * step.dt;
  grid_mass = step.grid.mass;
  if (step.swollen) swollen = step.swollen;
  if (step.projected) projected = projected.value_or(0) + *step.projected;
}

template <class R>
void FrameTotals<R>::on_step(const StepSums& step) {
  if (std::exchange(ended_, step.frame_done)) sums_ = {};
  double heaviest = 0;
  for (const auto& set : engine_.world().sets) heaviest = std::max(heaviest, set.mass);
  sums_.add(step, heaviest);
  particle_steps_ += engine_.world().particles();
}

template class FrameTotals<float>;
template class FrameTotals<double>;

}  // namespace dreampm

#include "dreampm/setup/fixed_dt.h"

#include <algorithm>
#include <cmath>

#include "dreampm/base/error.h"
#include "dreampm/solver/step.h"

namespace dreampm {

template <class R>
std::string too_many_stages(const World<R>& world) {
  if (world.viscous_stages <= most_stages) return {};
  return fmt::format(
      "time.dt is {:.4g} s, so that every step takes {} stages of viscosity; they save nothing beyond {:.4g} s and {} "
      "stages",
      world.dt_next, world.viscous_stages,
      dt_of_stages(most_stages, euler_dt(world.dx, world.viscosity, world.viscous_contacts())), most_stages);
}

template <class R>
void check_fixed_dt(const World<R>& world, const std::vector<std::vector<ParticleSeed>>& seeds, const model::Time& time,
                    const std::string& at) {
  if (!time.dt || time.solver == SolverKind::projection) return;
  const double longest = longest_fixed_dt(world, seeds);
  if (std::min(*time.dt, world.dt_next) <= longest) return;
  // Rounded down: what is offered must do.
  const double digit = std::pow(10, std::floor(std::log10(longest)) - 2);
  fail_input(
      "{}: error: time.dt is {}: must be at most {:.3g} s, for sound and matter may cross {} of a cell in a step; or "
      "give time.cfl instead",
      at, *time.dt, digit * std::floor(longest / digit), largest_cfl);
}

template std::string too_many_stages(const World<float>&);
template void check_fixed_dt(const World<float>&, const std::vector<std::vector<ParticleSeed>>&, const model::Time&,
                             const std::string&);
template std::string too_many_stages(const World<double>&);
template void check_fixed_dt(const World<double>&, const std::vector<std::vector<ParticleSeed>>&, const model::Time&,
                             const std::string&);

}  // namespace dreampm

#include "validate/cases.h"

#include "dreampm/scene/problem.h"

namespace dreampm::validate {

// One line a case: the variable that its file defines.
#define DM_CASES(X)           \
  X(free_fall)                \
  X(slopes)                   \
  X(still_column)             \
  X(bar_wave)                 \
  X(piston)                   \
  X(sloshing)                 \
  X(sloshing_projection)      \
  X(taylor_green)             \
  X(honey_channel)            \
  X(honey_channel_projection) \
  X(conservation)             \
  X(seed)                     \
  X(elliptical_drop)          \
  X(tearing)                  \
  X(dam_break)                \
  X(dam_break_projection)     \
  X(obstacle)                 \
  X(obstacle_projection)      \
  X(snow_press)               \
  X(beam)                     \
  X(granular)                 \
  X(stability)                \
  X(stability_playground)     \
  X(violent_tank)             \
  X(shallow_tank)             \
  X(long_slosh)               \
  X(still_tank)               \
  X(still_tank_projection)    \
  X(still_shore)              \
  X(splash_volume)            \
  X(splash_volume_projection) \
  X(splash_energy_projection) \
  X(vessels)                  \
  X(pool)                     \
  X(channel)                  \
  X(layers)                   \
  X(floating)                 \
  X(floating_projection)      \
  X(rigid_rise)               \
  X(rigid_rise_projection)    \
  X(rigid_draft)              \
  X(rigid_upright)            \
  X(rigid_float_projection)   \
  X(rigid_heave)              \
  X(rigid_heave_projection)   \
  X(rigid_sphere)             \
  X(rigid_sphere_projection)  \
  X(rigid_momentum)           \
  X(rigid_soil)               \
  X(rigid_push)               \
  X(foam_drops)               \
  X(foam_bubbles)             \
  X(convergence)

namespace cases {
#define DM_DECLARE(name) extern const Case name;
DM_CASES(DM_DECLARE)
#undef DM_DECLARE
}  // namespace cases

std::span<const Case* const> all_cases() {
#define DM_ADDRESS(name) &cases::name,
  static constexpr const Case* all[] = {DM_CASES(DM_ADDRESS)};
#undef DM_ADDRESS
  return all;
}

const Case& find_case(const std::string& name) {
  std::vector<std::string> names;
  for (const Case* c : all_cases()) {
    if (c->name == name) return *c;
    names.emplace_back(c->name);
  }
  fail_input("no case '{}'{}", name, scene::suggest(name, names));
}

}  // namespace dreampm::validate

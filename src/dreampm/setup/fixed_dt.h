// Checks of a scene's fixed time step.
#pragma once
#include <string>
#include <vector>

#include "dreampm/model/scene.h"
#include "dreampm/state/regroup.h"
#include "dreampm/state/world.h"

namespace dreampm {

/// Returns the fault of a time.dt that the solver would not choose; empty if there is none.
template <class R>
std::string too_many_stages(const World<R>& world);

/// Refuses a time.dt that cannot work. Call after `begin`, with its seeds. `at`: the place of
/// the key, for the message.
/// Throws InputError.
template <class R>
void check_fixed_dt(const World<R>& world, const std::vector<std::vector<ParticleSeed>>& seeds, const model::Time& time,
                    const std::string& at);

}  // namespace dreampm

// Removal of the matter that sinks take.
#pragma once
#include <cstdint>
#include <vector>

#include "dreampm/state/world.h"

namespace dreampm {

/// Counts in each sink the particles that lie in it now, with their momentum as it would go on: the
/// grid holds velocities. Returns their numbers by set, rising; they are still there. `far`:
/// whether particles may have come two blocks on since the last sort, not one. Blocks that no sink
/// reaches are not looked at. The sums do not depend on the number of threads.
template <class R>
std::vector<std::vector<std::uint32_t>> take_out(World<R>& world, bool far);

}  // namespace dreampm

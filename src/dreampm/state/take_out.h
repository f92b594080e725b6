// Removal of the matter that sinks take.
#pragma once
#include <cstdint>
#include <vector>

#include "dreampm/state/world.h"

namespace dreampm {

/// True if sinks take matter in a sort now: before the first step the grid still holds momenta,
/// with what would be taken out of the matter.
template <class R>
bool sinks_take(const World<R>& world);

/// The blocks of particles that any sink reaches, rising. `far`: as below.
template <class R>
std::vector<std::uint32_t> blocks_at_sinks(const World<R>& world, bool far);

/// Counts in each sink the particles that lie in it now, with their momentum as it would go on: the
/// grid holds velocities. Returns their numbers by set, rising; they are still there. `far`:
/// whether particles may have come two blocks on since the last sort, not one. It looks at no
/// particles but those of blocks_at_sinks(), and at no nodes but those that these gather from. The
/// sums do not depend on the number of threads.
template <class R>
std::vector<std::vector<std::uint32_t>> take_out(World<R>& world, bool far);

}  // namespace dreampm

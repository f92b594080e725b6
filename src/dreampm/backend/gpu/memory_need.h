// How much of a device's memory a World takes, so that what does not fit is said before it is
// tried.
#pragma once
#include <cstddef>

#include "dreampm/backend/gpu/device.h"
#include "dreampm/state/world.h"

namespace dreampm::gpu {

/// About how many bytes the particles and the grid of that world take.
std::size_t bytes_needed(const World<float>& world);
/// Throws RunError, with what is needed and what there is, where the device has no room for the
/// world, which takes the place of what its Buffers hold.
void check_room(const Device& device, const World<float>& world);

}  // namespace dreampm::gpu

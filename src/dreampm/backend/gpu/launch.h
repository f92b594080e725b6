// The launch of a kernel on a device, by its type.
#pragma once
#include <cstddef>

#include "dreampm/backend/gpu/device.h"
#include "dreampm/backend/gpu/kernels.h"

namespace dreampm::gpu {

template <class K>
void launch(Device& device, const K& kernel, std::size_t blocks) {
  if (blocks > 0) device.launch(Kernels::number_of<K>(), &kernel, static_cast<int>(blocks));
}

/// The blocks of threads that a kernel needs for `items` of one thread each.
template <class K>
std::size_t blocks_for(std::size_t items) {
  return (items + K::threads - 1) / K::threads;
}

}  // namespace dreampm::gpu

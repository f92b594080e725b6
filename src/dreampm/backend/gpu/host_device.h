// A device that is this machine: its memory is the host's, and its kernels run thread after thread.
// Tests hold the gpu backends to the reference with it, where there is no card.
#pragma once
#include <memory>

#include "dreampm/backend/gpu/block.h"
#include "dreampm/backend/gpu/device.h"

namespace dreampm::gpu {

/// `order`: that of threads and blocks; results may not depend on it.
std::unique_ptr<Device> make_host_device(ThreadOrder order = ThreadOrder::rising);

}  // namespace dreampm::gpu

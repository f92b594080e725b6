// NVIDIA GPUs, by libdreampm_cuda.so (tools/build_cuda), which is loaded when it is asked for.
#pragma once
#include <memory>
#include <string>

#include "dreampm/backend/gpu/device.h"

namespace dreampm::gpu {

/// Opens device `number`, from 0. Throws InputError where the library or the driver is missing, or
/// there is no such device, with the reason.
std::unique_ptr<Device> make_cuda_device(int number = 0);
/// The device that make_cuda_device() would open: a line about it, or the reason why there is none.
struct CudaState {
  bool found = false;
  std::string text;
};
CudaState find_cuda();

}  // namespace dreampm::gpu

// The backend of a device: its particles lie in the device's memory.
#pragma once
#include <memory>
#include <string_view>

#include "dreampm/backend/backend.h"
#include "dreampm/backend/gpu/device.h"

namespace dreampm {

/// `name`: as the registry has it.
std::unique_ptr<Backend<float>> make_gpu_backend(std::string_view name, std::unique_ptr<gpu::Device> device);

}  // namespace dreampm

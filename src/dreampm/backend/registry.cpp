#include "dreampm/backend/registry.h"

#include <fmt/ranges.h>

#include "dreampm/backend/cpu/cpu.h"
#include "dreampm/backend/gpu/cuda/cuda.h"
#include "dreampm/backend/gpu/gpu.h"
#include "dreampm/backend/reference/reference.h"
#include "dreampm/base/error.h"

namespace dreampm {
namespace {

constexpr BackendInfo table[] = {
    {"cpu", "fast, in float", [](std::string_view isa) -> AnyBackend { return make_cpu_backend(isa); }},
    {"reference", "plain loops in the order of the papers, in double",
     [](std::string_view) -> AnyBackend { return make_reference_backend<double>(); }},
    {"cuda", "one NVIDIA GPU, in float",
     [](std::string_view) -> AnyBackend { return make_gpu_backend("cuda", gpu::make_cuda_device()); },
     [] {
       const gpu::CudaState state = gpu::find_cuda();
       return state.found ? std::string() : state.text;
     },
     [] {
       const std::unique_ptr<gpu::Device> device = gpu::make_cuda_device();
       const gpu::Device::Memory memory = device->memory();
       return DeviceFacts{device->about(), memory.free, memory.all};
     }},
};

}  // namespace

std::span<const BackendInfo> backends() { return table; }

std::vector<std::string> backend_names() {
  std::vector<std::string> names;
  for (const BackendInfo& b : backends()) names.emplace_back(b.name);
  return names;
}

std::vector<std::string> backends_here() {
  std::vector<std::string> names;
  for (const BackendInfo& b : backends())
    if (!b.why_not || b.why_not().empty()) names.emplace_back(b.name);
  return names;
}

const BackendInfo& backend_info(std::string_view name) {
  for (const BackendInfo& b : backends())
    if (name.empty() || name == b.name) return b;
  fail_input("backend {} is not known; there are {}", name, fmt::join(backend_names(), ", "));
}

AnyBackend make_backend(std::string_view name, std::string_view isa) { return backend_info(name).make(isa); }

}  // namespace dreampm

// The table of backends of this program: beside those of the library the kernels of a device on the
// host. It stands before that of backend/registry.cpp.
#include <stdexcept>

#include "dreampm/backend/cpu/cpu.h"
#include "dreampm/backend/gpu/gpu.h"
#include "dreampm/backend/gpu/host_device.h"
#include "dreampm/backend/reference/reference.h"
#include "dreampm/backend/registry.h"

namespace dreampm {
namespace {

constexpr BackendInfo table[] = {
    {"gpu", "", [](std::string_view) -> AnyBackend { return make_gpu_backend("gpu", gpu::make_host_device()); }},
    {"cpu", "", [](std::string_view isa) -> AnyBackend { return make_cpu_backend(isa); }},
    {"reference", "", [](std::string_view) -> AnyBackend { return make_reference_backend<double>(); }},
};

}  // namespace

std::span<const BackendInfo> backends() { return table; }

/// What tests for every backend run here.
std::vector<std::string> backends_here() { return {"gpu"}; }

std::vector<std::string> backend_names() { return {"gpu", "cpu", "reference"}; }

AnyBackend make_backend(std::string_view name, std::string_view isa) {
  for (const BackendInfo& b : table)
    if (b.name == name) return b.make(isa);
  throw std::invalid_argument("no backend of that name");
}

}  // namespace dreampm

// The table of backends of this program: those of the library, and each with its matter kept away.
// It stands before that of backend/registry.cpp.
#include <solver/away.h>

#include <stdexcept>

#include "dreampm/backend/cpu/cpu.h"
#include "dreampm/backend/reference/reference.h"
#include "dreampm/backend/registry.h"

namespace dreampm {
namespace {

template <class R>
std::unique_ptr<Backend<R>> away(std::unique_ptr<Backend<R>> backend) {
  return std::make_unique<test::Away<R>>(std::move(backend));
}

constexpr BackendInfo table[] = {
    {"cpu", "", [](std::string_view isa) -> AnyBackend { return make_cpu_backend(isa); }},
    {"cpu, away", "", [](std::string_view isa) -> AnyBackend { return away(make_cpu_backend(isa)); }},
    {"reference", "", [](std::string_view) -> AnyBackend { return make_reference_backend<double>(); }},
    {"reference, away", "", [](std::string_view) -> AnyBackend { return away(make_reference_backend<double>()); }},
};

}  // namespace

std::span<const BackendInfo> backends() { return table; }

std::vector<std::string> backend_names() {
  std::vector<std::string> names;
  for (const BackendInfo& b : table) names.emplace_back(b.name);
  return names;
}

std::vector<std::string> backends_here() { return backend_names(); }

AnyBackend make_backend(std::string_view name, std::string_view isa) {
  for (const BackendInfo& b : table)
    if (b.name == name) return b.make(isa);
  throw std::invalid_argument("no backend of that name");
}

}  // namespace dreampm

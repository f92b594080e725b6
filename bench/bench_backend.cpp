#include "bench/bench_backend.h"

#include <utility>

#include "dreampm/base/error.h"

namespace dreampm {

void check_isa(const BenchBackend& choice) {
  if (choice.backend != "cpu" && choice.isa != "auto")
    fail_input("--isa {}: --backend {} has no instruction sets to choose from; leave it out, or take --backend cpu",
               choice.isa, choice.backend);
}

std::unique_ptr<Backend<float>> make_bench_backend(const BenchBackend& choice) {
  check_isa(choice);
  AnyBackend made = make_backend(choice.backend, choice.isa);
  if (auto* const backend = std::get_if<std::unique_ptr<Backend<float>>>(&made)) return std::move(*backend);
  fail_input("--backend {}: it computes in double, to be compared with; speed is measured in float", choice.backend);
}

std::optional<DeviceFacts> device_of(const BenchBackend& choice) {
  if (choice.on_host()) return std::nullopt;
  return backend_info(choice.backend).device();
}

}  // namespace dreampm

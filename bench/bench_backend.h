// The backend that is measured.
#pragma once
#include <memory>
#include <optional>
#include <string>

#include "dreampm/backend/backend.h"
#include "dreampm/backend/registry.h"

namespace dreampm {

/// A backend of the library, by name, and the instruction set.
struct BenchBackend {
  std::string backend = "cpu";  ///< a name of backend/registry.h
  std::string isa = "auto";     ///< an instruction set, of cpu alone

  /// True if processors do all of its work.
  bool on_host() const { return backend_info(backend).device == nullptr; }
};

/// Throws InputError where an instruction set is asked of another backend than cpu.
void check_isa(const BenchBackend& choice);

/// Throws InputError for a backend that is not there or computes in double, and for an instruction
/// set that is not there or is asked of another backend than cpu.
std::unique_ptr<Backend<float>> make_bench_backend(const BenchBackend& choice);

/// The device that it runs on, with the memory that is free there now; none for processors.
std::optional<DeviceFacts> device_of(const BenchBackend& choice);

}  // namespace dreampm

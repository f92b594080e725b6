// The fast backend: blocks in parallel in 8 colors, per-particle physics in lanes. The same bits
// for any number of threads.
#pragma once
#include <cstdint>
#include <memory>
#include <string_view>
#include <vector>

#include "dreampm/backend/backend.h"

namespace dreampm {

/// Instruction sets that this build has and this machine runs, the widest last.
std::vector<std::string_view> cpu_instruction_sets();

/// Runs at least `count` floating-point operations that nothing but the arithmetic units of an
/// instruction set limits (multiply-adds, each two); returns how many. `isa` as below.
std::uint64_t run_multiply_adds(std::uint64_t count, std::string_view isa = "auto");

/// `isa`: one of cpu_instruction_sets(), or auto for the widest. Throws InputError if it cannot run
/// here.
std::unique_ptr<Backend<float>> make_cpu_backend(std::string_view isa = "auto");

struct KernelTable;
/// Makes a backend with the caller's kernels (kernel.h), which must outlive it and have one for
/// every material that is run.
std::unique_ptr<Backend<float>> make_cpu_backend(const KernelTable& kernels);

}  // namespace dreampm

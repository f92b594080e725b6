// Random numbers by counter: the i-th number of a stream does not depend on who asked before.
#pragma once
#include <cstdint>

#include "dreampm/base/hash.h"

namespace dreampm {

/// Uniform in [0, 1) from (seed, index): equal on every machine.
constexpr double uniform(std::uint64_t seed, std::uint64_t index) {
  return static_cast<double>(mix64(mix64(seed + 0x9e3779b97f4a7c15ull) ^ (index * 0xd1342543de82ef95ull)) >> 11) *
         0x1p-53;
}

}  // namespace dreampm

// Places of a grid as keys of hash tables.
#pragma once
#include <cstddef>
#include <cstdint>

#include "dreampm/base/hash.h"
#include "dreampm/math/vec.h"

namespace dreampm {

struct Vec3iHash {
  std::size_t operator()(const Vec3i& v) const {
    return static_cast<std::size_t>(mix64((std::uint64_t(std::uint32_t(v.x)) << 40) ^
                                          (std::uint64_t(std::uint32_t(v.y)) << 20) ^ std::uint32_t(v.z)));
  }
};

}  // namespace dreampm

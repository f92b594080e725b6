// One parameter of a small struct, for the tables that feed parser, messages and the written scene.
#pragma once
#include <string_view>

#include "dreampm/math/vec.h"

namespace dreampm {

/// `number` or `vector` is set, and finite within [min, max] (min itself excluded if `above`).
template <class F>
struct MemberParam {
  std::string_view key;
  const char* unit;
  double F::* number = nullptr;
  Vec3d F::* vector = nullptr;
  double min = -1e30, max = 1e30;
  bool above = false;
  bool required = false;
  std::string_view help = {};
};

}  // namespace dreampm

// One parameter of a small struct, for the tables that feed parser, messages and the written scene.
#pragma once
#include <map>
#include <string>
#include <string_view>

#include "dreampm/math/vec.h"
#include "dreampm/model/force_field.h"
#include "dreampm/model/matter.h"

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

/// The vectors of a model::ForceField.
using Vectors = decltype(model::ForceField::vectors);

template <class F>
constexpr bool has_vectors() {
  for (const MemberParam<F>& p : F::params)
    if (p.vector) return true;
  return false;
}

/// An F whose members with these keys have these values, the others their defaults.
template <class F>
F with_members(const Values& numbers, const Vectors& vectors = {}) {
  F f;
  for (const MemberParam<F>& p : F::params)
    if (p.number && numbers.has(p.key)) f.*p.number = numbers[p.key];
  if constexpr (has_vectors<F>())
    for (const MemberParam<F>& p : F::params)
      if (const auto v = vectors.find(p.key); p.vector && v != vectors.end()) f.*p.vector = v->second;
  return f;
}

}  // namespace dreampm

// Numbers that go into fewer bits.
#pragma once
#include <limits>
#include <type_traits>
#include <utility>

#include "dreampm/base/error.h"

namespace dreampm {

/// `value` as a T. Throws RunError if T cannot hold it; `what` names what it counts, in the plural.
template <class T, class From>
constexpr T narrow(From value, const char* what) {
  static_assert(std::is_integral_v<T> && std::is_integral_v<From>);
  if (!std::in_range<T>(value))
    fail_run("{} {} are more than this program can number: at most {}", value, what, std::numeric_limits<T>::max());
  return static_cast<T>(value);
}

}  // namespace dreampm

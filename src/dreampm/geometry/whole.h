// Numbers of files, which are read as doubles, where whole ones are wanted.
#pragma once
#include <cmath>
#include <limits>
#include <optional>
#include <type_traits>

namespace dreampm {

/// The value as a T; nothing where it has a fraction, is no number, or is beyond what T holds.
template <class T>
  requires std::is_integral_v<T>
std::optional<T> whole(double value) {
  const double end = std::ldexp(1.0, std::numeric_limits<T>::digits);
  if (!(value >= (std::is_signed_v<T> ? -end : 0.0) && value < end) || value != std::floor(value)) return std::nullopt;
  return static_cast<T>(value);
}

}  // namespace dreampm

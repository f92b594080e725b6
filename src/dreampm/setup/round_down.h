// Numbers that messages offer.
#pragma once
#include <cmath>

namespace dreampm {

/// `x` > 0 rounded down to two digits. A number of two digits stays as it is, whatever rounding
/// left of it.
inline double two_digits(double x) {
  const double unit = std::pow(10, std::floor(std::log10(x)) - 1);
  return std::floor(x / unit * (1 + 1e-9)) * unit;
}

}  // namespace dreampm

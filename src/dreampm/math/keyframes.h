// Values that change with time: straight lines between keys, constant before the first and after
// the last.
#pragma once
#include <algorithm>
#include <cstddef>
#include <span>

#include "dreampm/model/motion.h"

namespace dreampm {

/// The value at time `t` [s]. `keys`: at least one, t strictly ascending.
template <class T>
T value_at(std::span<const Key<T>> keys, double t) {
  if (t <= keys.front().t) return keys.front().value;
  for (std::size_t i = 1; i < keys.size(); ++i)
    if (t < keys[i].t) {
      const Key<T>&a = keys[i - 1], &b = keys[i];
      const double s = (t - a.t) / (b.t - a.t);
      return a.value * (1 - s) + b.value * s;
    }
  return keys.back().value;
}

/// The mean over [from, to], exact: the trapezoid rule over the pieces. The value at `from` if to
/// <= from.
template <class T>
T mean_over(std::span<const Key<T>> keys, double from, double to) {
  if (!(to > from)) return value_at(keys, from);
  T sum = value_at(keys, from) * 0.0;
  double begin = from;
  const auto piece = [&](double end) {
    sum = sum + (value_at(keys, begin) + value_at(keys, end)) * (0.5 * (end - begin) / (to - from));
    begin = end;
  };
  for (const Key<T>& k : keys)
    if (k.t > begin && k.t < to) piece(k.t);
  piece(to);
  return sum;
}

}  // namespace dreampm

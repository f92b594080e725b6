// Sums over arrays in a device's memory, in an order that depends on nothing but their lengths.
#pragma once
#include <cstdint>

#include "dreampm/math/scalar.h"

namespace dreampm::gpu {

/// Adds up what threads of a block hold, one each, into the first of every `group` of them, a power
/// of two.
template <int threads, int group = threads, class Block, class T>
DM_FN void add_up_threads(Block& block, T* of) {
  for (int half = group / 2; half > 0; half /= 2)
    block.each_thread([&](int t) {
      if (t % group < half) of[t].add(of[t + half]);
    });
}

/// A part of an array.
struct Range {
  std::uint32_t begin, end;
};
/// Adds up each of some ranges; a block of threads takes one.
template <class T>
struct AddUp {
  static constexpr int threads = 128;
  struct Shared {
    T sums[threads];
  };
  const T* from;
  const Range* ranges;
  T* to;  ///< by range

  template <class Block>
  DM_FN void operator()(Block& block, Shared& shared) const {
    const int r = block.index();
    block.each_thread([&](int t) {
      T sum = T::none();
      for (std::uint32_t i = ranges[r].begin + static_cast<std::uint32_t>(t); i < ranges[r].end; i += threads)
        sum.add(from[i]);
      shared.sums[t] = sum;
    });
    add_up_threads<threads>(block, shared.sums);
    block.each_thread([&](int t) {
      if (t == 0) to[r] = shared.sums[0];
    });
  }
};

}  // namespace dreampm::gpu

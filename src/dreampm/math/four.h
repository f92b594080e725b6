// Some numbers in a register, such as the four of a node: compilers do not find such vectors by
// themselves in long loops. The operations on each number stay the same, and products and sums are
// not fused, so the results are the same bits.
#pragma once
#include <cstring>

namespace dreampm {

template <class R, int count>
struct NumbersOf {
  using Type [[gnu::vector_size(count * sizeof(R))]] = R;
};
/// Operators work number by number (an extension that g++ and clang share).
template <class R>
using Two = typename NumbersOf<R, 2>::Type;
template <class R>
using Four = typename NumbersOf<R, 4>::Type;
template <class R>
using Eight = typename NumbersOf<R, 8>::Type;

/// Loads four consecutive numbers, such as the members of an object.
template <class R>
[[gnu::always_inline]] inline void load(const void* from, Four<R>& to) {
  std::memcpy(&to, from, sizeof to);
}
template <class R>
[[gnu::always_inline]] inline void load_floats(const void* from, Four<R>& to) {
  Four<float> four;
  std::memcpy(&four, from, sizeof four);
  to = __builtin_convertvector(four, Four<R>);
}
template <class R>
[[gnu::always_inline]] inline void store(const Four<R>& from, void* to) {
  std::memcpy(to, &from, sizeof from);
}

}  // namespace dreampm

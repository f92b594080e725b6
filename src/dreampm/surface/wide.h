// Wider vector registers where the machine has them. The operations on each lane stay the same, and
// products and sums are not fused (-ffp-contract=off), so the results are the same bits.
#pragma once
#include <cstddef>
#include <cstring>
#if defined(__SSE2__)
#include <emmintrin.h>
#endif

#if defined(__x86_64__) && defined(__ELF__) && !defined(__SANITIZE_THREAD__) && !defined(__SANITIZE_ADDRESS__)
#define DM_WIDE __attribute__((target_clones("avx2", "default")))
#else
#define DM_WIDE
#endif

namespace dreampm::surface {

/// Eight floats; operators work lane by lane (an extension that g++ and clang share).
using Wide [[gnu::vector_size(32)]] = float;
inline constexpr std::size_t kLanes = 8;

[[gnu::always_inline]] inline void load(const float* from, Wide& to) { std::memcpy(&to, from, sizeof to); }
[[gnu::always_inline]] inline void store(const Wide& from, float* to) { std::memcpy(to, &from, sizeof from); }
/// Bit i is set where lane i of a comparison is true.
[[gnu::always_inline]] inline unsigned lane_bits(const decltype(Wide{} > Wide{})& is) {
#if defined(__SSE2__)
  __m128 low, high;
  std::memcpy(&low, &is, 16), std::memcpy(&high, reinterpret_cast<const char*>(&is) + 16, 16);
  return static_cast<unsigned>(_mm_movemask_ps(low)) | static_cast<unsigned>(_mm_movemask_ps(high)) << 4;
#else
  unsigned bits = 0;
  for (unsigned i = 0; i < kLanes; ++i) bits |= static_cast<unsigned>(is[i] != 0) << i;
  return bits;
#endif
}
/// The sum of the lanes, in one fixed order.
[[gnu::always_inline]] inline float lane_sum(const Wide& v) {
  return ((v[0] + v[4]) + (v[2] + v[6])) + ((v[1] + v[5]) + (v[3] + v[7]));
}

}  // namespace dreampm::surface

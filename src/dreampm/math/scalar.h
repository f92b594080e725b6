// The lane contract for plain numbers: what physics/ may call on any R (float, double, Lanes).
// Comparisons give a mask (here bool); select picks by it; mul_add and mul_sub are a*b + c and a*b
// - c without fusing, so that they need no libm.
#pragma once
#include <bit>
#include <cmath>
#include <concepts>
#include <cstdint>

// Marks what runs per particle or node: always inlined, so that a kernel object of one instruction
// set exports nothing. Where a device compiler reads it, it runs there too.
#if (defined(__CUDA__) || defined(__HIP__)) && defined(__clang__)
#define DM_FN __attribute__((host)) __attribute__((device)) __attribute__((always_inline)) inline
#elif defined(__CUDACC__)
#define DM_FN __host__ __device__ __forceinline__
#else
#define DM_FN __attribute__((always_inline)) inline
#endif

namespace dreampm {

template <class R>
struct LaneTraits {
  using Scalar = R;
  using Mask = bool;
  static constexpr int lanes = 1;
};
template <class R>
using Scalar = typename LaneTraits<R>::Scalar;

template <std::floating_point R>
DM_FN R select(bool m, R a, R b) {
  return m ? a : b;
}
template <std::floating_point R>
DM_FN R mul_add(R a, R b, R c) {
  return a * b + c;
}
template <std::floating_point R>
DM_FN R mul_sub(R a, R b, R c) {
  return a * b - c;
}
template <std::floating_point R>
DM_FN R min(R a, R b) {
  return a < b ? a : b;
}
template <std::floating_point R>
DM_FN R max(R a, R b) {
  return a > b ? a : b;
}
template <std::floating_point R>
DM_FN R abs(R a) {
  return a < 0 ? -a : a;
}
DM_FN float sqrt(float a) { return __builtin_sqrtf(a); }
DM_FN double sqrt(double a) { return __builtin_sqrt(a); }
/// The nearest integer, halves to even; |a| < 2^22 (float), 2^51 (double).
template <std::floating_point R>
DM_FN R round_int(R a) {
  constexpr R magic = sizeof(R) == 4 ? R(12582912) : R(6755399441055744.0);  // 1.5 * 2^(mantissa bits - 1)
  const R shifted = a + magic;
  return shifted - magic;
}
/// 2^n for integral n within the range of normal numbers.
DM_FN float exp2_int(float n) { return std::bit_cast<float>((static_cast<std::int32_t>(n) + 127) << 23); }
DM_FN double exp2_int(double n) { return std::bit_cast<double>((static_cast<std::int64_t>(n) + 1023) << 52); }
/// Returns for normal a > 0 the exponent n with a = m 2^n, m in [1, 2).
DM_FN float exponent_of(float a) { return static_cast<float>((std::bit_cast<std::int32_t>(a) >> 23) - 127); }
DM_FN double exponent_of(double a) { return static_cast<double>((std::bit_cast<std::int64_t>(a) >> 52) - 1023); }
DM_FN bool any(bool m) { return m; }

}  // namespace dreampm

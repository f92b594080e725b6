// A row of eight cells as a lane type, for the formulas of physics/: vectors of the compiler's, of
// whatever width the instruction set has.
#pragma once
#include <cstdint>
#include <type_traits>

#include "dreampm/math/four.h"
#include "dreampm/math/scalar.h"

namespace dreampm {

template <class R>
struct RowMask {
  using Int = std::conditional_t<sizeof(R) == 4, std::int32_t, std::int64_t>;
  using V = Eight<Int>;
  V m;
  friend DM_FN RowMask operator&&(const RowMask& a, const RowMask& b) { return {a.m & b.m}; }
  friend DM_FN RowMask operator||(const RowMask& a, const RowMask& b) { return {a.m | b.m}; }
  friend DM_FN RowMask operator!(const RowMask& a) { return {~a.m}; }
  /// Returns the mask of the cells in [begin, end).
  static DM_FN RowMask within(int begin, int end) {
    const V number{0, 1, 2, 3, 4, 5, 6, 7};
    return {(number >= static_cast<Int>(begin)) & (number < static_cast<Int>(end))};
  }
};
template <class R>
DM_FN bool any(const RowMask<R>& a) {
  typename RowMask<R>::Int all = 0;
  for (int l = 0; l < 8; ++l) all |= a.m[l];
  return all != 0;
}

template <class R>
struct RowOf {
  using V = Eight<R>;
  V v;

  RowOf() = default;
  DM_FN explicit RowOf(R a) : v(V{} + a) {}
  DM_FN explicit RowOf(const V& a) : v(a) {}
  static DM_FN RowOf load(const R* p) {
    RowOf a;
    __builtin_memcpy(&a.v, p, sizeof a.v);
    return a;
  }
  DM_FN void store(R* p) const { __builtin_memcpy(p, &v, sizeof v); }
  friend DM_FN RowOf operator+(const RowOf& a, const RowOf& b) { return RowOf(a.v + b.v); }
  friend DM_FN RowOf operator-(const RowOf& a, const RowOf& b) { return RowOf(a.v - b.v); }
  friend DM_FN RowOf operator*(const RowOf& a, const RowOf& b) { return RowOf(a.v * b.v); }
  friend DM_FN RowOf operator/(const RowOf& a, const RowOf& b) { return RowOf(a.v / b.v); }
  friend DM_FN RowOf operator-(const RowOf& a) { return RowOf(-a.v); }
  DM_FN RowOf& operator+=(const RowOf& b) { return *this = *this + b; }
  DM_FN RowOf& operator-=(const RowOf& b) { return *this = *this - b; }
  DM_FN RowOf& operator*=(const RowOf& b) { return *this = *this * b; }
  friend DM_FN RowMask<R> operator<(const RowOf& a, const RowOf& b) { return {a.v < b.v}; }
  friend DM_FN RowMask<R> operator>(const RowOf& a, const RowOf& b) { return {a.v > b.v}; }
  friend DM_FN RowMask<R> operator<=(const RowOf& a, const RowOf& b) { return {a.v <= b.v}; }
};
template <class R>
DM_FN RowOf<R> select(const RowMask<R>& m, const RowOf<R>& a, const RowOf<R>& b) {
  return RowOf<R>(m.m ? a.v : b.v);
}
template <class R>
DM_FN RowOf<R> min(const RowOf<R>& a, const RowOf<R>& b) {
  return select(a < b, a, b);
}
template <class R>
DM_FN RowOf<R> max(const RowOf<R>& a, const RowOf<R>& b) {
  return select(a > b, a, b);
}

template <class R>
struct LaneTraits<RowOf<R>> {
  using Scalar = R;
  using Mask = RowMask<R>;
  static constexpr int lanes = 8;
};

}  // namespace dreampm

// exp and log over the lane contract: no libm, so that scalar and lanes agree to a few ulp on every
// machine.
#pragma once
#include "dreampm/math/scalar.h"

namespace dreampm {

/// e^a, clamped to the range of normal numbers; 2 ulp. Range reduction by ln 2 in two parts (Cody
/// and Waite), then the Taylor series of the remainder |r| <= ln(2)/2.
template <class R>
DM_FN R exp(const R& a) {
  using S = Scalar<R>;
  constexpr bool single = sizeof(S) == 4;
  const R bounded = max(min(a, R(S(single ? 88.0 : 709.0))), R(S(single ? -87.0 : -708.0)));
  const R n = round_int(bounded * R(S(1.4426950408889634)));
  R r = mul_add(n, R(S(single ? -0.693145751953125 : -6.93147180369123816490e-01)), bounded);
  r = mul_add(n, R(S(single ? -1.42860682030941723e-6 : -1.90821492927058770002e-10)), r);
  constexpr int degree = single ? 7 : 13;
  S inverse_factorial[degree + 1]{S(1)};
  for (int k = 1; k <= degree; ++k) inverse_factorial[k] = inverse_factorial[k - 1] / S(k);
  R p(inverse_factorial[degree]);
  for (int k = degree - 1; k >= 0; --k) p = mul_add(p, r, R(inverse_factorial[k]));
  return p * exp2_int(n);
}

/// ln a for normal a > 0; 2 ulp. a = m 2^n with m in [sqrt(1/2), sqrt 2), then the series of atanh
/// in s = (m-1)/(m+1).
template <class R>
DM_FN R log(const R& a) {
  using S = Scalar<R>;
  constexpr bool single = sizeof(S) == 4;
  R n = exponent_of(a);
  R m = a * exp2_int(R(S(0)) - n);
  const auto high = m > R(S(1.4142135623730951));
  m = select(high, m * R(S(0.5)), m);
  n = select(high, n + R(S(1)), n);
  const R s = (m - R(S(1))) / (m + R(S(1)));
  const R s2 = s * s;
  constexpr int terms = single ? 5 : 11;
  R p(S(1.0 / (2 * terms - 1)));
  for (int k = terms - 1; k >= 1; --k) p = mul_add(p, s2, R(S(1.0 / (2 * k - 1))));
  return mul_add(n, R(S(0.6931471805599453)), (s + s) * p);
}

}  // namespace dreampm

// Lanes<float>: as many floats as the instruction set of this translation unit holds, over Highway in static mode. The
// type lives in a namespace of its instruction set, so that templates over it never share a symbol between kernels.
// Only kernel sources and tests include this; they are built with the flags of their set (DESIGN: -march alone silently
// falls to SSSE3).
#pragma once
#include <hwy/highway.h>

#include "dreampm/math/scalar.h"

#ifndef DM_ISA
#error "a file over lanes is built once per instruction set, with DM_ISA = sse4, avx2, avx512 or neon"
#endif

namespace dreampm {
namespace DM_ISA {

namespace hn = hwy::HWY_NAMESPACE;

template <class T>
struct Lanes;

struct LaneMask {
  using D = hn::ScalableTag<float>;
  hn::Mask<D> m;
  friend DM_FN LaneMask operator&&(LaneMask a, LaneMask b) { return {hn::And(a.m, b.m)}; }
  friend DM_FN LaneMask operator||(LaneMask a, LaneMask b) { return {hn::Or(a.m, b.m)}; }
  friend DM_FN LaneMask operator!(LaneMask a) { return {hn::Not(a.m)}; }
};

template <>
struct Lanes<float> {
  using D = hn::ScalableTag<float>;
  using V = hn::Vec<D>;
  static constexpr int count = HWY_LANES(float);
  V v;

  DM_FN Lanes() : v(hn::Zero(D())) {}
  DM_FN Lanes(V a) : v(a) {}
  DM_FN explicit Lanes(float a) : v(hn::Set(D(), a)) {}
  static DM_FN Lanes load(const float* p) { return hn::LoadU(D(), p); }
  DM_FN void store(float* p) const { hn::StoreU(v, D(), p); }

  friend DM_FN Lanes operator+(Lanes a, Lanes b) { return hn::Add(a.v, b.v); }
  friend DM_FN Lanes operator-(Lanes a, Lanes b) { return hn::Sub(a.v, b.v); }
  friend DM_FN Lanes operator*(Lanes a, Lanes b) { return hn::Mul(a.v, b.v); }
  friend DM_FN Lanes operator/(Lanes a, Lanes b) { return hn::Div(a.v, b.v); }
  friend DM_FN Lanes operator-(Lanes a) { return hn::Neg(a.v); }
  DM_FN Lanes& operator+=(Lanes b) { return *this = *this + b; }
  DM_FN Lanes& operator-=(Lanes b) { return *this = *this - b; }
  DM_FN Lanes& operator*=(Lanes b) { return *this = *this * b; }
  friend DM_FN LaneMask operator<(Lanes a, Lanes b) { return {hn::Lt(a.v, b.v)}; }
  friend DM_FN LaneMask operator>(Lanes a, Lanes b) { return {hn::Gt(a.v, b.v)}; }
  friend DM_FN LaneMask operator<=(Lanes a, Lanes b) { return {hn::Le(a.v, b.v)}; }
  friend DM_FN LaneMask operator>=(Lanes a, Lanes b) { return {hn::Ge(a.v, b.v)}; }
};

DM_FN Lanes<float> select(LaneMask m, Lanes<float> a, Lanes<float> b) { return hn::IfThenElse(m.m, a.v, b.v); }
DM_FN Lanes<float> mul_add(Lanes<float> a, Lanes<float> b, Lanes<float> c) { return hn::MulAdd(a.v, b.v, c.v); }
// As the scalar ones: a NaN in the first place gives the second.
DM_FN Lanes<float> min(Lanes<float> a, Lanes<float> b) { return select(a < b, a, b); }
DM_FN Lanes<float> max(Lanes<float> a, Lanes<float> b) { return select(a > b, a, b); }
DM_FN Lanes<float> abs(Lanes<float> a) { return hn::Abs(a.v); }
DM_FN Lanes<float> sqrt(Lanes<float> a) { return hn::Sqrt(a.v); }
DM_FN Lanes<float> round_int(Lanes<float> a) {
  const auto magic = hn::Set(LaneMask::D(), 12582912.0f);
  return hn::Sub(hn::Add(a.v, magic), magic);
}
DM_FN Lanes<float> exp2_int(Lanes<float> n) {
  const hn::RebindToSigned<LaneMask::D> di;
  return hn::BitCast(LaneMask::D(), hn::ShiftLeft<23>(hn::Add(hn::ConvertTo(di, n.v), hn::Set(di, 127))));
}
DM_FN Lanes<float> exponent_of(Lanes<float> a) {
  const hn::RebindToSigned<LaneMask::D> di;
  return hn::ConvertTo(LaneMask::D(), hn::Sub(hn::ShiftRight<23>(hn::BitCast(di, a.v)), hn::Set(di, 127)));
}
DM_FN bool any(LaneMask m) { return !hn::AllFalse(LaneMask::D(), m.m); }

/// Four floats: one grid node {x, y, z, mass}.
struct Quad {
  using D = hn::FixedTag<float, 4>;
  hn::Vec<D> v;
  DM_FN Quad() : v(hn::Zero(D())) {}
  DM_FN Quad(hn::Vec<D> a) : v(a) {}
  static DM_FN Quad load(const float* p) { return hn::Load(D(), p); }
  DM_FN void store(float* p) const { hn::Store(v, D(), p); }
  friend DM_FN Quad operator+(Quad a, Quad b) { return hn::Add(a.v, b.v); }
  friend DM_FN Quad operator*(Quad a, float s) { return hn::Mul(a.v, hn::Set(D(), s)); }
};

}  // namespace DM_ISA

template <>
struct LaneTraits<DM_ISA::Lanes<float>> {
  using Scalar = float;
  using Mask = DM_ISA::LaneMask;
  static constexpr int lanes = DM_ISA::Lanes<float>::count;
};

}  // namespace dreampm

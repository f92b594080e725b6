// Lanes<float>: as many floats as the instruction set of this translation unit holds, over Highway in static mode. The
// type lives in a namespace of its instruction set, so that templates over it never share a symbol between kernels.
// Only kernel sources and tests include this; they are built with the flags of their set (DESIGN: -march alone silently
// falls to SSSE3).
#pragma once
#include <hwy/highway.h>

#include <cstdint>

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

/// Loads of `count` records of four floats, one record a lane; and back.
DM_FN void load_records(const float* p, Lanes<float>& a, Lanes<float>& b, Lanes<float>& c, Lanes<float>& d) {
  hn::LoadInterleaved4(LaneMask::D(), p, a.v, b.v, c.v, d.v);
}
DM_FN void store_records(Lanes<float> a, Lanes<float> b, Lanes<float> c, Lanes<float> d, float* p) {
  hn::StoreInterleaved4(a.v, b.v, c.v, d.v, LaneMask::D(), p);
}

/// Four floats: one grid node {x, y, z, mass}.
struct Quad {
  using D = hn::FixedTag<float, 4>;
  hn::Vec<D> v;
  DM_FN void store(float* p) const { hn::Store(v, D(), p); }
};

/// A row of nodes along z, x y z mass of each: three, and where vectors are wider than a node a fourth, whose weight is
/// zero.
struct QuadRow {
  using Node = Quad;
  using D = hn::CappedTag<float, 16>;
  using V = hn::Vec<D>;
  static constexpr int lanes = HWY_LANES(float) < 16 ? HWY_LANES(float) : 16;
  static constexpr int parts = lanes == 4 ? 3 : 16 / lanes;
  static constexpr int floats = lanes * parts;

  /// From records {w0, w1, w2, anything}.
  struct Weights {
    V v[parts];
    explicit DM_FN Weights(const float* w) {
      alignas(64) static constexpr std::int32_t node_of[16] = {0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3};
      for (int p = 0; p < parts; ++p) {
        v[p] = hn::TableLookupLanes(hn::LoadDup128(D(), w), hn::SetTableIndices(D(), node_of + p * lanes));
        if ((p + 1) * lanes > 12)
          v[p] = hn::IfThenElseZero(hn::FirstN(D(), static_cast<std::size_t>(12 - p * lanes)), v[p]);
      }
    }
  };

  V v[parts];
  DM_FN QuadRow() {
    for (auto& part : v) part = hn::Zero(D());
  }
  static DM_FN QuadRow load(const float* p) {
    QuadRow r;
    for (int i = 0; i < parts; ++i) r.v[i] = hn::LoadU(D(), p + i * lanes);
    return r;
  }
  DM_FN void store(float* p) const {
    for (int i = 0; i < parts; ++i) hn::StoreU(v[i], D(), p + i * lanes);
  }
  friend DM_FN QuadRow operator+(const QuadRow& a, const QuadRow& b) {
    QuadRow r;
    for (int i = 0; i < parts; ++i) r.v[i] = hn::Add(a.v[i], b.v[i]);
    return r;
  }
  friend DM_FN QuadRow operator*(const QuadRow& a, float s) {
    QuadRow r;
    for (int i = 0; i < parts; ++i) r.v[i] = hn::Mul(a.v[i], hn::Set(D(), s));
    return r;
  }
  friend DM_FN QuadRow mul_add(const QuadRow& a, float s, const QuadRow& b) {
    QuadRow r;
    for (int i = 0; i < parts; ++i) r.v[i] = hn::MulAdd(a.v[i], hn::Set(D(), s), b.v[i]);
    return r;
  }
  /// `node`: four floats, aligned to 16 bytes.
  static DM_FN QuadRow spread(const float* node, const Weights& w) {
    QuadRow r;
    for (int i = 0; i < parts; ++i) r.v[i] = hn::Mul(hn::LoadDup128(D(), node), w.v[i]);
    return r;
  }
  friend DM_FN Quad collapse(const QuadRow& a, const Weights& w) {
    V sum = hn::Mul(a.v[0], w.v[0]);
    for (int i = 1; i < parts; ++i) sum = hn::MulAdd(a.v[i], w.v[i], sum);
    return fold(sum);
  }

 private:
  /// The sum of a vector's nodes.
  template <class Vector>
  static DM_FN Quad fold(const Vector& v) {
    using Tag = hn::DFromV<Vector>;
    if constexpr (hn::MaxLanes(Tag()) == 4) {
      return {v};
    } else {
      const hn::Half<Tag> half;
      return fold(hn::Add(hn::LowerHalf(half, v), hn::UpperHalf(half, v)));
    }
  }
};

}  // namespace DM_ISA

template <>
struct LaneTraits<DM_ISA::Lanes<float>> {
  using Scalar = float;
  using Mask = DM_ISA::LaneMask;
  static constexpr int lanes = DM_ISA::Lanes<float>::count;
};

}  // namespace dreampm

// Vectors of 16 floats as pairs of what the instruction set has, in place of Highway's
// (math/lanes.h: DM_VECTORS): with them the code for AVX-512 runs on a machine that has no more
// than AVX2, to the same bits.
#pragma once
#include <hwy/highway.h>

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "dreampm/math/scalar.h"

namespace dreampm::DM_ISA {
inline constexpr int vector_floats = 16;

namespace hn {
namespace one = hwy::HWY_NAMESPACE;

/// Two vectors, or two masks.
template <class V>
struct Two {
  V low, high;
};
template <class V>
DM_FN Two<V> both(V low, V high) {
  return {low, high};
}
/// A tag of 64 bytes of numbers.
template <class T>
struct ScalableTag {
  static_assert(HWY_LANES(float) == 8);
  using Half = one::ScalableTag<T>;
  static constexpr std::size_t half = HWY_LANES(T);
};

// Vectors that fit the instruction set stay Highway's own.
template <class T, std::size_t count>
using CappedTag = std::conditional_t<(count * sizeof(T) > 32), ScalableTag<T>, one::CappedTag<T, count>>;
template <class D>
struct TypesOf {
  using Vec = one::Vec<D>;
  template <class T>
  using Repartition = one::Repartition<T, D>;
};
template <class T>
struct TypesOf<ScalableTag<T>> {
  using Vec = Two<one::Vec<typename ScalableTag<T>::Half>>;
  using Mask = Two<one::Mask<typename ScalableTag<T>::Half>>;
  using Signed = ScalableTag<std::int32_t>;
  using Wide = ScalableTag<double>;
  template <class U>
  using Repartition = ScalableTag<U>;
};
template <class D>
using Vec = typename TypesOf<D>::Vec;
template <class D>
using Mask = typename TypesOf<D>::Mask;
template <class D>
using RebindToSigned = typename TypesOf<D>::Signed;
template <class D>
using RepartitionToWide = typename TypesOf<D>::Wide;
template <class T, class D>
using Repartition = typename TypesOf<D>::template Repartition<T>;

// Half by half: all of these know no lanes but their own and those of their four.
#define DM_OF_ONE(name)                               \
  using one::name;                                    \
  template <class V>                                  \
  DM_FN auto name(const Two<V>& a) {                  \
    return both(one::name(a.low), one::name(a.high)); \
  }
#define DM_OF_TWO(name)                                              \
  using one::name;                                                   \
  template <class V>                                                 \
  DM_FN auto name(const Two<V>& a, const Two<V>& b) {                \
    return both(one::name(a.low, b.low), one::name(a.high, b.high)); \
  }
#define DM_OF_THREE(name)                                                           \
  using one::name;                                                                  \
  template <class A, class V>                                                       \
  DM_FN auto name(const Two<A>& a, const Two<V>& b, const Two<V>& c) {              \
    return both(one::name(a.low, b.low, c.low), one::name(a.high, b.high, c.high)); \
  }
DM_OF_ONE(Abs)
DM_OF_ONE(Neg)
DM_OF_ONE(Not)
DM_OF_ONE(Sqrt)
DM_OF_ONE(SwapAdjacentBlocks)
DM_OF_TWO(Add)
DM_OF_TWO(And)
DM_OF_TWO(Div)
DM_OF_TWO(Eq)
DM_OF_TWO(Ge)
DM_OF_TWO(Gt)
DM_OF_TWO(Le)
DM_OF_TWO(Lt)
DM_OF_TWO(Max)
DM_OF_TWO(Min)
DM_OF_TWO(Mul)
DM_OF_TWO(Ne)
DM_OF_TWO(OddEvenBlocks)
DM_OF_TWO(Or)
DM_OF_TWO(Sub)
DM_OF_TWO(TableLookupBytes)
DM_OF_THREE(IfThenElse)
DM_OF_THREE(MulAdd)
DM_OF_THREE(MulSub)
#undef DM_OF_ONE
#undef DM_OF_TWO
#undef DM_OF_THREE
#define DM_TO(name)                                         \
  using one::name;                                          \
  template <class T, class V>                               \
  DM_FN auto name(ScalableTag<T>, const Two<V>& a) {        \
    constexpr typename ScalableTag<T>::Half d;              \
    return both(one::name(d, a.low), one::name(d, a.high)); \
  }
DM_TO(BitCast)
DM_TO(ConvertTo)
DM_TO(RebindMask)
#undef DM_TO
template <class T, class V>
DM_FN Two<V> InterleaveLower(ScalableTag<T>, const Two<V>& a, const Two<V>& b) {
  constexpr typename ScalableTag<T>::Half d;
  return {one::InterleaveLower(d, a.low, b.low), one::InterleaveLower(d, a.high, b.high)};
}
template <class T, class V>
DM_FN Two<V> InterleaveUpper(ScalableTag<T>, const Two<V>& a, const Two<V>& b) {
  constexpr typename ScalableTag<T>::Half d;
  return {one::InterleaveUpper(d, a.low, b.low), one::InterleaveUpper(d, a.high, b.high)};
}
template <int bits, class V>
DM_FN Two<V> ShiftLeft(const Two<V>& a) {
  return {one::ShiftLeft<bits>(a.low), one::ShiftLeft<bits>(a.high)};
}
template <int bits, class V>
DM_FN Two<V> ShiftRight(const Two<V>& a) {
  return {one::ShiftRight<bits>(a.low), one::ShiftRight<bits>(a.high)};
}

using one::Load;
using one::LoadDup128;
using one::LoadU;
using one::Set;
using one::StoreU;
using one::Zero;
template <class T>
DM_FN auto Zero(ScalableTag<T>) {
  constexpr typename ScalableTag<T>::Half d;
  return both(one::Zero(d), one::Zero(d));
}
template <class T, class Value>
DM_FN auto Set(ScalableTag<T>, Value value) {
  constexpr typename ScalableTag<T>::Half d;
  return both(one::Set(d, static_cast<T>(value)), one::Set(d, static_cast<T>(value)));
}
template <class T>
DM_FN auto LoadU(ScalableTag<T>, const T* p) {
  constexpr typename ScalableTag<T>::Half d;
  return both(one::LoadU(d, p), one::LoadU(d, p + ScalableTag<T>::half));
}
template <class T>
DM_FN auto Load(ScalableTag<T> d, const T* p) {
  return LoadU(d, p);
}
template <class T>
DM_FN auto LoadDup128(ScalableTag<T>, const T* p) {
  constexpr typename ScalableTag<T>::Half d;
  return both(one::LoadDup128(d, p), one::LoadDup128(d, p));
}
template <class T>
DM_FN void StoreU(const Vec<ScalableTag<T>>& v, ScalableTag<T>, T* p) {
  constexpr typename ScalableTag<T>::Half d;
  one::StoreU(v.low, d, p), one::StoreU(v.high, d, p + ScalableTag<T>::half);
}
DM_FN void LoadInterleaved4(ScalableTag<float>, const float* p, Vec<ScalableTag<float>>& a, Vec<ScalableTag<float>>& b,
                            Vec<ScalableTag<float>>& c, Vec<ScalableTag<float>>& d) {
  constexpr ScalableTag<float>::Half half;
  one::LoadInterleaved4(half, p, a.low, b.low, c.low, d.low);
  one::LoadInterleaved4(half, p + 32, a.high, b.high, c.high, d.high);
}
DM_FN void StoreInterleaved4(const Vec<ScalableTag<float>>& a, const Vec<ScalableTag<float>>& b,
                             const Vec<ScalableTag<float>>& c, const Vec<ScalableTag<float>>& d, ScalableTag<float>,
                             float* p) {
  constexpr ScalableTag<float>::Half half;
  one::StoreInterleaved4(a.low, b.low, c.low, d.low, half, p);
  one::StoreInterleaved4(a.high, b.high, c.high, d.high, half, p + 32);
}

// Across the halves.
using one::Combine;
template <class V>
DM_FN Two<V> Combine(ScalableTag<float>, V high, V low) {
  return {low, high};
}
template <class V>
DM_FN Two<V> ConcatLowerLower(ScalableTag<float>, const Two<V>& high, const Two<V>& low) {
  return {low.low, high.low};
}
template <class V>
DM_FN Two<V> ConcatUpperUpper(ScalableTag<float>, const Two<V>& high, const Two<V>& low) {
  return {low.high, high.high};
}
template <class V>
DM_FN float GetLane(const Two<V>& v) {
  return one::GetLane(v.low);
}
// In the order of AVX-512's: halves, then fours, then twos.
template <class V>
DM_FN Two<V> SumOfLanes(ScalableTag<float>, const Two<V>& v) {
  const V all = one::SumOfLanes(ScalableTag<float>::Half(), one::Add(v.low, v.high));
  return {all, all};
}
template <class V>
DM_FN Two<V> MinOfLanes(ScalableTag<float>, const Two<V>& v) {
  const V all = one::MinOfLanes(ScalableTag<float>::Half(), one::Min(v.low, v.high));
  return {all, all};
}
template <class V>
DM_FN Two<V> MaxOfLanes(ScalableTag<float>, const Two<V>& v) {
  const V all = one::MaxOfLanes(ScalableTag<float>::Half(), one::Max(v.low, v.high));
  return {all, all};
}
template <class M>
DM_FN bool AllFalse(ScalableTag<float>, const Two<M>& m) {
  constexpr ScalableTag<float>::Half d;
  return one::AllFalse(d, m.low) && one::AllFalse(d, m.high);
}
template <class M>
DM_FN void StoreMaskBits(ScalableTag<float>, const Two<M>& m, std::uint8_t* bits) {
  constexpr ScalableTag<float>::Half d;
  one::StoreMaskBits(d, m.low, bits), one::StoreMaskBits(d, m.high, bits + 1);
}
DM_FN Mask<ScalableTag<float>> LoadMaskBits(ScalableTag<float>, const std::uint8_t* bits) {
  constexpr ScalableTag<float>::Half d;
  // It reads eight bytes.
  const std::uint8_t low[8] = {bits[0]}, high[8] = {bits[1]};
  return {one::LoadMaskBits(d, low), one::LoadMaskBits(d, high)};
}
DM_FN Mask<ScalableTag<float>> FirstN(ScalableTag<float>, std::size_t n) {
  constexpr ScalableTag<float>::Half d;
  return {one::FirstN(d, n < 8 ? n : 8), one::FirstN(d, n < 8 ? 0 : n - 8)};
}
}  // namespace hn

/// The pick as with AVX-512 in math/lanes.h.
template <class V, class Numbers>
DM_FN hn::Two<V> pick_of_two(const hn::Two<V>& first, const hn::Two<V>& second, const hn::Two<Numbers>& numbers) {
  constexpr hn::ScalableTag<float> d;
  constexpr hn::ScalableTag<std::int32_t> di;
  float from[32], picked[16];
  std::int32_t number[16];
  hn::StoreU(first, d, from), hn::StoreU(second, d, from + 16), hn::StoreU(numbers, di, number);
  for (int l = 0; l < 16; ++l) picked[l] = from[number[l] & 31];
  return hn::LoadU(d, picked);
}
template <class V, class Numbers>
DM_FN hn::Two<V> pick_of_one(const hn::Two<V>& from, const hn::Two<Numbers>& numbers) {
  return pick_of_two(from, from, numbers);
}

}  // namespace dreampm::DM_ISA

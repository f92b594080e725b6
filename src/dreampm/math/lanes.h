// Lanes<float>: as many floats as the instruction set of this translation unit holds, over Highway
// in static mode. The type lives in a namespace of its instruction set, so that templates over it
// never share a symbol between kernels. Only kernel sources and tests include this; they are built
// with the flags of their set (DESIGN: -march alone silently falls to SSSE3).
#pragma once
#include <hwy/highway.h>

#include <bit>
#include <cstdint>

#include "dreampm/math/scalar.h"

#ifndef DM_ISA
#error "a file over lanes is built once per instruction set, with DM_ISA = sse4, avx2, avx512 or neon"
#endif

// Tests build the code for 16 lanes over pairs of vectors, which run where there is no AVX-512:
// their header gives what is here of Highway.
#ifdef DM_VECTORS
#include DM_VECTORS
#define DM_SIXTEEN_LANES
#else
namespace dreampm::DM_ISA {
namespace hn = hwy::HWY_NAMESPACE;
inline constexpr int vector_floats = HWY_LANES(float);

#ifdef __AVX512F__
#define DM_SIXTEEN_LANES
// Highway 1.0 knows no lookup in two vectors.
/// Of the floats in `first` and, from number 16 on, in `second`, those with these numbers.
DM_FN auto pick_of_two(hn::Vec<hn::ScalableTag<float>> first, hn::Vec<hn::ScalableTag<float>> second,
                       hn::Vec<hn::ScalableTag<std::int32_t>> numbers) {
  return decltype(first){_mm512_permutex2var_ps(first.raw, numbers.raw, second.raw)};
}
DM_FN auto pick_of_one(hn::Vec<hn::ScalableTag<float>> from, hn::Vec<hn::ScalableTag<std::int32_t>> numbers) {
  return decltype(from){_mm512_permutexvar_ps(numbers.raw, from.raw)};
}
#endif
}  // namespace dreampm::DM_ISA
#endif

namespace dreampm {
namespace DM_ISA {

template <class T>
struct Lanes;

// Vectors are `mutable` for g++'s sake: constants of a class type without such a member are stores
// to memory that it takes for read-only, and it keeps none of them in registers (tree-sra: "store
// to a read-only decl").
struct LaneMask {
  using D = hn::ScalableTag<float>;
  mutable hn::Mask<D> m;
  friend DM_FN LaneMask operator&&(LaneMask a, LaneMask b) { return {hn::And(a.m, b.m)}; }
  friend DM_FN LaneMask operator||(LaneMask a, LaneMask b) { return {hn::Or(a.m, b.m)}; }
  friend DM_FN LaneMask operator!(LaneMask a) { return {hn::Not(a.m)}; }
};

template <>
struct Lanes<float> {
  using D = hn::ScalableTag<float>;
  using V = hn::Vec<D>;
  static constexpr int count = vector_floats;
  mutable V v;

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
  friend DM_FN LaneMask operator==(Lanes a, Lanes b) { return {hn::Eq(a.v, b.v)}; }
  friend DM_FN LaneMask operator!=(Lanes a, Lanes b) { return {hn::Ne(a.v, b.v)}; }
  friend DM_FN LaneMask operator<(Lanes a, Lanes b) { return {hn::Lt(a.v, b.v)}; }
  friend DM_FN LaneMask operator>(Lanes a, Lanes b) { return {hn::Gt(a.v, b.v)}; }
  friend DM_FN LaneMask operator<=(Lanes a, Lanes b) { return {hn::Le(a.v, b.v)}; }
  friend DM_FN LaneMask operator>=(Lanes a, Lanes b) { return {hn::Ge(a.v, b.v)}; }
};

DM_FN Lanes<float> select(LaneMask m, Lanes<float> a, Lanes<float> b) { return hn::IfThenElse(m.m, a.v, b.v); }
DM_FN Lanes<float> mul_add(Lanes<float> a, Lanes<float> b, Lanes<float> c) { return hn::MulAdd(a.v, b.v, c.v); }
DM_FN Lanes<float> mul_sub(Lanes<float> a, Lanes<float> b, Lanes<float> c) { return hn::MulSub(a.v, b.v, c.v); }
// The minimum and maximum as for scalars: a NaN in the first place gives the second. So do the
// instructions of x86.
#if HWY_ARCH_X86
DM_FN Lanes<float> min(Lanes<float> a, Lanes<float> b) { return hn::Min(a.v, b.v); }
DM_FN Lanes<float> max(Lanes<float> a, Lanes<float> b) { return hn::Max(a.v, b.v); }
#else
DM_FN Lanes<float> min(Lanes<float> a, Lanes<float> b) { return select(a < b, a, b); }
DM_FN Lanes<float> max(Lanes<float> a, Lanes<float> b) { return select(a > b, a, b); }
#endif
DM_FN Lanes<float> abs(Lanes<float> a) { return hn::Abs(a.v); }
DM_FN Lanes<float> sqrt(Lanes<float> a) { return hn::Sqrt(a.v); }
/// 1.5 2^23: a sum with it has a whole number in its last bits.
inline constexpr float whole_magic = 12582912.0f;
DM_FN Lanes<float> round_int(Lanes<float> a) {
  const auto magic = hn::Set(LaneMask::D(), whole_magic);
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
DM_FN float sum_of(Lanes<float> a) { return hn::GetLane(hn::SumOfLanes(LaneMask::D(), a.v)); }
DM_FN float smallest_of(Lanes<float> a) { return hn::GetLane(hn::MinOfLanes(LaneMask::D(), a.v)); }
DM_FN float largest_of(Lanes<float> a) { return hn::GetLane(hn::MaxOfLanes(LaneMask::D(), a.v)); }

// Bits of masks in one piece: put together from bytes it takes longer than a comparison.
static_assert(std::endian::native == std::endian::little);
/// A bit for each lane.
DM_FN std::uint64_t bits_of(LaneMask m) {
  std::uint64_t bits = 0;
  hn::StoreMaskBits(LaneMask::D(), m.m, reinterpret_cast<std::uint8_t*>(&bits));
  return bits;
}
DM_FN LaneMask mask_of(std::uint64_t bits) {
  return {hn::LoadMaskBits(LaneMask::D(), reinterpret_cast<const std::uint8_t*>(&bits))};
}

DM_FN float lane0(Lanes<float> a) { return hn::GetLane(a.v); }

DM_FN LaneMask first_lanes(int n) { return {hn::FirstN(LaneMask::D(), static_cast<std::size_t>(n))}; }
/// Whole numbers up to 2^22 as integers, plus the bits of whole_magic. Highway's ConvertTo takes
/// care of numbers beyond all integers too, with five more instructions.
DM_FN auto whole_bits(Lanes<float> a) {
  return hn::BitCast(hn::RebindToSigned<LaneMask::D>(), hn::Add(a.v, hn::Set(LaneMask::D(), whole_magic)));
}
DM_FN void store_whole(Lanes<float> a, std::int32_t* p) {
  const hn::RebindToSigned<LaneMask::D> di;
  hn::StoreU(hn::Sub(whole_bits(a), hn::Set(di, std::bit_cast<std::int32_t>(whole_magic))), di, p);
}
/// One bit for each of `count` integers that equals `value`.
DM_FN std::uint64_t lanes_equal(const std::int32_t* p, std::int32_t value) {
  constexpr hn::RebindToSigned<LaneMask::D> di;
  return bits_of({hn::RebindMask(LaneMask::D(), hn::Eq(hn::LoadU(di, p), hn::Set(di, value)))});
}

/// The first `n` of the lanes. Idle lanes repeat the last, so that they can neither trap nor change
/// a maximum.
DM_FN Lanes<float> load_first(const float* p, int n) {
  constexpr int W = Lanes<float>::count;
  if (n == W) return Lanes<float>::load(p);
#if HWY_MEM_OPS_MIGHT_FAULT
  float v[W];
  for (int l = 0; l < W; ++l) v[l] = p[l < n ? l : n - 1];
  return Lanes<float>::load(v);
#else
  const LaneMask used = first_lanes(n);
  return select(used, Lanes<float>(hn::MaskedLoad(used.m, LaneMask::D(), p)), Lanes<float>(p[n - 1]));
#endif
}
DM_FN void store_first(Lanes<float> a, float* p, int n) {
  constexpr int W = Lanes<float>::count;
  if (n == W) return a.store(p);
#if HWY_MEM_OPS_MIGHT_FAULT
  float v[W];
  a.store(v);
  for (int l = 0; l < n; ++l) p[l] = v[l];
#else
  hn::BlendedStore(a.v, first_lanes(n).m, LaneMask::D(), p);
#endif
}

#ifndef DM_SIXTEEN_LANES
/// Indices of each lane into four floats, by bytes, for AMD's processors look up slowly across
/// eight lanes.
class FourPick {
 public:
  /// `index`: whole numbers from 0 to 3.
  explicit DM_FN FourPick(Lanes<float> index) {
    const auto number = hn::And(whole_bits(index), hn::Set(Di(), 3));
    // Its four bytes are 4 index + {0, 1, 2, 3}.
    bytes_ = hn::BitCast(Bytes(), hn::Add(hn::Mul(number, hn::Set(Di(), 0x04040404)), hn::Set(Di(), 0x03020100)));
  }
  DM_FN Lanes<float> of(const float* four) const {
    return hn::BitCast(D(), hn::TableLookupBytes(hn::BitCast(Bytes(), hn::LoadDup128(D(), four)), bytes_));
  }

 private:
  using D = LaneMask::D;
  using Di = hn::RebindToSigned<D>;
  using Bytes = hn::Repartition<std::uint8_t, D>;
  mutable hn::Vec<Bytes> bytes_;
};
#else
/// Indices of each lane into rows of eight floats: two that lie side by side, or twice two.
class SquarePick {
 public:
  SquarePick() = default;
  /// `index`: whole numbers; those of a second row count from 8 on, those of the second pair from
  /// 16.
  explicit DM_FN SquarePick(Lanes<float> index) : numbers_(hn::And(whole_bits(index), hn::Set(Di(), 31))) {}
  DM_FN Lanes<float> of(const float* pair) const { return pick_of_one(hn::LoadU(D(), pair), numbers_); }
  DM_FN Lanes<float> of(const float* first, const float* second) const {
    return pick_of_two(hn::LoadU(D(), first), hn::LoadU(D(), second), numbers_);
  }

 private:
  using D = LaneMask::D;
  using Di = hn::RebindToSigned<D>;
  mutable hn::Vec<Di> numbers_;
};
#endif

/// A vector of `floats` floats out of fours: four(lane), four(lane + 4), ...
template <int floats, class Four>
DM_FN auto join_fours(const Four& four, int lane) {
  if constexpr (floats == 4)
    return four(lane);
  else
    return hn::Combine(hn::CappedTag<float, floats>(), join_fours<floats / 2>(four, lane + floats / 2),
                       join_fours<floats / 2>(four, lane));
}
/// For every lane the three floats from `from + offset[lane]` on; a fourth is read.
DM_FN void load_threes(const float* from, const std::int32_t (&offset)[Lanes<float>::count],
                       Lanes<float> (&numbers)[3]) {
  constexpr LaneMask::D df;
  const hn::RepartitionToWide<LaneMask::D> dd;
  const auto fours = [&](int lane) __attribute__((always_inline)) {
    return join_fours<Lanes<float>::count>(
        [&](int l) __attribute__((always_inline)) { return hn::LoadU(hn::CappedTag<float, 4>(), from + offset[l]); },
        lane);
  };
  const auto a = fours(0), b = fours(1), c = fours(2), d = fours(3);
  const auto ab0 = hn::BitCast(dd, hn::InterleaveLower(df, a, b)), cd0 = hn::BitCast(dd, hn::InterleaveLower(df, c, d));
  const auto ab2 = hn::BitCast(dd, hn::InterleaveUpper(df, a, b)), cd2 = hn::BitCast(dd, hn::InterleaveUpper(df, c, d));
  numbers[0] = hn::BitCast(df, hn::InterleaveLower(dd, ab0, cd0));
  numbers[1] = hn::BitCast(df, hn::InterleaveUpper(dd, ab0, cd0));
  numbers[2] = hn::BitCast(df, hn::InterleaveLower(dd, ab2, cd2));
}

/// Every lane's four numbers as a record of four floats. The records lie in an order that takes the
/// fewest shuffles: that of a lane is number record_of(lane).
constexpr int record_of(int lane) {
  constexpr int blocks = Lanes<float>::count / 4;
  return lane % 4 * blocks + lane / 4;
}
DM_FN void store_records(Lanes<float> a, Lanes<float> b, Lanes<float> c, Lanes<float> d, float* p) {
  constexpr LaneMask::D df;
  const hn::RepartitionToWide<LaneMask::D> dd;
  const auto lower = [&](auto x, auto y) { return hn::BitCast(dd, hn::InterleaveLower(df, x.v, y.v)); };
  const auto upper = [&](auto x, auto y) { return hn::BitCast(dd, hn::InterleaveUpper(df, x.v, y.v)); };
  const auto ab0 = lower(a, b), cd0 = lower(c, d), ab2 = upper(a, b), cd2 = upper(c, d);
  const auto store = [&](int i, auto v) { hn::StoreU(hn::BitCast(df, v), df, p + i * Lanes<float>::count); };
  store(0, hn::InterleaveLower(dd, ab0, cd0));
  store(1, hn::InterleaveUpper(dd, ab0, cd0));
  store(2, hn::InterleaveLower(dd, ab2, cd2));
  store(3, hn::InterleaveUpper(dd, ab2, cd2));
}

/// The places of bytes for a lookup in fours of floats: the n-th four gets its own number n, four
/// times.
struct NumberOfFour {
  alignas(64) std::uint8_t bytes[64];
  constexpr NumberOfFour() : bytes{} {
    for (int b = 0; b < 64; ++b) bytes[b] = static_cast<std::uint8_t>(b / 16 * 4 + b % 4);
  }
};
inline constexpr NumberOfFour number_of_four;

/// Neighbors along z of a row of nodes, each {x, y, z, mass}: `most` of them, or as many as a
/// vector holds.
template <int most>
struct NodesVec {
  using D = hn::CappedTag<float, 4 * most>;
  using V = hn::Vec<D>;
  static constexpr int lanes = vector_floats < 4 * most ? vector_floats : 4 * most, nodes = lanes / 4;
  mutable V v;

  DM_FN NodesVec() : v(hn::Zero(D())) {}
  DM_FN NodesVec(V a) : v(a) {}
  static DM_FN NodesVec load(const float* p) { return hn::LoadU(D(), p); }
  DM_FN void store(float* p) const { hn::StoreU(v, D(), p); }
  /// The same four numbers in every node. `node`: aligned to 16 bytes.
  static DM_FN NodesVec repeat(const float* node) { return hn::LoadDup128(D(), node); }
  /// Returns the four numbers of the nodes from `first` on, one number a node, four times each.
  /// `record`: aligned to 16 bytes.
  static DM_FN NodesVec each(const float* record, int first) {
    using Bytes = hn::Repartition<std::uint8_t, D>;
    const auto four = hn::BitCast(Bytes(), hn::LoadDup128(D(), record));
    return hn::BitCast(D(), hn::TableLookupBytes(four, hn::Load(Bytes(), number_of_four.bytes + 16 * first)));
  }
  friend DM_FN NodesVec operator+(const NodesVec& a, const NodesVec& b) { return hn::Add(a.v, b.v); }
  friend DM_FN NodesVec operator-(const NodesVec& a, const NodesVec& b) { return hn::Sub(a.v, b.v); }
  friend DM_FN NodesVec operator*(const NodesVec& a, const NodesVec& b) { return hn::Mul(a.v, b.v); }
  friend DM_FN NodesVec mul_add(const NodesVec& a, const NodesVec& b, const NodesVec& c) {
    return hn::MulAdd(a.v, b.v, c.v);
  }
  /// a s + b
  friend DM_FN NodesVec mul_add(const NodesVec& a, float s, const NodesVec& b) {
    return hn::MulAdd(a.v, hn::Set(D(), s), b.v);
  }
};
using NodeVec = NodesVec<4>;
using NodePair = NodesVec<2>;
using OneNode = NodesVec<1>;

/// Rows of eight nodes along z, by their numbers: a vector has that of the eight neighbors of
/// nodes of two rows, of one row, or of a part of one. What lies beyond the ends of a row is one of
/// its nodes.
class NodeRows {
 public:
  static constexpr int lanes = Lanes<float>::count, rows = lanes > 8 ? lanes / 8 : 1, parts = lanes < 8 ? 8 / lanes : 1;

  /// `half[row][h]`: where the first four nodes of a row lie, and the last four, each {x, y, z,
  /// mass}.
  DM_FN NodeRows(const float* const (&half)[rows][2], int part) {
    Lanes<float> nodes[6];
    load(half, part, nodes);
#pragma GCC unroll 5
    for (int k = 0; k < 5; ++k) {
      lower_[k] = hn::InterleaveLower(D(), nodes[k].v, nodes[k + 1].v);
      upper_[k] = hn::InterleaveUpper(D(), nodes[k].v, nodes[k + 1].v);
    }
  }
  /// The number `c` of the nodes before those eight (`first` 0), of those themselves (1), and of
  /// those after them (2).
  DM_FN Lanes<float> number(int c, int first) const {
    const hn::RepartitionToWide<D> dd;
    const Lanes<float>(&pairs)[5] = c < 2 ? lower_ : upper_;
    const auto a = hn::BitCast(dd, pairs[first].v), b = hn::BitCast(dd, pairs[first + 2].v);
    return hn::BitCast(D(), c % 2 == 0 ? hn::InterleaveLower(dd, a, b) : hn::InterleaveUpper(dd, a, b));
  }

 private:
  using D = LaneMask::D;

  /// nodes[k]: node k - 1 of every row and node k + 3, one after the other.
  static DM_FN void load(const float* const (&half)[rows][2], int part, Lanes<float> (&nodes)[6]) {
    if constexpr (lanes == 16) {
      const auto at = [&](int row, int h) __attribute__((always_inline)) { return hn::LoadU(D(), half[row][h]); };
      const auto first = at(0, 0), second = at(0, 1), third = at(1, 0), fourth = at(1, 1);
      const auto a01 = hn::ConcatLowerLower(D(), third, first), b01 = hn::ConcatLowerLower(D(), fourth, second);
      const auto a23 = hn::ConcatUpperUpper(D(), third, first), b23 = hn::ConcatUpperUpper(D(), fourth, second);
      nodes[0] = a23;
      nodes[1] = hn::OddEvenBlocks(hn::SwapAdjacentBlocks(b01), a01);
      nodes[2] = hn::OddEvenBlocks(b01, hn::SwapAdjacentBlocks(a01));
      nodes[3] = hn::OddEvenBlocks(hn::SwapAdjacentBlocks(b23), a23);
      nodes[4] = hn::OddEvenBlocks(b23, hn::SwapAdjacentBlocks(a23));
      nodes[5] = b01;
    } else {
#pragma GCC unroll 6
      for (int k = 0; k < 6; ++k)
        nodes[k] = Lanes<float>(join_fours<lanes>(
            [&](int lane) __attribute__((always_inline)) {
              const int four = (part * lanes + lane) / 4, node = k - 1 + four % 2 * 4;
              const int at = node < 0 ? 0 : node < 8 ? node : 7;
              return hn::LoadU(hn::CappedTag<float, 4>(), half[four / 2][at / 4] + at % 4 * 4);
            },
            0));
    }
  }

  Lanes<float> lower_[5], upper_[5];  ///< {x, x, y, y} and {z, z, mass, mass} of neighbors, from each node on
};

}  // namespace DM_ISA

template <>
struct LaneTraits<DM_ISA::Lanes<float>> {
  using Scalar = float;
  using Mask = DM_ISA::LaneMask;
  static constexpr int lanes = DM_ISA::Lanes<float>::count;
};

}  // namespace dreampm

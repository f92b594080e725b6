// The loops of the projection in lanes. Built once per instruction set (DM_ISA), as the kernels of
// the cpu backend: it must export nothing but its table (tools/check_kernels).
#include "dreampm/math/lanes.h"
#include "dreampm/solver/projection/giving_loops.h"
#include "dreampm/solver/projection/multigrid_loops.h"
#include "dreampm/solver/projection/row_loops.h"
#include "dreampm/solver/projection/taking_loops.h"

static_assert(HWY_STATIC_TARGET == DM_HWY_TARGET,
              "Highway fell to another target than this file's flags are meant for");

namespace dreampm::DM_ISA {
namespace {

using F = Lanes<float>;
constexpr int W = F::count;

/// Two floats that follow one another, from each of two places on.
DM_FN auto two_by_two(const float* first, const float* second) {
#if HWY_ARCH_X86
  // Written with vectors of two floats it takes an instruction more.
  const __m128 low = _mm_castpd_ps(_mm_load_sd(reinterpret_cast<const double*>(first)));
  return hn::Vec<hn::CappedTag<float, 4>>{_mm_loadh_pi(low, reinterpret_cast<const __m64*>(second))};
#else
  using Two [[gnu::vector_size(8)]] = float;
  Two a, b;
  __builtin_memcpy(&a, first, sizeof a), __builtin_memcpy(&b, second, sizeof b);
  return hn::Vec<hn::CappedTag<float, 4>>{__builtin_shufflevector(a, b, 0, 1, 2, 3)};
#endif
}

/// Returns the first and third float of each four of two vectors, or the second and fourth.
template <int odd, class V>
DM_FN V every_other(V a, V b) {
  constexpr int o = odd, n = W;
  if constexpr (W == 4)
    return V{__builtin_shufflevector(a.raw, b.raw, o, o + 2, n + o, n + o + 2)};
  else if constexpr (W == 8)
    return V{__builtin_shufflevector(a.raw, b.raw, o, o + 2, n + o, n + o + 2, o + 4, o + 6, n + o + 4, n + o + 6)};
  else
    return V{__builtin_shufflevector(a.raw, b.raw, o, o + 2, n + o, n + o + 2, o + 4, o + 6, n + o + 4, n + o + 6,
                                     o + 8, o + 10, n + o + 8, n + o + 10, o + 12, o + 14, n + o + 12, n + o + 14)};
}

struct ParticleRow {
  static DM_FN F load(const float* p, int n) { return load_first(p, n); }
  static DM_FN void store(F a, float* p, int n) { store_first(a, p, n); }
  static DM_FN F all(const float* p) { return F::load(p); }
  static DM_FN void keep(F a, float* p) { a.store(p); }
  static DM_FN F floor(F a) { return hn::Floor(a.v); }
  static DM_FN void whole(F a, std::int32_t (&to)[W]) {
    store_whole(a, to);
    // From memory: g++ would take them out of the vector one by one, which takes longer.
    asm("" : "+m"(to));
  }
  static DM_FN void pairs(const float* from, const std::int32_t (&number)[W], F& first, F& second) {
    const auto two = [&](int l)
                         __attribute__((always_inline)) { return two_by_two(from + number[l], from + number[l + 1]); };
    const auto after = [&](int l) __attribute__((always_inline)) { return two(l + 2); };
    const auto a = join_fours<W>(two, 0), b = join_fours<W>(after, 0);
    first = every_other<0>(a, b), second = every_other<1>(a, b);
  }
  static DM_FN unsigned bits(LaneMask m) { return static_cast<unsigned>(bits_of(m)); }
  static DM_FN LaneMask mask(unsigned bits) { return mask_of(bits); }
  static DM_FN void records(F a, F b, F c, F d, float* p) { store_records(a, b, c, d, p); }
  static DM_FN int record_of(int lane) { return dreampm::DM_ISA::record_of(lane); }
};

void take(const BlockTaking<float>& block, BlockMove& found) { take_particles<F, ParticleRow>(block, found); }
void give(const BlockGiving<float>& block) { give_particles<F, ParticleRow>(block); }

}  // namespace

const ProjectionKernels<float>& projection_table() {
  static constexpr ProjectionKernels<float> table{DM_ISA_NAME, &take, &give, MultigridLoops<float, ParticleRow>::table,
                                                  RowLoops<float, ParticleRow>::table};
  return table;
}

}  // namespace dreampm::DM_ISA

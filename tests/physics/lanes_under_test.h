// The border between lanes_test.cpp and what it tests: plain numbers, so that no code of an
// instruction set leaks out.
#pragma once

namespace dreampm {

inline constexpr int lanes_tested = 256;  ///< particles in one call, a multiple of any number of lanes

/// Columns of `lanes_tested` numbers.
struct LawCall {
  const void* law;  ///< Law<float> of that material
  float dt, volume_relaxation, strain;
  float state[16][lanes_tested];  ///< in and out
  float gradient[9][lanes_tested], volume[lanes_tested], inside[lanes_tested], surface_filled[lanes_tested];
  float at_rest[lanes_tested];
  float tau[6][lanes_tested], energy[lanes_tested], sound[lanes_tested];
  float viscosity[lanes_tested], implicit[lanes_tested];
};

struct SvdCall {
  float f[9][lanes_tested];
  float u[9][lanes_tested], s[3][lanes_tested], v[9][lanes_tested];
};

struct ExpLogCall {
  float a[lanes_tested], b[lanes_tested];  ///< any number, a positive one
  float exp_a[lanes_tested], log_b[lanes_tested];
};

/// One of these per instruction set.
struct LanesUnderTest {
  int lanes;
  void (*advance)(int material, LawCall&);  ///< material: its place in the list
  void (*svd)(SvdCall&);
  void (*exp_log)(ExpLogCall&);
};
namespace sse4 {
LanesUnderTest lanes_under_test();
}
namespace avx2 {
LanesUnderTest lanes_under_test();
}
namespace avx512 {
LanesUnderTest lanes_under_test();
}
/// 16 lanes as pairs of AVX2's vectors (lane_pairs.h).
namespace pairs {
LanesUnderTest lanes_under_test();
}
namespace neon {
LanesUnderTest lanes_under_test();
}

}  // namespace dreampm

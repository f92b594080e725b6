// Records of four floats, one a lane and in order, and what all lanes make together. Only kernel
// sources include this.
#pragma once
#include "dreampm/math/lanes.h"

namespace dreampm::DM_ISA {

DM_FN void split_in_order(const float* p, Lanes<float>& a, Lanes<float>& b, Lanes<float>& c, Lanes<float>& d) {
  hn::LoadInterleaved4(LaneMask::D(), p, a.v, b.v, c.v, d.v);
}
DM_FN void join_in_order(Lanes<float> a, Lanes<float> b, Lanes<float> c, Lanes<float> d, float* p) {
  hn::StoreInterleaved4(a.v, b.v, c.v, d.v, LaneMask::D(), p);
}

}  // namespace dreampm::DM_ISA

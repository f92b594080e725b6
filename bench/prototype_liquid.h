// The law of the measuring prototype's liquid, for comparing kernels alone: pressure from J, no
// viscosity, no measured density, no volume relaxation. It does not count as a liquid, so that J
// follows tr C as there. Not a material for scenes, and so not in the list: a build for
// tools/bench_against takes it in with cmake
// -DDM_EXTRA_MATERIALS=bench/prototype_liquid.h:PrototypeLiquid.
//   J' = J (1 + dt tr C),  tau = K (J - 1) J,  psi = K/2 (J - 1)^2.  State: e = J - 1.
#pragma once
#include "dreampm/physics/law.h"
#include "dreampm/physics/param.h"

namespace dreampm {

inline constexpr Param prototype_liquid_params[] = {
    {"density", "kg/m^3", 1000, 1, 25000, true, "mass per volume at rest"},
    {"bulk_modulus", "Pa", 2.5e6, 1, 1e11, true, "stiffness against compression"},
};

struct PrototypeLiquid {
  static constexpr MaterialInfo info{
      "prototype_liquid", "for benchmarks: the bare minimum of a liquid", prototype_liquid_params, {}, false};
  static constexpr bool wants_density = false;

  template <class R>
  struct State {
    static constexpr std::string_view names[] = {"e"};
    static constexpr double rest[] = {0};
    R e;
    DM_FN R& operator[](int) { return e; }
    DM_FN R volume_ratio() const { return R(Scalar<R>(1)) + e; }
  };

  template <class S>
  struct Law {
    S bulk, sound;
    static Law from(const Values& values) {
      const double k = values["bulk_modulus"];
      return {S(k), S(__builtin_sqrt(k / values["density"]))};
    }
    template <class R>
    DM_FN StressResponse<R> respond(const State<R>& s) const {
      const R pulled = R(bulk) * s.e;
      return {Sym3<R>::isotropic(pulled * s.volume_ratio()), R(S(0.5)) * pulled * s.e, R(sound) * s.volume_ratio(),
              R(S(0))};
    }
    template <class R>
    DM_FN StressResponse<R> advance(State<R>& s, const StrainIncrement<R>& at) const {
      s.e = mul_add(trace(at.gradient), s.volume_ratio(), s.e);
      return respond(s);
    }
  };
};

}  // namespace dreampm

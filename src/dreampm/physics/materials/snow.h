// Snow (Stomakhin et al. 2013, "A material point method for snow simulation"). F = F_E F_P; the
// stored F is F_E, whose singular values stay in [1 - critical_compression, 1 + critical_stretch]
// (section 7); what they lose goes to J_P = det F_P. Elastic part: fixed corotated with mu, lambda
// times h = exp(xi (1 - J_P)) (eq. 2), J_P of this step. J_P stays in [0.6, 20], the bounds of Hu
// et al. 2018's program: below, packed snow would harden without end; above, powder would have to
// be pressed for ever before it carries again. h is never below 1e-3, so that powder keeps a wave
// speed. An axis yields only to its own stress (elastic.h:clamp_stretches; not in the paper).
#pragma once
#include "dreampm/math/explog.h"
#include "dreampm/physics/materials/elastic.h"

namespace dreampm {

inline constexpr Param snow_params[] = {
    Param{"density", "kg/m^3", 400, 1, 2000, true, "mass per volume at rest"}.shown({.basic = true}),
    Param{"youngs_modulus", "Pa", 1.4e5, 1, 1e9, true, "stiffness E of unpacked snow"}.shown(
        {.label = "Young's modulus", .basic = true}),
    Param{"poissons_ratio", "1", 0.2, 0, 0.45, false, "nu: how much it narrows when pulled"}.shown(
        {.label = "Poisson's ratio", .basic = true}),
    Param{"critical_compression", "1", 2.5e-2, 1e-4, 0.2, true, "strain at which it packs"}.shown({.basic = true}),
    Param{"critical_stretch", "1", 7.5e-3, 1e-4, 0.2, true, "strain at which it breaks"}.shown({.basic = true}),
    Param{"hardening", "1", 10, 0, 20, false, "xi of the factor exp(xi (1 - Jp)) on the stiffness"}.shown(
        {.basic = true}),
};
inline constexpr Preset::Value packed_snow_values[] = {{"density", 400},        {"youngs_modulus", 1.4e5},
                                                       {"poissons_ratio", 0.2}, {"critical_compression", 2.5e-2},
                                                       {"hardening", 10},       {"critical_stretch", 7.5e-3}};
inline constexpr Preset::Value powdery_snow_values[] = {{"density", 400},        {"youngs_modulus", 1.4e5},
                                                        {"poissons_ratio", 0.2}, {"critical_compression", 1.9e-2},
                                                        {"hardening", 10},       {"critical_stretch", 5.0e-3}};
inline constexpr Preset::Value slushy_snow_values[] = {{"density", 400},        {"youngs_modulus", 4.8e4},
                                                       {"poissons_ratio", 0.2}, {"critical_compression", 2.5e-2},
                                                       {"hardening", 5},        {"critical_stretch", 7.5e-3}};
inline constexpr Preset snow_presets[] = {
    {"packed", "Stomakhin et al. 2013, ACM Trans. Graph. 32(4), table 2", packed_snow_values},
    {"powdery", "Stomakhin et al. 2013, lower critical compression and stretch", powdery_snow_values},
    {"slushy", "Stomakhin et al. 2013, lower stiffness and hardening: its muddy snow", slushy_snow_values},
};

struct Snow {
  static constexpr MaterialInfo info{"snow", "snow that packs, hardens and breaks", snow_params, snow_presets, false};
  static constexpr bool wants_density = false;

  template <class R>
  struct State {
    static constexpr std::string_view names[] = {"f_00", "f_01", "f_02", "f_10", "f_11",
                                                 "f_12", "f_20", "f_21", "f_22", "jp"};
    static constexpr double rest[] = {1, 0, 0, 0, 1, 0, 0, 0, 1, 1};
    Mat3<R> f;
    R jp;
    DM_FN R& operator[](int i) { return i < 9 ? f.m[i] : jp; }
    /// Air between loose grains takes no room from a liquid.
    DM_FN R volume_ratio() const { return determinant(f) * min(jp, R(Scalar<R>(1))); }
  };

  template <class S>
  struct Law {
    S mu, lambda, inverse_density, low, high, xi;

    static Law from(const Values& values) {
      const Lame lame = Lame::of(values["youngs_modulus"], values["poissons_ratio"]);
      return {S(lame.mu),
              S(lame.lambda),
              S(1 / values["density"]),
              S(1 - values["critical_compression"]),
              S(1 + values["critical_stretch"]),
              S(values["hardening"])};
    }

    template <class R>
    DM_FN R hardening(const R& jp) const {
      return max(exp(R(xi) * (R(S(1)) - jp)), R(S(1e-3)));
    }

    template <class R>
    DM_FN StressResponse<R> stress(const Stretches<R>& d, const R& jp) const {
      const R h = hardening(jp);
      return fixed_corotated(d, h * R(mu), h * R(lambda), R(inverse_density));
    }

    template <class R>
    DM_FN StressResponse<R> respond(const State<R>& s) const {
      return stress(stretches_of(s.f, least_for_functions), s.jp);
    }

    template <class R>
    DM_FN StressResponse<R> advance(State<R>& s, const StrainIncrement<R>& at) const {
      s.f = deformed(s.f, at);
      Stretches<R> d = stretches_of(s.f, least_for_parts);
      const R h = hardening(s.jp), trial = fixed_corotated_energy(d.s, h * R(mu), h * R(lambda));
      // An inverted particle has a negative ratio and becomes the hardest there is.
      s.jp = min(max(s.jp * clamp_stretches(s.f, d, low, high, mu, lambda), R(S(0.6))), R(S(20)));
      StressResponse<R> r = stress(d, s.jp);
      r.dissipation.plastic = trial - r.energy;
      return r;
    }
  };
};

}  // namespace dreampm

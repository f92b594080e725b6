// The material of the report that asked for this project: a slider from liquid to solid
// (docs/notes/theory-long.md lists its errata). Fixed corotated with singular values clamped to [1
// + lower 1e-4, 1 + upper 1e-4] and snow-like hardening exp(xi (1 - Jp)), Stomakhin et al. 2013.
// Errata of the report mended here in both modes: Lame's formulas the right way round, and R of the
// same F as the stress. `legacy: true` keeps three habits of its program for comparison: hardening
// uses the Jp of the step before, the exponent has no bound, and Lame's parameters come from E and
// poissons_ratio instead of V. Otherwise hardening uses this step's Jp, kept in [0.1, 10], so that
// a liquid's pressure is not lost as Jp ratchets, and its exponent stays below 9.
#pragma once
#include "dreampm/math/explog.h"
#include "dreampm/physics/materials/elastic.h"

namespace dreampm {

inline constexpr Param seed_params[] = {
    {"density", "kg/m^3", 1, 1e-3, 25000, true, "mass per volume at rest"},
    {"youngs_modulus", "Pa", 1000, 1, 1e9, true, "E of the report: mu = E V, lambda = E (1 - V)"},
    {"v", "1", 0.5, 0, 0.7, false, "the report's V: 0 is a fluid, 0.7 the stiffest; ignored if elastic"},
    {"elastic", "", 0, 0, 1, false, "purely elastic: no plasticity, Lame parameters of E and nu times h", flag_words,
     true},
    {"h", "1", 0.3, 0.01, 10, false, "hardness of the elastic object"},
    {"poissons_ratio", "1", 0.2, 0, 0.495, false, "nu of the elastic object"},
    {"lower", "1", -250, -10000, 0, false, "plasticity lower bound: singular values stay above 1 + lower 1e-4"},
    {"upper", "1", 45, 0, 10000, false, "plasticity upper bound: singular values stay below 1 + upper 1e-4"},
    {"hardening", "1", 10, 0, 20, false, "xi of the factor exp(xi (1 - Jp))"},
    {"legacy", "", 0, 0, 1, false, "the report's program to the letter, for comparison", flag_words, true},
};

struct Seed {
  static constexpr MaterialInfo info{
      "seed", "the report's material: liquid, sticky liquid or stone by one slider", seed_params, {}, false};
  static constexpr bool wants_density = false;

  template <class R>
  struct State {
    static constexpr std::string_view names[] = {"f_00", "f_01", "f_02", "f_10", "f_11",
                                                 "f_12", "f_20", "f_21", "f_22", "jp"};
    static constexpr double rest[] = {1, 0, 0, 0, 1, 0, 0, 0, 1, 1};
    Mat3<R> f;
    R jp;
    DM_FN R& operator[](int i) { return i < 9 ? f.m[i] : jp; }
    DM_FN R volume_ratio() const { return determinant(f); }
  };

  /// Of the exponent of hardening: what the report's xi of 10 reaches where Jp is 0.1; steps cannot
  /// follow much more.
  static constexpr double most_hardened = 9;

  template <class S>
  struct Law {
    S mu, lambda, inverse_density, low, high, xi;
    bool elastic, legacy;

    static Law from(const Values& values) {
      // A lower bound at zero would leave flat particles, of which nothing more can be said.
      const bool elastic = values["elastic"] != 0, legacy = values["legacy"] != 0;
      const double e = values["youngs_modulus"], v = values["v"];
      Lame lame{e * v, e * (1 - v)};
      if (elastic || legacy) lame = Lame::of(e, values["poissons_ratio"]);
      const double factor = elastic ? values["h"] : 1, low = max(1 + values["lower"] * 1e-4, 0.01);
      return {S(lame.mu * factor),
              S(lame.lambda * factor),
              S(1 / values["density"]),
              S(low),
              S(1 + values["upper"] * 1e-4),
              S(values["hardening"]),
              elastic,
              legacy};
    }

    template <class R>
    DM_FN R hardening(const R& jp) const {
      const R one(S(1));
      if (elastic) return one;
      if (legacy) return exp(R(xi) * (one - jp));
      return exp(min(R(xi) * (one - min(max(jp, R(S(0.1))), R(S(10)))), R(S(most_hardened))));
    }

    template <class R>
    DM_FN StressResponse<R> respond(const State<R>& s) const {
      const R h = hardening(s.jp);
      const Stretches<R> d = stretches_of(s.f, least_for_functions);
      return answer(d, h);
    }

    /// Of an elastic object nothing is crushed, but in the report's program.
    template <class R>
    DM_FN StressResponse<R> answer(const Stretches<R>& d, const R& h) const {
      if (elastic && !legacy) return lasting_corotated(d, h * R(mu), h * R(lambda), R(inverse_density));
      return fixed_corotated(d, h * R(mu), h * R(lambda), R(inverse_density));
    }

    template <class R>
    DM_FN StressResponse<R> advance(State<R>& s, const StrainIncrement<R>& at) const {
      s.f = deformed(s.f, at);
      Stretches<R> d = stretches_of(s.f, least_for_parts);
      R h = hardening(s.jp);
      const R trial = fixed_corotated_energy(d.s, h * R(mu), h * R(lambda));
      R freed(S(0));
      // The report's program leaves what is inside out.
      if (elastic && !legacy)
        freed = turn_outside_out(s.f, d, [&] { return fixed_corotated_energy(d.s, R(mu), R(lambda)); });
      if (!elastic) {
        // The report's program clamps as the paper does.
        s.jp = s.jp * clamp_stretches(s.f, d, low, high, mu, legacy ? S(0) : lambda);
        if (!legacy) {
          s.jp = min(max(s.jp, R(S(0.1))), R(S(10)));
          h = hardening(s.jp);
        }
      }
      StressResponse<R> r = answer(d, h);
      r.dissipation.plastic = elastic ? freed : trial - r.energy;
      return r;
    }
  };
};

}  // namespace dreampm

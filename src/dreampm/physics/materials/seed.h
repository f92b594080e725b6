// The material of the report that asked for this project: a slider from liquid to solid
// (docs/notes/theory-long.md lists its errata). Fixed corotated; singular values over cbrt(J) stay
// in [1 + lower 1e-4, 1 + upper 1e-4], and the volume is elastic. Snow-like hardening exp(xi (1 -
// Jp)), Stomakhin et al. 2013, where Jp is how far it was once pressed: the least J/(1 + lower
// 1e-4), at most 1. With V = 0 there is no shear stress and no hardening: a liquid of J alone.
// Errata of the report mended here in both modes: Lame's formulas the right way round, and R of the
// same F as the stress. `legacy: true` keeps habits of its program for comparison: singular values
// themselves are clamped, by which volume and pressure are lost to Jp without end, hardening uses
// the Jp of the step before, its exponent has no bound, and Lame's parameters come from E and
// poissons_ratio instead of V.
#pragma once
#include <cmath>

#include "dreampm/math/explog.h"
#include "dreampm/physics/materials/elastic.h"

namespace dreampm {

inline constexpr Param seed_params[] = {
    Param{"density", "kg/m^3", 1, 1e-3, 25000, true, "mass per volume at rest"}.shown({.basic = true}),
    Param{"youngs_modulus", "Pa", 1000, 1, 1e9, true, "E of the report: mu = E V, lambda = E (1 - V)"}.shown(
        {.label = "Young's modulus", .basic = true}),
    Param{"v", "1", 0.5, 0, 0.7, false, "the report's V: 0 is a fluid, 0.7 the stiffest; ignored if elastic"}.shown(
        {.min = 0, .max = 0.7, .label = "V", .basic = true, .needs_off = "elastic"}),
    Param{"elastic", "", 0, 0, 1, false, "purely elastic: no plasticity, Lame parameters of E and nu times h",
          flag_words, true}
        .shown({.label = "Elastic Object", .basic = true}),
    Param{"h", "1", 0.3, 0.01, 10, false, "hardness of the elastic object"}.shown(
        {.min = 0.25, .max = 4, .label = "Hard", .basic = true, .needs_on = "elastic"}),
    Param{"poissons_ratio", "1", 0.2, 0, 0.495, false, "nu of the elastic object"}.shown(
        {.label = "Poisson's ratio", .basic = true}),
    Param{"lower", "1", -250, -10000, 0, false,
          "plasticity lower bound: singular values over cbrt(J) stay above 1 + lower 1e-4"}
        .shown({.min = -400, .max = -100, .label = "plasticity lower bound", .basic = true, .needs_off = "elastic"}),
    Param{"upper", "1", 45, 0, 10000, false,
          "plasticity upper bound: singular values over cbrt(J) stay below 1 + upper 1e-4"}
        .shown({.min = 0, .max = 100, .label = "plasticity upper bound", .basic = true, .needs_off = "elastic"}),
    Param{"hardening", "1", 10, 0, 20, false,
          "xi of the factor exp(xi (1 - Jp)): what was pressed below the lower bound is stiffer"}
        .shown({.basic = true}),
    Param{"legacy", "", 0, 0, 1, false, "the report's program to the letter, for comparison", flag_words, true}.shown(
        {.basic = true}),
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

  /// The end of hardening: the least Jp, and the largest exponent. Steps could not follow much
  /// more, and matter once pressed so hard would stay so.
  static constexpr double least_jp = 0.1, most_hardened = 2;
  static constexpr double least_stretch = 1e-6;

  template <class S>
  struct Law {
    S mu, lambda, inverse_density, low, high, xi;
    S ln_low, ln_high;
    bool elastic, legacy, hardens;

    static Law from(const Values& values) {
      // A lower bound at zero would leave flat particles, of which nothing more can be said.
      const bool elastic = values["elastic"] != 0, legacy = values["legacy"] != 0;
      const double e = values["youngs_modulus"], v = values["v"];
      Lame lame{e * v, e * (1 - v)};
      if (elastic || legacy) lame = Lame::of(e, values["poissons_ratio"]);
      const double factor = elastic ? values["h"] : 1, low = max(1 + values["lower"] * 1e-4, 0.01);
      const double high = 1 + values["upper"] * 1e-4;
      return {S(lame.mu * factor), S(lame.lambda * factor), S(1 / values["density"]), S(low), S(high),
              S(values["hardening"]), S(std::log(low)), S(std::log(high)), elastic, legacy,
              // A material without shear stiffness does not harden.
              lame.mu > 0};
    }

    template <class R>
    DM_FN R hardening(const R& jp) const {
      const R one(S(1));
      if (legacy) return elastic ? one : exp(R(xi) * (one - jp));
      return elastic || !hardens ? one : exp(min(R(xi) * (one - min(jp, one)), R(S(most_hardened))));
    }

    template <class R>
    DM_FN StressResponse<R> respond(const State<R>& s) const {
      const R h = hardening(s.jp);
      return fixed_corotated(stretches_of(s.f, least_for_functions), h * R(mu), h * R(lambda), R(inverse_density));
    }

    /// Shape yields, volume does not: no pressure is lost, however long it flows. Deviations of ln
    /// s shrink together until all are between the bounds. Where that frees no energy, as it may
    /// far below half the volume, nothing yields. What is inside out is turned back.
    template <class R>
    DM_FN void yield(State<R>& state, Stretches<R>& d) const {
      Vec3<R> old;
      for (int i = 0; i < 3; ++i) old[i] = max(abs(d.s[i]), R(S(least_stretch)));
      const R volume = old.x * old.y * old.z;
      if (hardens) state.jp = max(min(state.jp, volume / R(low)), R(S(least_jp)));
      const R large = max(old.x, max(old.y, old.z)), small = min(old.x, min(old.y, old.z));
      const auto inverted = d.product() < R(S(0));
      const auto beyond =
          large * large * large > R(high * high * high) * volume || small * small * small < R(low * low * low) * volume;
      const auto yields = beyond || inverted;
      if (!any(yields)) return;
      const R tiny(S(1e-12)), size = R(S(1.0 / 3)) * log(volume);
      const Vec3<R> shape{log(old.x) - size, log(old.y) - size, log(old.z) - size};
      const R most = max(shape.x, max(shape.y, shape.z)), least = -min(shape.x, min(shape.y, shape.z));
      const R share = min(R(S(1)), min(R(ln_high) / max(most, tiny), -R(ln_low) / max(least, tiny)));
      Vec3<R> flown;
      for (int i = 0; i < 3; ++i) flown[i] = exp(mul_add(share, shape[i], size));
      const auto strain = [&](const Vec3<R>& s) {
        const Vec3<R> off{s.x - R(S(1)), s.y - R(S(1)), s.z - R(S(1))};
        return dot(off, off);
      };
      const auto frees = strain(flown) < strain(old);
      const auto changed = (beyond && frees) || inverted;
      for (int i = 0; i < 3; ++i) d.s[i] = select(changed, select(beyond && frees, flown[i], old[i]), d.s[i]);
      // The deformation gradient with clamped stretches, as in clamp_stretches.
      const Mat3<R> f = d.with(d.s);
      for (int k = 0; k < 9; ++k) state.f.m[k] = select(changed, f.m[k], state.f.m[k]);
    }

    template <class R>
    DM_FN StressResponse<R> advance(State<R>& s, const StrainIncrement<R>& at) const {
      s.f = deformed(s.f, at);
      Stretches<R> d = stretches_of(s.f, least_for_parts);
      R h = hardening(s.jp);
      const R trial = fixed_corotated_energy(d.s, h * R(mu), h * R(lambda));
      if (!elastic) {
        // The report's program clamps as the paper does.
        if (legacy) {
          s.jp = s.jp * clamp_stretches(s.f, d, low, high, mu, S(0));
        } else {
          yield(s, d);
          h = hardening(s.jp);
        }
      }
      StressResponse<R> r = fixed_corotated(d, h * R(mu), h * R(lambda), R(inverse_density));
      r.dissipation.plastic = trial - r.energy;
      return r;
    }
  };
};

}  // namespace dreampm

// Mud, paste, lava: a Herschel-Bulkley fluid. Below the yield stress an elastic solid, above it a
// fluid whose shear stress is T = yield + consistency rate^n (Herschel and Bulkley 1926; in MPM Yue
// et al. 2015, "Continuum foam"). Elastic part: Hencky's strain. With T = |dev tau|/sqrt 2 (the
// shear stress of a simple shear) one step of implicit flow takes y off the trial stress: y = G dt
// rate and y + consistency (y/(G dt))^n = T_trial - yield. Being implicit it needs no viscous bound
// on dt: a stiff one only relaxes more slowly than its elastic G allows. G has to be well above the
// shear stresses of the flow; at T = G/sqrt 3 the fluid slips (hencky.h), which bounds the stress.
// Volume: tau = K ln J I, J relaxed to the measured density as in newtonian.h. The volume
// relaxation never pulls, and pulling stops at the yield stress. Where the grid measures that the
// fluid has swollen, a volume relaxation opens a gap, so that it sinks.
#pragma once
#include "dreampm/physics/materials/elastic.h"
#include "dreampm/physics/materials/hencky.h"
#include "dreampm/physics/materials/volume_params.h"

namespace dreampm {

inline constexpr Param viscoplastic_params[] = {
    Param{"density", "kg/m^3", 1500, 1, 25000, true, "mass per volume at rest"}.shown({.basic = true}),
    Param{"yield_stress", "Pa", 100, 0, 1e6, true, "shear stress below which it does not flow"}.shown(
        {.min = 0.1, .max = 5000, .basic = true}),
    Param{"consistency", "Pa s^n", 10, 0, 1e5, true, "k of the shear stress yield_stress + k rate^n"}.shown(
        {.min = 0.1, .max = 1000, .basic = true}),
    {"flow_index", "1", 1, 0.1, 2, false, "n: below 1 it thins when sheared, above 1 it thickens"},
    {"shear_modulus", "Pa", 1.0e4, 1, 1e8, true, "stiffness G before it yields; well above the shear stresses"},
    bulk_modulus_param,
    max_compression_param,
    relaxation_param,
};
inline constexpr Preset::Value mud_values[] = {
    {"density", 1580}, {"yield_stress", 146}, {"consistency", 8.2}, {"flow_index", 1}, {"shear_modulus", 2.0e4}};
inline constexpr Preset::Value toothpaste_values[] = {
    {"density", 1300}, {"yield_stress", 55.9}, {"consistency", 80.5}, {"flow_index", 0.541}, {"shear_modulus", 2.0e4}};
inline constexpr Preset::Value lava_values[] = {
    {"density", 2210}, {"yield_stress", 380}, {"consistency", 1000}, {"flow_index", 1}, {"shear_modulus", 1.0e6}};
inline constexpr Preset viscoplastic_presets[] = {
    {"mud", "Aspen pit 1 at 35 % sediment by volume, O'Brien and Julien 1988, J. Hydraul. Eng. 114:877, table 2",
     mud_values},
    {"toothpaste",
     "paste A of P. A. Cole 2011, Cleaning of toothpaste, EngD thesis, University of Birmingham, table 4.4",
     toothpaste_values},
    {"lava",
     "Etna's first lava of 1974, 37 % crystals, 1080 C: Lormand et al. 2020, Front. Earth Sci. 590411; yield stress: "
     "Ryerson et al. 1988, J. Geophys. Res. 93:3421",
     lava_values},
};

struct Viscoplastic {
  static constexpr MaterialInfo info{"viscoplastic", "mud, paste, lava: flows above a yield stress",
                                     viscoplastic_params, viscoplastic_presets, true};
  static constexpr bool wants_density = true;

  template <class R>
  using State = GappedState<R>;

  /// The tr e at which it tears: pulled by more than a tenth.
  static constexpr double most_pulled = 0.1;
  /// The viscosity of what does not flow, over G dt.
  static constexpr double rigid = 1e4;

  template <class S>
  struct Law {
    S mu, bulk, inverse_density, yield, consistency, index, tip, sound, relaxation;

    /// `values`: complete, with the bulk modulus already derived.
    static Law from(const Values& values) {
      const double k = values["bulk_modulus"], rho = values["density"];
      return {S(values["shear_modulus"]),
              S(k),
              S(1 / rho),
              S(values["yield_stress"]),
              S(values["consistency"]),
              S(values["flow_index"]),
              S(min(values["yield_stress"] / k, most_pulled)),
              S(__builtin_sqrt(k / rho)),
              S(values["relaxation"])};
    }

    /// m/s: J follows the measured density in VolumeCorrection::relaxation_cells
    /// dx/volume_relaxation()
    DM_FN S volume_relaxation() const { return relaxation * sound; }

    /// y of y + consistency (y/(G dt))^n = over, for over > 0. In u = ln y the equation ln(e^u + A
    /// e^(n u)) = ln(over) is convex with a slope between n and 1, and min of the roots of its two
    /// terms alone lies on the right: Newton's steps come down from there without fail.
    template <class R>
    DM_FN R flow(const R& over, const R& dt) const {
      const R zero(S(0)), one(S(1)), n(index), g_dt = max(R(mu) * dt, R(S(1e-30)));
      if (index == S(1)) return over * g_dt / (g_dt + R(consistency));
      const R log_a = log(R(max(consistency, S(1e-30)))) - n * log(g_dt), log_x = log(over);
      R u = min(log_x, (log_x - log_a) / n);
      constexpr int steps = sizeof(S) == 4 ? 4 : 6;
#pragma GCC unroll 1
      for (int k = 0; k < steps; ++k) {
        const R d = log_a + (n - one) * u;  // ln of the second term over the first
        const R small = exp(-abs(d)), sum = one + small;
        const R slope = select(d > zero, n + small, one + n * small) / sum;
        u = u - (u + max(d, zero) + log(sum) - log_x) / slope;
      }
      return min(exp(u), over);
    }

    template <class R>
    DM_FN StressResponse<R> respond(const State<R>& s) const {
      return hencky_response(hencky_strain(s.f), R(mu), R(bulk), R(inverse_density));
    }

    template <class R>
    DM_FN StressResponse<R> advance(State<R>& s, const StrainIncrement<R>& at) const {
      const R zero(S(0)), one(S(1)), tiny(S(1e-30));
      s.f = deformed(s.f, at);
      Hencky<R> h = hencky_strain(s.f);
      const R believed = max(h.trace, R(S(most_crushed))) + s.v;
      R t = believed;
      if (at.volume_relaxation > S(0)) {
        const R share = relaxed_share(R(volume_relaxation() * at.volume_relaxation)), read = log(measured_volume(at));
        const R goal = select(t > zero, min(read, zero), read);
        t = min(mul_add(share, goal - t, t), max(t, Swelling<R>(at).gap()));
      }
      // Beside a gap nothing pulls.
      const auto gaps = s.v > zero || t > max(believed, zero);
      const auto stressed = [&](const R& trace) { return select(gaps, min(trace, zero), trace); };
      const R from = stressed(believed), relaxed = stressed(t);
      s.v = select(gaps, min(max(t, zero), R(S(VolumeCorrection::widest_gap))), zero);
      t = min(relaxed, R(tip));
      const R per_strain(S(1.4142135623730951) * mu);  // T = |dev tau|/sqrt 2 = sqrt 2 G |dev e|
      const R trial = per_strain * h.norm, over = trial - R(yield);
      const R y = select(over > zero, flow(max(over, tiny), at.dt), zero);
      const R scale = min((trial - y) / max(trial, tiny), R(S(most_shear)) / max(h.norm, tiny));
      const R kept = select(trial > tiny, min(scale, one), one);
      // Stress over rate, y/(G dt); what does not flow holds on as if it were that much thicker.
      const R thickness = select(y > zero, min((trial - y) / max(y, tiny), R(S(rigid))), R(S(rigid)));
      const R sheared = h.norm, swollen = h.trace;
      set_strain(s.f, h, kept, t, kept < one || t < h.trace || t > h.trace);
      StressResponse<R> r = hencky_response(h, R(mu), R(bulk), R(inverse_density));
      r.implicit_viscosity = thickness * R(mu) * at.dt * R(inverse_density);
      // The volume relaxation has its part of the change of trace; tearing at the tip is plastic,
      // as the flow is.
      const R torn = (swollen - from) + (relaxed - h.trace);
      r.dissipation.plastic = projection_heat(sheared, h.trace + torn, h, R(mu), R(bulk));
      r.dissipation.relaxed = projection_heat(h.norm, h.trace + (from - relaxed), h, R(mu), R(bulk));
      return r;
    }
  };
};

}  // namespace dreampm

// Sand and soil: Drucker-Prager plasticity over Hencky's strain (Klar et al. 2016, "Drucker-Prager
// elastoplasticity for sand animation"), with the volume correction of Tampubolon et al. 2017 and
// cohesion. Yield: |dev tau| + alpha (tr tau - 3 c cot phi) <= 0. The return keeps the trace (no
// dilation while it shears) and shrinks the deviator; beyond the cone's tip the strain returns to
// the tip, and what it gives up is remembered as v (= ln of the volume of the gaps), to be used up
// before the grains carry again. alpha = sqrt(2/3) 2 sin phi/(3 - sin phi) is Mohr-Coulomb in
// triaxial compression (Klar, eq. 29). In plane strain that is far too strong: 30 degrees act as
// 43.9; alpha = sqrt(2) sin phi/3 is right there. Gaps: what the grid's gradient adds up to drifts
// from the true density, up to three times in a column that falls and spreads. While grains are
// sheared they are drawn, over `relaxation_strain`, to the density that the grid measures, as a
// liquid's J is in time: gaps close, grains packed too closely push apart, and pressing grains are
// let go. No gaps are made: a surface, where the grid measures too little, is not torn. A heap at
// rest is left alone. With a grain size friction rises with the rate of shearing: sin phi + rise
// I/(I0 + I), I = rate d/sqrt(p/rho) the inertial number (Jop, Forterre, Pouliquen 2006), solved
// implicitly in closed form (Dunatunga and Kamrin 2015).
#pragma once
#include "dreampm/physics/materials/elastic.h"
#include "dreampm/physics/materials/hencky.h"

namespace dreampm {

inline constexpr Word sand_match_words[] = {{"triaxial", 0}, {"plane_strain", 1}};
inline constexpr Param sand_params[] = {
    Param{"density", "kg/m^3", 1600, 1, 5000, true, "mass per volume at rest, gaps included"}.shown({.basic = true}),
    Param{"youngs_modulus", "Pa", 1.0e6, 1e3, 1e9, true, "stiffness E of the heap; softer takes fewer steps"}.shown(
        {.label = "Young's modulus", .basic = true}),
    Param{"poissons_ratio", "1", 0.3, -0.5, 0.45, false, "nu: how much it narrows when pulled"}.shown(
        {.label = "Poisson's ratio", .basic = true}),
    Param{"friction_angle", "deg", 34, 1, 60, false, "angle of internal friction phi"}.shown({.basic = true}),
    Param{"cohesion", "Pa", 0, 0, 1e5, true, "shear strength without pressure: wet sand, soil"}.shown(
        {.min = 0, .max = 20000, .basic = true}),
    Param{"match", "", 0, 0, 1, false, "where the cone meets Mohr-Coulomb", sand_match_words, true}.shown(
        {.label = "match of the friction angle"}),
    {"grain_size", "m", 0, 0, 0.1, false, "diameter d of a grain: above 0 friction rises with the rate of shearing"},
    {"friction_rise", "1", 0.26, 0, 1, false, "what sin phi gains in the fastest flow, where d is given"},
    Param{"inertial_number", "1", 0.279, 0.01, 10, true, "I0 = rate d/sqrt(p/rho) at half of the rise"}.shown(
        {.label = "inertial number of the rise"}),
    {"relaxation", "1", 1, 0, 10, false, "strength of relaxing the volume to the measured density; 0 turns it off"},
};
inline constexpr Preset::Value dry_sand_values[] = {
    {"density", 1600}, {"youngs_modulus", 1.0e7}, {"poissons_ratio", 0.3}, {"friction_angle", 34}, {"cohesion", 0}};
inline constexpr Preset::Value wet_sand_values[] = {
    {"density", 1840}, {"youngs_modulus", 1.0e7}, {"poissons_ratio", 0.3}, {"friction_angle", 29}, {"cohesion", 1720}};
inline constexpr Preset sand_presets[] = {
    {"dry",
     "loose angular sand: E of USACE EM 1110-1-1904 (10 to 24 MPa), nu of GOST 12248-96 (0.30 to 0.35), phi of Das, "
     "Principles of Geotechnical Engineering (30 to 35 degrees)",
     dry_sand_values},
    {"wet",
     "a sandy loam, not a clean sand, with 15 % of water: Land Locomotion Laboratory, in Wong 2008, Theory of Ground "
     "Vehicles, table of terrain values",
     wet_sand_values},
};

/// The Taylor series: libm's sine differs between machines. Of 0 to 60 degrees, to the last digits.
constexpr double sine_of_degrees(double degrees) {
  const double x = degrees * 0.017453292519943295;
  double term = x, sum = x;
  for (int k = 2; k < 20; k += 2) {
    term *= -x * x / (k * (k + 1));
    sum += term;
  }
  return sum;
}

struct Sand {
  static constexpr MaterialInfo info{"sand", "grains with friction, dry or wet", sand_params, sand_presets, false};
  static constexpr bool wants_density = true;

  template <class R>
  using State = GappedState<R>;

  /// Beyond this grains fly free of each other: the gradient that the grid measures says nothing of
  /// their distance.
  static constexpr double most_gaps = 1;
  /// The tr e of the tip: grains that are pulled apart by a tenth do not touch.
  static constexpr double most_pulled = 0.1;
  /// Shear over which the volume is relaxed; over 1, drift is faster.
  static constexpr double relaxation_strain = 1.0 / 3;

  template <class S>
  struct Law {
    S mu, bulk, inverse_density;
    S radius, slope, tip;  ///< yield: |dev e| <= radius - slope tr e, tr e <= tip
    S rise;                ///< the cone of the fastest flow over that of the slowest
    S pace;  ///< I0/(sqrt 2 d) sqrt(K/rho) [1/s]: times sqrt(-tr e), the rate of |dev e| at half of the rise; 0: no
             ///< rise
    S volume_relaxation;  ///< per shear

    static Law from(const Values& values) {
      const Lame lame = Lame::of(values["youngs_modulus"], values["poissons_ratio"]);
      const double sine = sine_of_degrees(values["friction_angle"]), bulk3 = 3 * lame.lambda + 2 * lame.mu;
      const auto cone = [&](double s) {
        return values["match"] != 0 ? __builtin_sqrt(2.0) * s / 3 : __builtin_sqrt(2.0 / 3) * 2 * s / (3 - s);
      };
      const double alpha = cone(sine), grain = values["grain_size"];
      const double pace = values["inertial_number"] * __builtin_sqrt(bulk3 / (6 * values["density"]));
      const double pull = 3 * values["cohesion"] * __builtin_sqrt(1 - sine * sine) / sine;  // tr tau at the tip
      return {S(lame.mu),
              S(bulk3 / 3),
              S(1 / values["density"]),
              S(alpha * pull / (2 * lame.mu)),
              S(alpha * bulk3 / (2 * lame.mu)),
              S(min(pull / bulk3, most_pulled)),
              S(cone(min(sine + values["friction_rise"], 1.0)) / alpha),
              S(grain > 0 ? pace / grain : 0),
              S(values["relaxation"] / relaxation_strain)};
    }

    /// |dev e| after flow over dt from `sheared` above the cone's `room`: e = room + (fast - room)
    /// x/(a + x), with x = sheared - e what flows and a = pace sqrt(-tr e) dt.
    template <class R>
    DM_FN R flow(const R& sheared, const R& room, const R& trace, const R& dt) const {
      const R zero(S(0)), fast = room * R(rise), a = R(pace) * sqrt(max(zero - trace, zero)) * dt;
      // e^2 - (fast + sheared + a) e + fast sheared + room a = 0; its discriminant as a sum of what
      // is not negative.
      const R past = sheared - fast + a, root = sqrt(past * past + a * (fast - room) * R(S(4)));
      return (fast * sheared + room * a) * R(S(2)) / max(fast + sheared + a + root, R(S(1e-30)));
    }

    /// ln of the volume, drawn from `believed` to the measured one: down from any, up only while
    /// grains press.
    template <class R>
    DM_FN R relaxed_strain(const R& believed, const StrainIncrement<R>& at) const {
      const R zero(S(0)), one(S(1)), t = trace(at.gradient);
      const R measured = log(measured_volume(at));
      const Sym3<R> sheared = plus_isotropic(symmetric_part(at.gradient), t * R(S(-1) / S(3)));
      const R shear = sqrt(fused_norm2(sheared) * R(S(2)));
      return mul_add(one - exp(zero - R(volume_relaxation) * shear),
                     max(min(measured, believed), min(measured, zero)) - believed, believed);
    }

    template <class R>
    DM_FN StressResponse<R> respond(const State<R>& s) const {
      return hencky_response(hencky_strain(s.f), R(mu), R(bulk), R(inverse_density));
    }

    template <class R>
    DM_FN StressResponse<R> advance(State<R>& s, const StrainIncrement<R>& at) const {
      const R zero(S(0)), one(S(1));
      s.f = deformed(s.f, at);
      Hencky<R> h = hencky_strain(s.f);
      const R sheared = h.norm, swollen = h.trace;
      const R believed = h.trace + s.v, whole = relaxed_strain(believed, at);
      const R trace = max(min(whole, R(tip)), R(S(most_crushed)));
      s.v = min(max(whole - trace, zero), R(S(most_gaps)));
      const R still = max(R(radius) - R(slope) * trace, zero);
      const R room = min(pace > S(0) ? max(flow(h.norm, still, trace, at.dt), still) : still, R(S(most_shear)));
      const R scale = min(room / max(h.norm, R(S(1e-30))), one);
      set_strain(s.f, h, scale, trace, scale < one || trace < h.trace || trace > h.trace);
      StressResponse<R> r = hencky_response(h, R(mu), R(bulk), R(inverse_density));
      r.dissipation.plastic = projection_heat(sheared, swollen, h, R(mu), R(bulk));
      // The part of it, at the same stress, that volume relaxation did.
      r.dissipation.relaxed = R(bulk) * trace * (max(min(believed, R(tip)), R(S(most_crushed))) - trace);
      r.dissipation.plastic = r.dissipation.plastic - r.dissipation.relaxed;
      return r;
    }
  };
};

}  // namespace dreampm

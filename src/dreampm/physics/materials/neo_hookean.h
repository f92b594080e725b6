// A neo-Hookean solid that stays sound when it is turned inside out (Smith, de Goes, Kim 2018,
// "Stable neo-Hookean flesh simulation", eq. 10 without its log term): polynomials in F, defined
// for every J, no decomposition. psi = mu/2 (tr b - 3) - mu (J - 1) + L/2 (J - 1)^2,  b = F F^T,  L
// = lambda + mu so that small strains obey Lame. tau = mu b + J (L (J - 1) - mu) I. The acoustic
// tensor is mu (n.b.n) I + L J^2 n n^T: positive at every F, so that no state of it is unstable.
// For lambda < 0 matter that is pressed to nothing has less energy than at rest, by -lambda/2: so
// the table of parameters begins at nu = 0.
#pragma once
#include "dreampm/physics/materials/elastic.h"

namespace dreampm {

inline constexpr Param neo_hookean_params[] = {
    Param{"density", "kg/m^3", 1000, 1, 25000, true, "mass per volume at rest"}.shown({.basic = true}),
    Param{"youngs_modulus", "Pa", 1.0e5, 1, 1e11, true, "stiffness E"}.shown(
        {.label = "Young's modulus", .basic = true}),
    Param{"poissons_ratio", "1", 0.45, 0, 0.495, false, "nu: how much it narrows when pulled"}.shown(
        {.label = "Poisson's ratio", .basic = true}),
};
inline constexpr Preset::Value silicone_values[] = {
    {"density", 1030}, {"youngs_modulus", 1.32e6}, {"poissons_ratio", 0.49}};
inline constexpr Preset::Value natural_rubber_values[] = {
    {"density", 930}, {"youngs_modulus", 1.2e6}, {"poissons_ratio", 0.49}};
inline constexpr Preset neo_hookean_presets[] = {
    {"silicone", "PDMS cured at 25 C, Johnston et al. 2014, J. Micromech. Microeng. 24:035017; nu is nearly 0.5",
     silicone_values},
    {"natural_rubber", "unfilled vulcanizate, shear modulus 0.4 MPa, Treloar 1944, Trans. Faraday Soc. 40:59",
     natural_rubber_values},
};

struct NeoHookean {
  static constexpr MaterialInfo info{"neo_hookean", "a rubber for large strains", neo_hookean_params,
                                     neo_hookean_presets, false};
  static constexpr bool wants_density = false;

  template <class R>
  using State = Elastic::State<R>;

  template <class S>
  struct Law {
    S mu, bulk, inverse_density;  ///< bulk: L above

    static Law from(const Values& values) {
      const Lame lame = Lame::of(values["youngs_modulus"], values["poissons_ratio"]);
      return {S(lame.mu), S(lame.lambda + lame.mu), S(1 / values["density"])};
    }

    template <class R>
    DM_FN StressResponse<R> respond(const State<R>& s) const {
      const R one(S(1)), half(S(0.5)), third(S(1) / S(3));
      const Sym3<R> b = symmetric_part(s.f * transpose(s.f));
      const R j = determinant(s.f), e = j - one, mean = (b.xx + b.yy + b.zz) * third;
      StressResponse<R> r;
      r.tau = mul_add_isotropic(b, R(mu), j * (R(bulk) * e - R(mu)));
      r.energy = R(mu) * (R(S(1.5)) * (mean - one) - e) + half * R(bulk) * e * e;
      // The largest eigenvalue of b is at most its mean + sqrt(2/3) |dev b|; never below the value
      // at rest.
      const R dx = b.xx - mean, dy = b.yy - mean, dz = b.zz - mean;
      const R dev2 = dx * dx + dy * dy + dz * dz + R(S(2)) * (b.xy * b.xy + b.xz * b.xz + b.yz * b.yz);
      const R most = max(mean + sqrt(R(S(2) / S(3)) * dev2), one);
      r.sound_speed = sqrt((R(mu) * most + R(bulk) * max(j * j, one)) * R(inverse_density));
      r.kinematic_viscosity = R(S(0));
      return r;
    }

    template <class R>
    DM_FN StressResponse<R> advance(State<R>& s, const StrainIncrement<R>& at) const {
      s.f = deformed(s.f, at);
      return respond(s);
    }
  };
};

}  // namespace dreampm

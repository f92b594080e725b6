// A fixed corotated elastic solid (Stomakhin et al. 2012, "Energetically consistent invertible elasticity").
// psi = mu sum (s_i - 1)^2 + lambda/2 (J - 1)^2;  tau = P F^T = 2 mu (F - R) F^T + lambda J (J - 1) I.
// With nu < 0 lambda is negative and psi has no bound below: swollen enough, such a body would blow itself up. So nu
// starts at 0 here; neo_hookean.h takes the rest.
#pragma once
#include "dreampm/math/stretch.h"
#include "dreampm/physics/law.h"
#include "dreampm/physics/param.h"

namespace dreampm {

inline constexpr Param elastic_params[] = {
    {"density", "kg/m^3", 1000, 1, 25000, true, "mass per volume at rest"},
    {"youngs_modulus", "Pa", 2.0e4, 1, 1e11, true, "stiffness E"},
    {"poissons_ratio", "1", 0.3, 0, 0.495, false, "nu: how much it narrows when pulled"},
};
inline constexpr Preset::Value jelly_values[] = {
    {"density", 1020}, {"youngs_modulus", 1.0e4}, {"poissons_ratio", 0.45}};
inline constexpr Preset::Value rubber_values[] = {
    {"density", 950}, {"youngs_modulus", 1.5e6}, {"poissons_ratio", 0.48}};
inline constexpr Preset elastic_presets[] = {
    {"jelly", "gelatine in 12.6 times its water, Bonavia 2025, arXiv:2512.20502; nu is nearly 0.5", jelly_values},
    {"rubber", "vulcanized natural rubber, MatWeb: shear modulus 0.5 MPa; nu is nearly 0.5", rubber_values},
};

/// Lame's parameters [Pa] of Young's modulus [Pa] and Poisson's ratio.
struct Lame {
  double mu, lambda;
  static constexpr Lame of(double youngs_modulus, double nu) {
    return {youngs_modulus / (2 * (1 + nu)), youngs_modulus * nu / ((1 + nu) * (1 - 2 * nu))};
  }
};

/// psi of singular values s.
template <class R>
DM_FN R fixed_corotated_energy(const Vec3<R>& s, const R& mu, const R& lambda) {
  using S = Scalar<R>;
  const R one(S(1)), j = s.x * s.y * s.z;
  const Vec3<R> strain{s.x - one, s.y - one, s.z - one};
  return mu * dot(strain, strain) + R(S(0.5)) * lambda * (j - one) * (j - one);
}

/// The fixed corotated stress of a deformation: shared by every law of this energy.
template <class R>
DM_FN Response<R> fixed_corotated(const Stretches<R>& d, const R& mu, const R& lambda, const R& inverse_density) {
  using S = Scalar<R>;
  const R one(S(1)), two_mu = mu + mu;
  const Vec3<R>& s = d.s;
  const R j = d.product(), volumetric = lambda * j * (j - one);
  const auto stress = [&](const R& stretch) { return mul_add(two_mu * (stretch - one), stretch, volumetric); };
  const R energy = fixed_corotated_energy(s, mu, lambda);
  // P waves: d tau/d(ln s) - tau = 2 mu s^2 + lambda J^2, never below the value at rest.
  const R stretch = max(max(d.largest(), abs(d.least())), one), swell = max(abs(j), one);
  const R speed = sqrt((two_mu * stretch * stretch + lambda * swell * swell) * inverse_density);
  return {d.function({stress(s.x), stress(s.y), stress(s.z)}), energy, speed, R(S(0))};
}

/// a: how large the product of two stretches may be where the third yields to pressure at `low`, so that nothing pulls
/// along the third: the positive root of 2 mu (low - 1) + lambda a (low a - 1) = 0. A wider one pulls there, and matter
/// that pulls where it is pressed flat for ever would give energy each step.
constexpr double most_broad(const Lame& lame, double low) {
  if (!(lame.lambda > 1e-6 * lame.mu)) return 1e3;
  const double shear = 8 * lame.mu / lame.lambda * low * (1 - low);
  return (1 + __builtin_sqrt(1 + shear)) / (2 * low);
}

/// Plasticity of Stomakhin et al. 2013 (section 7): the stretches of F are kept in [low, high]; `d` and `f` become the
/// elastic part. Where the least was under `low`, the others lose what is beyond `broad` (most_broad) of their product,
/// the largest first: all three pull there, so that this, too, frees energy. Gives the ratio of volumes
/// det(F before)/det(F after), which is the plastic part's.
template <class S, class R>
DM_FN R clamp_stretches(Mat3<R>& f, Stretches<R>& d, S low, S high, S broad) {
  const auto clamped = d.least() < R(low) || d.largest() > R(high);
  const auto crushed = d.least() < R(low);
  const Vec3<R> old = d.s;
  for (int i = 0; i < 3; ++i) d.s[i] = min(max(old[i], R(low)), R(high));
  if (high * high > broad) {
    // Clamped, the ends keep their order.
    const R most = d.largest(), middle = select(crushed, min(d.s.y, sqrt(R(broad))), d.s.y);
    const R narrow = select(crushed, min(most, R(broad) / middle), most);
    const auto first = old.x > old.z;
    d.s = {select(first, narrow, d.s.x), middle, select(first, d.s.z, narrow)};
  }
  // Only what was clamped is put together again: doing so every step would drift by its rounding errors.
  const Mat3<R> kept = d.with(d.s);
  for (int k = 0; k < 9; ++k) f.m[k] = select(clamped, kept.m[k], f.m[k]);
  return old.x * old.y * old.z / d.product();
}

struct Elastic {
  static constexpr MaterialInfo info{"elastic", "a fixed corotated elastic solid: jelly, rubber", elastic_params,
                                     elastic_presets, false};
  static constexpr bool wants_density = false;

  template <class R>
  struct State {
    static constexpr std::string_view names[] = {"f_00", "f_01", "f_02", "f_10", "f_11",
                                                 "f_12", "f_20", "f_21", "f_22"};
    static constexpr double rest[] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    Mat3<R> f;
    DM_FN R& operator[](int i) { return f.m[i]; }
    DM_FN R volume_ratio() const { return determinant(f); }
  };

  template <class S>
  struct Law {
    S mu, lambda, inverse_density;

    static Law from(const Values& values) {
      const Lame lame = Lame::of(values["youngs_modulus"], values["poissons_ratio"]);
      return {S(lame.mu), S(lame.lambda), S(1 / values["density"])};
    }

    template <class R>
    DM_FN Response<R> respond(const State<R>& s) const {
      return fixed_corotated(stretches_of(s.f, least_for_functions), R(mu), R(lambda), R(inverse_density));
    }

    template <class R>
    DM_FN Response<R> advance(State<R>& s, const Local<R>& at) const {
      s.f = deformed(s.f, at);
      return respond(s);
    }
  };
};

}  // namespace dreampm

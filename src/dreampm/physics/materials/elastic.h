// A fixed corotated elastic solid (Stomakhin et al. 2012, "Energetically consistent invertible
// elasticity"). psi = mu sum (s_i - 1)^2 + lambda/2 (J - 1)^2;  tau = P F^T = 2 mu (F - R) F^T +
// lambda J (J - 1) I. With nu < 0 lambda is negative and psi has no bound below: swollen enough,
// such a body would blow itself up. So nu starts at 0 here; neo_hookean.h takes the rest.
#pragma once
#include "dreampm/math/stretch.h"
#include "dreampm/physics/law.h"
#include "dreampm/physics/param.h"

namespace dreampm {

inline constexpr Param elastic_params[] = {
    Param{"density", "kg/m^3", 1000, 1, 25000, true, "mass per volume at rest"}.shown({.basic = true}),
    Param{"youngs_modulus", "Pa", 2.0e4, 1, 1e11, true, "stiffness E"}.shown(
        {.label = "Young's modulus", .basic = true}),
    Param{"poissons_ratio", "1", 0.3, 0, 0.495, false, "nu: how much it narrows when pulled"}.shown(
        {.label = "Poisson's ratio", .basic = true}),
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
DM_FN StressResponse<R> fixed_corotated(const Stretches<R>& d, const R& mu, const R& lambda, const R& inverse_density) {
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

/// The stretch without stress along its axis, 2 mu (s - 1) + lambda a (s a - 1) = 0; a: the product
/// of the other two.
template <class R>
DM_FN R unstressed_stretch(const R& a, const R& two_mu, const R& lambda) {
  return mul_add(lambda, a, two_mu) / mul_add(lambda * a, a, two_mu);
}

/// The same along two axes alike, beside a third: a = third s. Newton's steps from above, where the
/// stress is convex and rises: six are exact to 1e-12 over a million times lambda/(2 mu) and thirds
/// from 0.01 to 2.
template <class R>
DM_FN R unstressed_pair(const R& third, const R& two_mu, const R& lambda) {
  using S = Scalar<R>;
  const R one(S(1)), three(S(3));
  R s = max(one, one / sqrt(third));
  for (int i = 0; i < 6; ++i) {
    const R a = third * s, j = a * s;
    s = s - mul_add(two_mu, s - one, lambda * (j - one) * a) / mul_add(lambda * third, three * j - one, two_mu);
  }
  return s;
}

/// Plasticity of Stomakhin et al. 2013 (section 7): the stretches of F are kept in [low, high]; `d`
/// and `f` become the elastic part. Not in the paper: a stretch is cut only where it pulls, and let
/// out only where it presses, as far as to no stress; two at a time come to the same level. So it
/// frees energy whatever lambda >= 0 does; 0 is the paper's clamp. Gives the ratio of volumes det(F
/// before)/det(F after), which is the plastic part's.
template <class S, class R>
DM_FN R clamp_stretches(Mat3<R>& f, Stretches<R>& d, S low, S high, S mu, S lambda) {
  auto clamped = d.least() < R(low) || d.largest() > R(high);
  const Vec3<R> old = d.s;
  for (int i = 0; i < 3; ++i) d.s[i] = min(max(old[i], R(low)), R(high));
  // The paper's clamp itself, unless one that it moved has the wrong stress then. Each that it cut
  // has the same, and so has each that it let out.
  const R one(S(1)), two_mu(mu + mu), j = d.product(), volumetric = R(lambda) * j * (j - one);
  const auto swollen = volumetric > two_mu * R(low * (1 - low));
  const auto pressed = volumetric < two_mu * R(high * (1 - high));
  const auto first = (swollen && old.x < old.z) || (!swollen && old.x > old.z);
  const R end = select(first, old.x, old.z);
  const auto wrong = (swollen && end < R(low)) || (pressed && end > R(high));
  if (any(wrong)) [[unlikely]] {
    const auto bounded = [&](const R& s, const R& unstressed) {
      const R least = select(swollen, min(R(low), unstressed), R(low));
      return min(max(s, least), select(swollen, R(high), max(R(high), unstressed)));
    };
    // Clamped, the ends keep their order.
    const R third = select(swollen, d.largest(), d.least());
    const R middle = bounded(old.y, unstressed_pair(third, two_mu, R(lambda)));
    const R moved = bounded(end, unstressed_stretch(middle * third, two_mu, R(lambda)));
    d.s = {select(wrong && first, moved, d.s.x), select(wrong, middle, d.s.y), select(wrong && !first, moved, d.s.z)};
    clamped = clamped && abs(d.s.x - old.x) + abs(d.s.y - old.y) + abs(d.s.z - old.z) > R(S(0));
  }
  // Only what was clamped is put together again: doing so every step would drift by its rounding
  // errors.
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
    DM_FN StressResponse<R> respond(const State<R>& s) const {
      return fixed_corotated(stretches_of(s.f, least_for_functions), R(mu), R(lambda), R(inverse_density));
    }

    template <class R>
    DM_FN StressResponse<R> advance(State<R>& s, const StrainIncrement<R>& at) const {
      s.f = deformed(s.f, at);
      return respond(s);
    }
  };
};

}  // namespace dreampm

// Hencky's logarithmic strain, shared by laws that flow: e = ln s of F = U diag(s) V^T, psi = mu
// |dev e|^2 + K/2 (tr e)^2, tau = U (2 mu dev e + K tr e) U^T (Klar et al. 2016, eq. 22; Mast
// 2013). Its elastic strains must stay small: the law is elliptic for stretches in [0.2117,
// e^(1/3)] only (Bruhns, Xiao, Meyers 2001). Laws that use it keep them there with the bounds
// below, so that stress is bounded whatever a step brings.
#pragma once
#include "dreampm/math/explog.h"
#include "dreampm/math/stretch.h"
#include "dreampm/physics/law.h"

namespace dreampm {

/// A flat or inverted particle (s <= 0 has no logarithm) counts as pressed to this.
inline constexpr double least_stretch = 1e-3;
/// The bound of |dev e|: no principal deviatoric strain above 1/3.
inline constexpr double most_shear = 0.408248290463863;
/// The bound of tr e: with 1/3 from shear, each principal strain stays above ln 0.2117.
inline constexpr double most_crushed = -3.6;

/// F, and the volume of gaps that opened beyond it: they have to close before matter presses again.
template <class R>
struct GappedState {
  static constexpr std::string_view names[] = {"f_00", "f_01", "f_02", "f_10", "f_11",
                                               "f_12", "f_20", "f_21", "f_22", "v"};
  static constexpr double rest[] = {1, 0, 0, 0, 1, 0, 0, 0, 1, 0};
  Mat3<R> f;
  R v;  ///< gaps: ln of the volume that bears no stress, >= 0
  DM_FN R& operator[](int i) { return i < 9 ? f.m[i] : v; }
  /// Returns the volume ratio without gaps, which take no room from a liquid.
  DM_FN R volume_ratio() const { return determinant(f); }
};

/// The strain of F in its own frame.
template <class R>
struct Hencky {
  Stretches<R> d;
  Vec3<R> deviator;  ///< in the order of d.s
  R trace, norm;     ///< tr e; |dev e|
};

template <class R>
DM_FN Hencky<R> hencky_strain(const Mat3<R>& f) {
  using S = Scalar<R>;
  Hencky<R> h;
  h.d = stretches_of(f, least_for_parts);
  for (int i = 0; i < 3; ++i) h.deviator[i] = log(max(h.d.s[i], R(S(least_stretch))));
  h.trace = h.deviator.x + h.deviator.y + h.deviator.z;
  const R mean = h.trace * R(S(1) / S(3));
  for (int i = 0; i < 3; ++i) h.deviator[i] = h.deviator[i] - mean;
  h.norm = sqrt(dot(h.deviator, h.deviator));
  return h;
}

/// Heat of a projection from |dev e| = `sheared`, tr e = `trace` to h, at the stress that it ends
/// with: at the trial stress an explicit step would count the square of its own strain as heat.
template <class R>
DM_FN R projection_heat(const R& sheared, const R& trace, const Hencky<R>& h, const R& mu, const R& bulk) {
  return (mu + mu) * h.norm * (sheared - h.norm) + bulk * h.trace * (trace - h.trace);
}

/// Stress, energy and wave speed of a strain. `bulk`: K = lambda + 2/3 mu, since a fluid's lambda
/// would lose its digits.
template <class R>
DM_FN StressResponse<R> hencky_response(const Hencky<R>& h, const R& mu, const R& bulk, const R& inverse_density) {
  using S = Scalar<R>;
  const R zero(S(0)), half(S(0.5)), two_mu = mu + mu, third(S(1) / S(3));
  const R mean = bulk * h.trace;
  const Vec3<R> t{two_mu * h.deviator.x + mean, two_mu * h.deviator.y + mean, two_mu * h.deviator.z + mean};
  const R energy = mu * h.norm * h.norm + half * bulk * h.trace * h.trace;
  // P waves along n: lambda + 2 mu sum n_i^2 n_j^2 x coth x - tau_nn with x = e_i - e_j, and x coth
  // x <= 1 + |x|.
  const R least = min(min(h.deviator.x, h.deviator.y), h.deviator.z);
  const R spread = max(max(h.deviator.x, h.deviator.y), h.deviator.z) - least;
  const R pressed = max(zero - (two_mu * least + mean), zero);
  const R modulus = two_mu * (R(S(1)) + spread) + max(bulk - two_mu * third, zero) + pressed;
  return {h.d.function(t), energy, sqrt(modulus * inverse_density), zero};
}

/// Moves the strain to `scale` times its deviator and the given trace, and F with it; where `moved`
/// is false both stay, since putting F together again each step would drift by its rounding errors.
template <class R>
DM_FN void set_strain(Mat3<R>& f, Hencky<R>& h, const R& scale, const R& trace,
                      const typename LaneTraits<R>::Mask& moved) {
  using S = Scalar<R>;
  const R mean = trace * R(S(1) / S(3));
  Vec3<R> s;
  for (int i = 0; i < 3; ++i) {
    h.deviator[i] = h.deviator[i] * scale;
    s[i] = exp(h.deviator[i] + mean);
  }
  h.norm = h.norm * scale;
  h.trace = trace;
  const Mat3<R> kept = h.d.with(s);
  for (int k = 0; k < 9; ++k) f.m[k] = select(moved, kept.m[k], f.m[k]);
}

}  // namespace dreampm

// A weakly compressible Newtonian liquid. Pressure: p = K/gamma (J^-gamma - 1), Cole 1948 /
// Monaghan 1994; gamma = -1 is the linear p = K (1 - J). Viscosity: tau_v = 2 mu J dev(D), D the
// symmetric part of grad v. J is relaxed slowly to the density that the grid measures. Without this
// an updated-Lagrangian J drifts and the liquid gains or loses volume. Unless `tension` is set it
// does not pull: swollen liquid has gaps, which have to close before it presses again. State: e = J
// - 1, so that small strains keep digits; above 0 without tension, the gaps.
#pragma once
#include "dreampm/math/explog.h"
#include "dreampm/physics/law.h"
#include "dreampm/physics/materials/volume_params.h"
#include "dreampm/physics/param.h"

namespace dreampm {

inline constexpr Word gamma_words[] = {{"linear", -1}};  // p = K/gamma (J^-gamma - 1) with gamma = -1 is K (1 - J)
inline constexpr Param newtonian_params[] = {
    Param{"density", "kg/m^3", 1000, 1, 25000, true, "mass per volume at rest"}.shown({.basic = true}),
    Param{"viscosity", "Pa s", 1.0e-3, 0, 1000, true, "dynamic viscosity"}.shown(
        {.min = 1e-4, .max = 1000, .basic = true}),
    bulk_modulus_param,
    max_compression_param,
    Param{"gamma", "1", 7, 1, 15, false, "exponent of the equation of state; linear for p = K (1 - J)", gamma_words}
        .shown({.label = "gamma of the pressure"}),
    Param{"tension", "", 0, 0, 1, false, "whether the liquid can pull", flag_words, true}.shown({.label = "can pull"}),
    relaxation_param,
};
inline constexpr Preset::Value water_values[] = {{"density", 998.2}, {"viscosity", 1.0016e-3}};
inline constexpr Preset::Value oil_values[] = {{"density", 914}, {"viscosity", 0.084}};
inline constexpr Preset::Value honey_values[] = {{"density", 1418}, {"viscosity", 8.55}};
inline constexpr Preset newtonian_presets[] = {
    {"water", "20 C, CRC Handbook of Chemistry and Physics", water_values},
    {"oil", "olive oil at 20 C: CRC Handbook of Chemistry and Physics (viscosity), Codex CXS 33-1981 (density)",
     oil_values},
    {"honey", "the thickest of five honeys at 20 C, Santos et al. 2014, An. Acad. Bras. Cienc. 86:981", honey_values},
};

struct Newtonian {
  static constexpr MaterialInfo info{"newtonian", "a weakly compressible liquid with true viscosity", newtonian_params,
                                     newtonian_presets, true};
  static constexpr bool wants_density = true;

  template <class R>
  struct State {
    static constexpr std::string_view names[] = {"e"};
    static constexpr double rest[] = {0};
    R e;
    DM_FN R& operator[](int) { return e; }
  };

  /// S: the scalar type of the parameters.
  template <class S>
  struct Law {
    S density, mu, bulk, gamma, sound, relaxation;
    int whole_gamma;  ///< gamma if it is a whole number, else 0
    bool tension;

    /// `values`: complete, with the bulk modulus already derived.
    static Law from(const Values& values) {
      const double rho = values["density"], k = values["bulk_modulus"], g = values["gamma"];
      const int whole = static_cast<int>(g);
      return {S(rho),
              S(values["viscosity"]),
              S(k),
              S(g),
              S(__builtin_sqrt(k / rho)),
              S(values["relaxation"]),
              whole == g ? whole : 0,
              values["tension"] != 0};
    }

    /// m/s: J follows the measured density in VolumeCorrection::relaxation_cells
    /// dx/volume_relaxation()
    DM_FN S volume_relaxation() const { return relaxation * sound; }

    template <class R>
    static DM_FN R bounded(const R& e) {
      return min(max(e, R(S(VolumeCorrection::least_strain))), R(S(VolumeCorrection::largest_strain)));
    }
    /// J - 1 of the liquid itself, without its gaps.
    template <class R>
    DM_FN R strain(const R& e) const {
      return tension ? e : min(e, R(S(0)));
    }
    template <class R>
    DM_FN R volume_ratio(const State<R>& s) const {
      return R(S(1)) + strain(s.e);
    }

    template <class R>
    DM_FN R separated_fraction(const State<R>& s) const {
      return min(max(s.e * R(S(1 / VolumeCorrection::parted_strain)), R(S(0))), R(S(1)));
    }

    /// J^(1 - gamma), its square root, and 1/J.
    template <class R>
    struct Power {
      R value, root, inverse;
    };
    template <class R>
    DM_FN Power<R> power(const R& j) const {
      const R one(S(1)), inverse = one / j;
      if (whole_gamma < 0) return {j * j, j, inverse};
      if (whole_gamma == 0) {
        const R value = exp(R(S(1) - gamma) * log(j));
        return {value, sqrt(value), inverse};
      }
      R root = one;
#pragma GCC unroll 1
      for (int k = 0; k < (whole_gamma - 1) / 2; ++k) root = root * inverse;
      const R square = root * root;
      if ((whole_gamma - 1) % 2 == 0) return {square, root, inverse};
      return {square * inverse, sqrt(square * inverse), inverse};
    }

    /// J p [Pa], J^(1 - gamma) = `pow`.
    template <class R>
    DM_FN R pressed(const R& j, const R& pow) const {
      return R(bulk / gamma) * (pow - j);
    }

    /// psi [J/m^3] with psi' = -p at J = 1 + e, J^(1 - gamma) = `pow`: K/gamma
    /// (J^(1-gamma)/(gamma-1) + J) - const; of the linear law K/2 (J-1)^2.
    template <class R>
    DM_FN R energy(const R& e, const R& pow) const {
      const R one(S(1));
      if (whole_gamma == 1) return R(bulk) * (e - log(one + e));
      if (whole_gamma == -1) return R(S(0.5) * bulk) * e * e;
      return R(bulk / gamma) * ((pow - one) * R(S(1) / (gamma - S(1))) + e);
    }

    /// psi(from) - psi(to) [J/m^3]. Of small changes by Simpson's rule over p: the two energies
    /// have no digits for them.
    template <class R>
    DM_FN R given_up(const R& from, const R& to) const {
      const R one(S(1)), change = to - from;
      const R j = one + from, k = one + to, between = R(S(0.5)) * (j + k);
      const Power<R> at_j = power(j), at_k = power(k);
      const auto p = [&](const R& at, const Power<R>& pow) { return pressed(at, pow.value) * pow.inverse; };
      const R small = p(j, at_j) + R(S(4)) * p(between, power(between)) + p(k, at_k);
      const R large = energy(from, at_j.value) - energy(to, at_k.value);
      return select(change * change < R(S(1e-4)), change * R(S(1.0 / 6)) * small, large);
    }

    /// Returns the part of a volume relaxation that counts where a reading of less density comes
    /// from a surface. Rows under a surface read too loose, and at rest have to press all the same:
    /// the reading counts as far as `pace` times the strain of its time passes `loosening_strain`.
    /// The strain is squared: at rest it is noise, and no rate of noise is small enough for
    /// minutes.
    template <class R>
    static DM_FN R disturbed(const StrainIncrement<R>& at, const R& pace) {
      const R strain = at.strain / max(pace * R(S(VolumeCorrection::loosening_strain)), R(S(1e-30)));
      return min(strain * strain, R(S(1)));
    }

    /// e after a volume relaxation by `share`, without tension. A reading of more density than e
    /// says is believed. One of less density is believed where matter is torn; inside, as if
    /// surfaces were covered; and as far as the volume corrected for the surface exceeds that at
    /// rest. There a volume relaxation opens a small gap, so that thin layers, whose weight hardly
    /// strains them, sink. Gaps are forgotten at the volume relaxation's pace.
    template <class R>
    static DM_FN R relaxed_strain(const R& e, const StrainIncrement<R>& at, const R& share, const R& disturbed) {
      const R zero(S(0)), one(S(1));
      const R seen = measured_volume(at) - one,
              surface_filled = moved_volume(at.volume * at.surface_filled, at.gradient) - one;
      const Swelling<R> swollen(at);
      const R looser = max(max(disturbed * (max(swollen.strain, zero) - e), at.inside * (surface_filled - e)),
                           max(R(S(VolumeCorrection::swelling_pace)) * swollen.belief * (swollen.strain - e), zero));
      const R change = select(e > zero, min(seen, zero) - e, select(seen < e, seen - e, looser));
      return min(mul_add(share, change, e), max(e, swollen.gap()));
    }

    template <class R>
    DM_FN StressResponse<R> respond(const State<R>& s) const {
      const R one(S(1)), e = strain(s.e), j = one + e;
      const Power<R> pow = power(j);
      return {Sym3<R>::isotropic(-pressed(j, pow.value)), energy(e, pow.value), R(sound) * max(one, pow.root),
              R(mu / density) * j};
    }

    template <class R>
    DM_FN StressResponse<R> advance(State<R>& s, const StrainIncrement<R>& at) const {
      const R one(S(1));
      const R t = trace(at.gradient);
      s.e = mul_add(t, one + s.e, s.e);
      const R moved = strain(bounded(s.e));
      const bool relaxes = at.volume_relaxation > S(0);
      if (relaxes) {
        const R pace(volume_relaxation() * at.volume_relaxation), share = relaxed_share(pace);
        s.e = tension ? mul_add(share, measured_volume(at) - one - s.e, s.e)
                      : relaxed_strain(s.e, at, share, disturbed(at, pace));
      }
      s.e = bounded(s.e);
      const R e = strain(s.e);
      StressResponse<R> r = respond(s);
      if (relaxes) r.dissipation.relaxed = given_up(moved, e);
      return r;
    }

    /// 2 mu J dev(D), `strain` = dt D. `r.tau`: a pressure.
    template <class R>
    DM_FN void add_viscous(const State<R>& s, const Sym3<R>& strain, const R& dt, StressResponse<R>& r) const {
      const R scale = R(S(2) * mu) / dt * volume_ratio(s);
      const Sym3<R> sheared = plus_isotropic(strain, (strain.xx + strain.yy + strain.zz) * R(S(-1) / S(3)));
      r.tau = mul_add_isotropic(sheared, scale, r.tau.xx);
      r.dissipation.viscous = fused_norm2(sheared) * scale;
    }
  };
};

}  // namespace dreampm

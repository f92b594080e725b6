// The interface of a constitutive law at one particle, over the lane contract R.
#pragma once
#include <type_traits>

#include "dreampm/math/mat3.h"
#include "dreampm/math/scalar.h"
#include "dreampm/physics/volume_correction.h"

namespace dreampm {

/// The grid's data for a law in one step.
template <class R>
struct StrainIncrement {
  Mat3<R> gradient;  ///< dt grad v [1]
  R dt;              ///< s
  R volume;  ///< measured at the old position, over that at rest [1]; only if the law wants a density, and of those
             ///< that are relaxed only in a step that does
  /// s/m: the time since the last volume relaxation over 300 dx; 0 in a step that does not. Times
  /// the law's pace [m/s] it is dt/tau, tau = 300 dx/c.
  Scalar<R> volume_relaxation;
  // Members for liquids, in a step that relaxes their volume:
  R strain = R(Scalar<R>(0));          ///< |sym grad v| times the time since the last volume relaxation [1]
  R inside = R(Scalar<R>(1));          ///< 0 to 1: 1 where the nodes around are full, 0 at surfaces
  R surface_filled = R(Scalar<R>(1));  ///< factor of `volume` as if nodes at surfaces were full; at most 1
  /// Times this, `volume` is corrected for the surface: 1 at rest density, wherever the particle
  /// lies (physics/shift.h:reading_at_rest_density); 0 where the shape of the matter allows no
  /// reading.
  R at_rest = R(Scalar<R>(1));
};

/// A measured volume over that at rest, moved from the old position to the new time. Measurements
/// of next to nothing say nothing.
template <class R>
DM_FN R moved_volume(const R& volume, const Mat3<R>& gradient) {
  using S = Scalar<R>;
  return min(volume * max(R(S(1)) + trace(gradient), R(S(0.1))), R(S(1 / 0.3)));
}
template <class R>
DM_FN R measured_volume(const StrainIncrement<R>& at) {
  return moved_volume(at.volume, at.gradient);
}

/// The swelling of a liquid, from the measured volume corrected for the surface.
template <class R>
struct Swelling {
  R strain;  ///< volume over that at rest, less 1 [1]
  R belief;  ///< 0 to 1

  explicit DM_FN Swelling(const StrainIncrement<R>& at)
      : strain(moved_volume(at.volume * at.at_rest, at.gradient) - R(S(1))) {
    belief = min(max((strain - R(S(VolumeCorrection::swelling_noise))) *
                         R(S(1 / (VolumeCorrection::swelling_believed - VolumeCorrection::swelling_noise))),
                     R(S(0))),
                 R(S(1)));
  }
  /// The widest gap that a volume relaxation opens here [1].
  DM_FN R gap() const { return min(belief * max(strain, R(S(0))), R(S(VolumeCorrection::widest_gap))); }

 private:
  using S = Scalar<R>;
};

/// Returns the share of a relaxation after x >= 0 of its time: 1 - e^-x within x^4/24, and no more
/// than 2/3, as from 1 on. The x of a stable step are below 0.1. Digits that the difference would
/// lose are kept, and no e is raised for every particle.
template <class R>
DM_FN R relaxed_share(const R& x) {
  using S = Scalar<R>;
  const R one(S(1)), short_of = min(x, one);
  return short_of * (one - short_of * (R(S(0.5)) - short_of * R(S(1.0 / 6))));
}

/// J of a particle: that of its state, unless the law keeps more there than the volume of its
/// matter.
template <class Law, class State>
DM_FN auto volume_ratio(const Law& law, const State& state) {
  if constexpr (requires { law.volume_ratio(state); })
    return law.volume_ratio(state);
  else
    return state.volume_ratio();
}

/// Matter counts as pressed below this volume ratio (log J < -0.001, as in the program of Fei et
/// al. 2021).
inline constexpr double pressed_ratio = 0.999;

/// Returns the degree from 0 to 1 to which matter has come apart, so that it may move by itself
/// (ASFLIP). It follows from the volume, unless the law has its own.
template <class Law, class State>
DM_FN auto separated_fraction(const Law& law, const State& state) {
  if constexpr (requires { law.separated_fraction(state); }) {
    return law.separated_fraction(state);
  } else {
    const auto ratio = volume_ratio(law, state);
    using R = std::remove_cv_t<decltype(ratio)>;
    using S = Scalar<R>;
    return select(ratio < R(S(pressed_ratio)), R(S(0)), R(S(1)));
  }
}

/// F after the step.
template <class R>
DM_FN Mat3<R> deformed(const Mat3<R>& f, const StrainIncrement<R>& at) {
  return mul_add(at.gradient, f, f);
}

/// Mechanical energy that a step turned into heat [J/m^3 of rest volume].
template <class R>
struct Dissipation {
  R viscous = R(Scalar<R>(0));
  R plastic = R(Scalar<R>(0));  ///< given up by the projection onto what may be elastic
  R relaxed = R(Scalar<R>(0));  ///< given up where J or gaps are drawn to the measured density
};

/// The result of a law.
template <class R>
struct StressResponse {
  Sym3<R> tau;                      ///< Kirchhoff stress J sigma [Pa]
  R energy;                         ///< stored elastic energy per rest volume [J/m^3]
  R sound_speed;                    ///< bound of the wave speed in the present state [m/s]
  R kinematic_viscosity;            ///< m^2/s, of a law that is Viscous: an explicit step is bounded by it. Of others 0
  Dissipation<R> dissipation = {};  ///< of the step; only `advance` fills it
  /// m^2/s, at the present rate of shear, of a law that solves its viscosity implicitly: it bounds
  /// no step, but says how the liquid clings to solids.
  R implicit_viscosity = R(Scalar<R>(0));
};

/// Adds the viscous stress of a step to the response of a law, and its heat; of laws that are not
/// viscous nothing.
template <class Law, class State, class R>
DM_FN void add_viscous(const Law& law, const State& state, const StrainIncrement<R>& at, StressResponse<R>& response) {
  if constexpr (requires { law.add_viscous(state, Sym3<R>(), at.dt, response); })
    law.add_viscous(state, symmetric_part(at.gradient), at.dt, response);
}

/// A step of a law with its viscosity.
template <class Law, class State, class R>
DM_FN StressResponse<R> advanced(const Law& law, State& state, const StrainIncrement<R>& at) {
  StressResponse<R> response = law.advance(state, at);
  add_viscous(law, state, at, response);
  return response;
}

/// Materials with a viscosity that has to be explicit or sub-cycled: whose law has
/// `add_viscous(state, strain, dt, response)`, strain = dt D.
template <class M>
concept Viscous = requires(const typename M::template Law<float>& law, const typename M::template State<float>& state,
                           StressResponse<float>& response) { law.add_viscous(state, Sym3<float>(), 1.0f, response); };

}  // namespace dreampm

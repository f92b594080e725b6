#include "validate/impact.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "dreampm/physics/materials.h"

namespace dreampm::validate {
namespace {

constexpr double fine = 2e-3, most = 20;

/// One load after another on the same particle, `strain` a step.
template <class M>
class Drive {
 public:
  Drive(const Values& values, const Load& load, double strain, ImpactBounds& worst)
      : law_(M::template Law<double>::from(values)), load_(load), strain_(strain), worst_(worst) {
    for (int c = 0; c < state_columns<M>; ++c) s_[c] = M::template State<double>::rest[c];
  }
  void along(const Mat3d& direction) {
    StrainIncrement<double> at{};
    at.gradient = direction * strain_;
    at.dt = strain_ * load_.time;
    const double rate = std::exp(trace(at.gradient));
    double work = 0, ratio = 1;
    while (work < load_.energy && ratio > 1 / most && ratio < most) {
      at.volume = volume_;
      const StressResponse<double> r = advanced(law_, s_, at);
      // States that no longer give finite numbers are outside of the reach of a run.
      if (!std::isfinite(r.energy) || !std::isfinite(r.sound_speed)) return;
      worst_.sound_speed = std::max(worst_.sound_speed, r.sound_speed);
      worst_.viscosity = std::max(worst_.viscosity, r.kinematic_viscosity);
      const Mat3d& d = at.gradient;
      work += std::max(0.0, r.tau.xx * d(0, 0) + r.tau.yy * d(1, 1) + r.tau.zz * d(2, 2));
      ratio *= rate;
      volume_ *= rate;
    }
  }

 private:
  typename M::template Law<double> law_;
  typename M::template State<double> s_;
  Load load_;
  double strain_, volume_ = 1;
  ImpactBounds& worst_;
};

}  // namespace

ImpactBounds impact(std::string_view material, const Values& values, const Load& load) {
  const Mat3d press = Mat3d::diagonal(-1, -1, -1), flatten = Mat3d::diagonal(0, -1, 0);
  const Mat3d swell = Mat3d::diagonal(1, 1, 1), pull = Mat3d::diagonal(0, 1, 0);
  ImpactBounds worst;
  const bool known = Materials::with(material, [&]<class M>() {
    for (const double strain : {fine, load.coarse})
      for (const Mat3d& first : {press, flatten, pull})
        for (const Mat3d& then : {swell, pull}) {
          Drive<M> drive(values, load, strain, worst);
          drive.along(first);
          drive.along(then);
        }
  });
  if (!known) throw std::out_of_range("no material " + std::string(material));
  return worst;
}

}  // namespace dreampm::validate

#include "dreampm/validate/crush.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "dreampm/physics/materials.h"

namespace dreampm::validate {
namespace {

constexpr double strain = 2e-3, most = 20;

template <class M>
void drive(const Values& values, const Mat3d& direction, double energy, double time, Crushed& worst) {
  const auto law = M::template Law<double>::from(values);
  typename M::template State<double> s;
  for (int c = 0; c < state_columns<M>; ++c) s[c] = M::template State<double>::rest[c];
  Local<double> at{};
  at.gradient = direction * strain;
  at.dt = strain * time;
  at.density = 1;
  const double rate = std::exp(trace(at.gradient));
  double work = 0, ratio = 1;
  while (work < energy && ratio > 1 / most && ratio < most) {
    const Response<double> r = law.advance(s, at);
    // What no longer gives numbers is outside of what a run can reach.
    if (!std::isfinite(r.energy) || !std::isfinite(r.sound_speed)) return;
    worst.sound_speed = std::max(worst.sound_speed, r.sound_speed);
    worst.viscosity = std::max(worst.viscosity, r.kinematic_viscosity);
    const Mat3d& d = at.gradient;
    work += std::max(0.0, r.tau.xx * d(0, 0) + r.tau.yy * d(1, 1) + r.tau.zz * d(2, 2));
    ratio *= rate;
    at.density /= rate;
  }
}

}  // namespace

Crushed crush(std::string_view material, const Values& values, double energy, double time) {
  Crushed worst;
  const bool known = Materials::with(material, [&]<class M>() {
    for (const Mat3d& direction : {Mat3d::diagonal(-1, -1, -1), Mat3d::diagonal(0, -1, 0), Mat3d::diagonal(0, 1, 0)})
      drive<M>(values, direction, energy, time, worst);
  });
  if (!known) throw std::out_of_range("no material " + std::string(material));
  return worst;
}

}  // namespace dreampm::validate

// The listing of docs/howto/add-a-material.md, compiled and held to what that page asks of a law.
#include <gtest/gtest.h>

#include <howto/kelvin_voigt.h>
#include <cmath>

using namespace dreampm;

namespace {

using Law = KelvinVoigt::Law<double>;
using State = KelvinVoigt::State<double>;

Law law() {
  Values values;
  values.with_defaults(KelvinVoigt::info.params);
  return Law::from(values);
}

State state(std::initializer_list<double> f) {
  State s;
  int i = 0;
  for (const double x : f) s[i++] = x;
  return s;
}

const std::initializer_list<double> sheared{1.1, 0.2, -0.1, 0.05, 0.9, 0.15, -0.2, 0.1, 1.2};

TEST(HowTo, NoStressAtRest) {
  State s;
  for (int i = 0; i < 9; ++i) s[i] = State::rest[i];
  const StressResponse<double> r = law().respond(s);
  EXPECT_EQ(norm2(r.tau.full()), 0);
  EXPECT_EQ(r.energy, 0);
  EXPECT_NEAR(r.sound_speed, std::sqrt((2e4 * 3 + 4e4) / 1000), 1e-9) << "at least the speed of P waves";
}

TEST(HowTo, StressIsTheDerivativeOfEnergy) {
  const State s = state(sheared);
  const Mat3<double> tau = law().respond(s).tau.full();
  constexpr double h = 1e-6;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      StrainIncrement<double> at{};
      at.gradient(i, j) = h;
      State plus = s, minus = s;
      const double up = advanced(law(), plus, at).energy;
      at.gradient(i, j) = -h;
      const double down = advanced(law(), minus, at).energy;
      // Central differences: the error is of h^2, and of rounding, 1e-16 1e4 J/m^3 / h.
      EXPECT_NEAR((up - down) / (2 * h), tau(i, j), 1e-4) << i << j;
    }
}

TEST(HowTo, TheDashpotActsAgainstTheRate) {
  // A shear of 50/s, eta 1 Pa s, from rest: 50 Pa, and the spring's mu gamma.
  State s;
  for (int i = 0; i < 9; ++i) s[i] = State::rest[i];
  StrainIncrement<double> at{};
  at.dt = 1e-5;
  at.gradient(0, 1) = 50 * at.dt;
  EXPECT_NEAR(advanced(law(), s, at).tau.xy, 50 + 1e4 * 50 * at.dt, 1e-9);
}

TEST(HowTo, TheDashpotsHeatIsItsStressTimesTheStrain) {
  State s = state(sheared);
  StrainIncrement<double> at{};
  at.dt = 1e-4;
  at.gradient = {{1e-3, 4e-3, -2e-3, 0, -3e-3, 1e-3, 2e-3, 5e-3, 2e-3}};
  const StressResponse<double> r = advanced(law(), s, at);
  const Mat3<double> dashpot = r.tau.full() - law().respond(s).tau.full();
  double work = 0;
  for (int i = 0; i < 9; ++i) work += dashpot.m[i] * at.gradient.m[i];
  EXPECT_GT(work, 0);
  EXPECT_NEAR(r.dissipation.viscous, work, 1e-9 * work);
  EXPECT_EQ(r.dissipation.plastic, 0);
  EXPECT_EQ(law().respond(s).dissipation.viscous, 0) << "only a step makes heat";
}

TEST(HowTo, ATurnedBodyHasTurnedStress) {
  const double c = std::cos(0.7), n = std::sin(0.7);
  const Mat3<double> q{{c, -n, 0, n, c, 0, 0, 0, 1}};
  const State s = state(sheared);
  State turned;
  turned.f = q * s.f;
  const StressResponse<double> a = law().respond(s), b = law().respond(turned);
  EXPECT_NEAR(a.energy, b.energy, 1e-9);
  EXPECT_LT(norm2(q * a.tau.full() * transpose(q) - b.tau.full()), 1e-16);
}

}  // namespace

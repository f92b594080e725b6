// Rules that every law of the list must obey: rest, frame indifference, stress from energy, a
// bounded wave speed.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "states.h"

namespace dreampm {
namespace {
using namespace test;

double largest(const Sym3<double>& s) { return std::sqrt(norm2(s.full())); }

/// rho0 c^2 [Pa]: what stress is measured against.
template <class R>
double stiffness(const StressResponse<R>& r, const Values& v) {
  return v["density"] * static_cast<double>(r.sound_speed) * static_cast<double>(r.sound_speed);
}

constexpr double ulp = std::numeric_limits<double>::epsilon();

/// Rounding of an answer, and of one after a past of six steps: hardening multiplies each ulp of Jp
/// by xi, 20 at most.
constexpr double rounding = 100 * ulp, past_rounding = 1000 * ulp;

/// Calls body(values, law) with values of every kind until one fails.
template <class M, class Body>
void for_kinds(int draws, Rng& rng, const Body& body) {
  const auto* so_far = testing::UnitTest::GetInstance()->current_test_info()->result();
  const int failures = so_far->total_part_count();
  for (const Values& v : kinds(M::info, draws, rng)) {
    SCOPED_TRACE(std::string(M::info.name) + " with " + text_of(v));
    body(v, M::template Law<double>::from(v));
    if (so_far->total_part_count() > failures) return;
  }
}

/// True if the report's program, which has no bound on its exponent, overflowed.
bool overflowed(const Values& v, const StressResponse<double>& r) {
  return v.has("legacy") && v["legacy"] != 0 && !std::isnormal(r.sound_speed);
}

TEST(Laws, NoStressAtRest) {
  Materials::for_each([]<class M>() {
    Rng rng(2);
    for_kinds<M>(500, rng, [](const Values& v, const auto& law) {
      auto s = rest_state<M, double>();
      const auto still = law.respond(s);
      EXPECT_LE(largest(still.tau), 1e-14 * stiffness(still, v));
      EXPECT_LE(std::abs(still.energy), 1e-14 * stiffness(still, v));
      EXPECT_GT(still.sound_speed, 0);
      const auto stepped = advanced(law, s, local<double>({}));
      EXPECT_LE(largest(stepped.tau), 1e-14 * stiffness(still, v));
      EXPECT_NEAR(volume_ratio(law, s), 1, 1e-14);
    });
  });
}

TEST(Laws, IsotropicUnderATurnedPast) {
  // G_i -> Q G_i Q^T for a whole past turns the stress: tau -> Q tau Q^T.
  Materials::for_each([]<class M>() {
    Rng rng(3);
    double most = 0;
    for_kinds<M>(500, rng, [&](const Values& v, const auto& law) {
      for (int trial = 0; trial < 10; ++trial) {
        const Mat3d q = random_rotation(rng);
        auto a = rest_state<M, double>(), b = a;
        StressResponse<double> ra{}, rb{};
        for (int i = 0; i < 6; ++i) {
          const Mat3d g = random_matrix(rng, 0.1);
          const double density = between(rng, 0.9, 1.1);
          ra = advanced(law, a, local<double>(g, density));
          rb = advanced(law, b, local<double>(q * g * transpose(q), density));
        }
        const double scale = stiffness(ra, v) + largest(ra.tau);
        most = std::max(most, largest(ra.tau) / scale);
        EXPECT_LE(std::sqrt(norm2(rb.tau.full() - q * ra.tau.full() * transpose(q))), past_rounding * scale);
        EXPECT_NEAR(ra.energy, rb.energy, past_rounding * scale);
        EXPECT_NEAR(volume_ratio(law, a), volume_ratio(law, b), rounding);
      }
    });
    EXPECT_GT(most, 1e-4);  // there was a stress to turn
  });
}

TEST(Laws, ASolidTurnedAsAWholeTurnsItsStress) {
  // tau(Q F) = Q tau(F) Q^T
  Materials::for_each([]<class M>() {
    if constexpr (stores_f<M>()) {
      Rng rng(4);
      for_kinds<M>(500, rng, [&](const Values& v, const auto& law) {
        for (int trial = 0; trial < 10; ++trial) {
          auto s = random_state<M, double>(law, rng, 0.2);
          const auto before = law.respond(s);
          const Mat3d q = random_rotation(rng);
          s.f = q * s.f;
          const auto after = law.respond(s);
          const double scale = stiffness(before, v) + largest(before.tau);
          EXPECT_LE(std::sqrt(norm2(after.tau.full() - q * before.tau.full() * transpose(q))), rounding * scale);
          EXPECT_NEAR(before.energy, after.energy, rounding * scale);
        }
      });
    }
  });
}

/// F -> (1 + h D) F with the rest of the state frozen; false if the state holds neither F nor J -
/// 1.
template <class M>
bool deform(typename M::template State<double>& s, const Mat3d& d, double h) {
  if constexpr (stores_f<M>()) {
    s.f = s.f + d * s.f * h;
    return true;
  } else if constexpr (stores_e<M>()) {
    s.e += (1 + s.e) * (determinant(Mat3d::identity() + d * h) - 1);
    return true;
  } else {
    return false;
  }
}

/// Random states that the law leaves behind, some of them far from rest: from inverted, flat and
/// much stretched F where the state is F.
template <class M>
typename M::template State<double> any_state(const typename M::template Law<double>& law, Rng& rng) {
  auto s = random_state<M, double>(law, rng, 0.15);
  if constexpr (stores_f<M>()) {
    const int kind = static_cast<int>(rng() % 4);
    const auto stretch = [&] { return std::exp(between(rng, -1.5, 1.5)); };
    if (kind > 0)
      s.f = random_rotation(rng) * Mat3d::diagonal(stretch(), stretch(), kind == 2 ? -stretch() : stretch()) *
            random_rotation(rng);
    if (kind == 3) s.f = random_rotation(rng) * Mat3d::diagonal(1.2, 0.9, 0.01) * random_rotation(rng);
    law.advance(s, local<double>({}));
  }
  return s;
}

/// The mean of tau : D on the way from (1 - h D) F to (1 + h D) F, by Simpson's rule on either side
/// of the state: volume relaxation leaves liquids just where they begin to press, and what is
/// inside out may be near a bend of its energy.
template <class M, class Law>
double mean_work(const Law& law, const typename M::template State<double>& s, const Mat3d& d, double h) {
  double sum = 0;
  const double weights[] = {1, 4, 2, 4, 1};
  for (int i = 0; i < 5; ++i) {
    auto there = s;
    deform<M>(there, d, (i - 2) * h / 2);
    const Mat3d tau = law.respond(there).tau.full();
    for (int k = 0; k < 9; ++k) sum += weights[i] / 12 * tau.m[k] * d.m[k];
  }
  return sum;
}

TEST(Laws, StressIsTheDerivativeOfTheEnergy) {
  Materials::for_each([]<class M>() {
    int checked = 0;
    Rng rng(5);
    for_kinds<M>(500, rng, [&](const Values& v, const auto& law) {
      for (int trial = 0; trial < 20; ++trial) {
        const auto s = any_state<M>(law, rng);
        const auto r = law.respond(s);
        if (overflowed(v, r)) continue;
        const Mat3d d = random_matrix(rng, 1);
        const double h = 1e-6;
        auto more = s, less = s;
        if (!deform<M>(more, d, h) || !deform<M>(less, d, -h)) break;
        const double slope = (law.respond(more).energy - law.respond(less).energy) / (2 * h);
        // Each energy errs by some ulp.
        const double scale = stiffness(r, v) + largest(r.tau) + std::abs(r.energy);
        EXPECT_NEAR(slope, mean_work<M>(law, s, d, h), 20 * ulp / h * scale);
        ++checked;
      }
    });
    if (checked == 0)
      std::printf("%s: neither F nor J - 1 in its state, energy not checked\n", std::string(M::info.name).c_str());
  });
}

TEST(Laws, AStepAnswersForTheStateThatItLeaves) {
  // So that what holds of `respond` holds of a step. The report's program hardens by the state
  // before.
  Materials::for_each([]<class M>() {
    Rng rng(19);
    for_kinds<M>(500, rng, [&](const Values& v, const auto& law) {
      if (v.has("legacy") && v["legacy"] != 0) return;
      for (int trial = 0; trial < 10; ++trial) {
        auto s = any_state<M>(law, rng);
        const auto stepped = law.advance(s, local<double>(random_matrix(rng, 0.2), between(rng, 0.9, 1.1)));
        const auto left = law.respond(s);
        const double scale = stiffness(left, v) + largest(left.tau);
        EXPECT_LE(std::sqrt(norm2(stepped.tau.full() - left.tau.full())), rounding * scale);
        EXPECT_NEAR(stepped.energy, left.energy, rounding * scale);
        EXPECT_NEAR(stepped.sound_speed, left.sound_speed, rounding * left.sound_speed);
      }
    });
  });
}

TEST(Laws, TheWaveSpeedIsABound) {
  // P waves along n: rho0 c^2 = d tau_nn/d eps_nn - tau_nn, from P = tau F^-T.
  Materials::for_each([]<class M>() {
    SCOPED_TRACE(M::info.name);
    Rng rng(6);
    double closest = 0;
    for (int trial = 0; trial < 3000; ++trial) {
      Values given;
      if (const Param* nu = M::info.find("poissons_ratio"); nu && trial % 3)
        given.set("poissons_ratio", trial % 3 == 1 ? nu->min : nu->max);
      // Every other one with values from anywhere in the ranges of all parameters.
      if (trial % 2)
        for (const Param& p : M::info.params) given.set(p.key, pick(p, rng));
      const Values v = within_range(M::info, given);
      const auto law = M::template Law<double>::from(v);
      const auto s = any_state<M>(law, rng);
      const auto r = law.respond(s);
      Vec3d n{between(rng, -1, 1), between(rng, -1, 1), between(rng, -1, 1)};
      n = normalized(n);
      const double h = 1e-6;
      auto more = s, less = s;
      if (!deform<M>(more, outer(n, n), h) || !deform<M>(less, outer(n, n), -h)) break;
      const auto along = [&](const StressResponse<double>& x) { return dot(n, x.tau * n); };
      const double wave2 = (along(law.respond(more)) - along(law.respond(less))) / (2 * h) - along(r);
      const double c = std::sqrt(std::max(wave2 / v["density"], 0.0));
      EXPECT_LE(c, r.sound_speed * (1 + 1e-6)) << text_of(v);
      closest = std::max(closest, c / r.sound_speed);
    }
    std::printf("%s: waves up to %.3f of the bound\n", std::string(M::info.name).c_str(), closest);
  });
}

/// A dashpot whose law keeps its viscosity to itself, in `advance`. `honest`: whether it reports
/// it.
template <bool honest>
struct Dashpot {
  template <class R>
  using State = Newtonian::State<R>;
  template <class S>
  struct Law {
    S eta, density;
    template <class R>
    StressResponse<R> advance(State<R>&, const StrainIncrement<R>& at) const {
      return {symmetric_part(at.gradient) * R((eta + eta) / at.dt), R(0), R(1), honest ? R(eta / density) : R(0)};
    }
  };
};

TEST(Laws, ViscosityIsReportedAndKnownToBeExplicit) {
  Materials::for_each([]<class M>() {
    SCOPED_TRACE(M::info.name);
    Rng rng(17);
    int failures = 0;
    for (int trial = 0; trial < 1000 && failures < 5; ++trial) {
      Values given;
      if (trial % 2)
        for (const Param& p : M::info.params) given.set(p.key, pick(p, rng));
      const Values v = within_range(M::info, given);
      const auto law = M::template Law<double>::from(v);
      const auto s = any_state<M>(law, rng);
      const std::string wrong = viscosity_complaint<M>(law, v, s, random_matrix(rng, 0.1));
      if (!wrong.empty()) ADD_FAILURE() << wrong << " with " << text_of(v), ++failures;
    }
  });
  // One that keeps it in `advance` is found out, thin as it may be, unless it says so.
  Values v;
  v.set("density", 1000);
  Rng rng(18);
  const Mat3d strain = random_matrix(rng, 0.1);
  for (const double eta : {1e-6, 1e-3, 10.0}) {
    EXPECT_NE(viscosity_complaint<Dashpot<false>>({eta, 1000}, v, {0}, strain), "") << eta;
    EXPECT_EQ(viscosity_complaint<Dashpot<true>>({eta, 1000}, v, {0}, strain), "") << eta;
  }
}

TEST(Newtonian, ViscousStressOfAShear) {
  const Values v = complete(Newtonian::info, [] {
    Values g;
    g.set("viscosity", 3.0);
    g.set("relaxation", 0);
    return g;
  }());
  const auto law = Newtonian::Law<double>::from(v);
  Newtonian::State<double> s{0};
  const double rate = 50, dt = 1e-4;
  Mat3d g;
  g(0, 1) = rate * dt;
  const auto r = advanced(law, s, local<double>(g, 1, dt));
  EXPECT_NEAR(r.tau.xy, 3.0 * rate, 1e-9);  // mu du/dy
  EXPECT_NEAR(r.tau.xx, 0, 1e-9);
  EXPECT_NEAR(r.kinematic_viscosity, 3.0 / 1000, 1e-15);
}

TEST(Laws, ARelaxationGoesAsFarAsItsTimeTells) {
  for (const double x : {0.0, 1e-7, 1.3e-3, 0.03, 0.1, 0.5}) {
    EXPECT_NEAR(relaxed_share(x), -std::expm1(-x), x * x * x * x / 24 + 1e-16) << x;
    EXPECT_NEAR(relaxed_share(static_cast<float>(x)), -std::expm1(-x), x * x * x * x / 24 + 3e-7 * x) << x;
  }
  for (const double x : {1.0, 3.0, 1e30}) EXPECT_DOUBLE_EQ(relaxed_share(x), 2.0 / 3) << x;
}

TEST(Newtonian, PullsOnlyIfToldAndIsDrawnToTheMeasuredDensity) {
  Values given;
  given.set("relaxation", 0);
  Mat3d swell = Mat3d::diagonal(0.01, 0.01, 0.01);
  Newtonian::State<double> s{0};
  const auto torn = Newtonian::Law<double>::from(complete(Newtonian::info, given));
  EXPECT_EQ(torn.advance(s, local<double>(swell)).energy, 0);
  EXPECT_EQ(torn.respond(s).tau.xx, 0);
  EXPECT_EQ(volume_ratio(torn, s), 1) << "gaps are none of the liquid's volume";
  given.set("tension", 1);
  s.e = 0;
  const auto held = Newtonian::Law<double>::from(complete(Newtonian::info, given));
  EXPECT_GT(held.advance(s, local<double>(swell)).tau.xx, 0);
  EXPECT_NEAR(volume_ratio(held, s), 1.03, 1e-15);

  // e + r (volume - 1 - e) with r = 1 - exp(-dt c/(300 dx)): the time constant of 300 cells of
  // sound.
  const Values v = complete(Newtonian::info);
  const auto law = Newtonian::Law<double>::from(v);
  const double c = std::sqrt(v["bulk_modulus"] / v["density"]), cell = 0.02, dt = 1e-4;
  const double tau = 300 * cell / c;
  s.e = 0;
  StrainIncrement<double> at{{}, dt, 1 / 1.05, dt / (300 * cell)};
  const int n = static_cast<int>(std::lround(tau / dt));
  for (int i = 0; i < n; ++i) law.advance(s, at);
  const double goal = 1 / 1.05 - 1;
  EXPECT_NEAR(s.e, goal * (1 - std::exp(-n * dt / tau)), 1e-12);
}

TEST(Newtonian, PressesOnlyAfterItsGapsHaveClosed) {
  const Values v = complete(Newtonian::info);
  const auto law = Newtonian::Law<double>::from(v);
  const double c = std::sqrt(v["bulk_modulus"] / v["density"]), cell = 0.02, dt = 1e-4, tau = 300 * cell / c;
  const auto by = [&](Newtonian::State<double>& s, double strain, double density = 1, double volume_relaxation = 0) {
    const double each = (std::cbrt(1 + strain) - 1);
    // A density below 1 is the reading of a surface at rest.
    return law.advance(s, StrainIncrement<double>{Mat3d::diagonal(each, each, each), dt, 1 / density, volume_relaxation,
                                                  0, 1, 1, density});
  };
  // Torn by a tenth and pressed again: first the gap closes.
  Newtonian::State<double> s{0};
  by(s, 0.1);
  EXPECT_EQ(by(s, -0.05).tau.xx, 0);
  EXPECT_LT(by(s, -0.06).tau.xx, 0);
  // At a surface at rest they are forgotten in the time of the volume relaxation, which opens none.
  const int n = static_cast<int>(std::lround(tau / dt));
  s.e = 0.1;
  for (int i = 0; i < n; ++i) by(s, 0, 0.5, dt / (300 * cell));
  EXPECT_NEAR(s.e, 0.1 * std::exp(-1.0), 1e-5);
  s.e = -0.01;
  for (int i = 0; i < 5 * n; ++i) by(s, 0, 0.5, dt / (300 * cell));
  EXPECT_EQ(s.e, 0);
}

// ASFLIP moves matter that has come apart. At rest the strain of a liquid is noise about 0, and is
// no sign of that.
TEST(Laws, MatterHasComeApartByItsGapsOrByItsVolume) {
  const auto water = Newtonian::Law<double>::from(complete(Newtonian::info));
  const auto of_water = [&](double e) { return separated_fraction(water, Newtonian::State<double>{e}); };
  for (const double e : {-0.01, -1e-6, 0.0}) EXPECT_EQ(of_water(e), 0) << e;
  EXPECT_NEAR(of_water(0.01), 0.2, 1e-12);
  for (const double e : {0.05, 3.0}) EXPECT_EQ(of_water(e), 1) << e;
  const auto jelly = Elastic::Law<double>::from(complete(Elastic::info));
  const auto of_jelly = [&](double j) {
    return separated_fraction(jelly, Elastic::State<double>{Mat3d::diagonal(1, j, 1)});
  };
  EXPECT_EQ(of_jelly(0.998), 0);
  for (const double j : {0.9995, 1.1}) EXPECT_EQ(of_jelly(j), 1) << j;
}

// A surface reads loose, and at rest has to press all the same. Where it is strained it may have
// become loose.
TEST(Newtonian, ALooseReadingOfASurfaceCountsByStrain) {
  const Values v = complete(Newtonian::info);
  const auto law = Newtonian::Law<double>::from(v);
  const double pace = 1e-3, share = 1 - std::exp(-pace), e = -0.03;
  // The surface corrects the volume to that at rest.
  const auto taken = [&](double seen, double strained, double inside, double surface_filled = 1) {
    Newtonian::State<double> s{e};
    const double at_rest = 1 / (1 + seen);
    law.advance(s, StrainIncrement<double>{
                       {}, 1e-4, 1 + seen, pace / law.volume_relaxation(), strained, inside, surface_filled, at_rest});
    return (s.e - e) / (share * (seen - e));
  };
  EXPECT_NEAR(taken(0.01, 0, 1), 1, 1e-9);
  EXPECT_NEAR(taken(0.01, 0, 0.4), 0.4, 1e-9);
  EXPECT_EQ(taken(0.01, 0, 0), 0);
  // Strained surfaces go to rest, and no further.
  EXPECT_NEAR(taken(0.01, pace / 3, 0), 0.75, 1e-9);
  EXPECT_NEAR(taken(0.01, pace / 6, 0), 0.75 * 0.25, 1e-9);
  EXPECT_NEAR(taken(0.01, 1, 0), 0.75, 1e-9);
  for (const double strained : {0.0, 1.0}) EXPECT_NEAR(taken(-0.05, strained, 0), 1, 1e-9) << "denser than believed";
  // Below a surface, what its nodes lack is no looseness, unless matter is torn there.
  EXPECT_NEAR(taken(0.05, 0, 1, 0.94 / 1.05), 0, 1e-9);
  EXPECT_NEAR(taken(0.05, 0, 0.5, 0.99 / 1.05), 0.5 * 0.02 / 0.08, 1e-9);
  EXPECT_NEAR(taken(0.05, 1, 0.5, 0.94 / 1.05), 0.03 / 0.08, 1e-9);
  EXPECT_NEAR(taken(-0.05, 0, 1, 0.9), 1, 1e-9);
}

// Liquid at rest that takes more than its volume after the surface is corrected for: a volume
// relaxation opens a gap of 0.04 at most, whatever the strain and however near to a surface, so
// that the liquid sinks.
TEST(Newtonian, SwollenLiquidIsGivenGaps) {
  const auto law = Newtonian::Law<double>::from(complete(Newtonian::info));
  const double pace = 1e-3, share = 1 - std::exp(-pace);
  const auto after = [&](double e, double volume, double at_rest, int times = 1) {
    Newtonian::State<double> s{e};
    for (int k = 0; k < times; ++k)
      law.advance(s, StrainIncrement<double>{{}, 1e-4, volume, pace / law.volume_relaxation(), 0, 0, 1, at_rest});
    return s.e;
  };
  EXPECT_EQ(after(0, 2, 0.5), 0) << "a surface at rest";
  EXPECT_EQ(after(0, 2, 0.509), 0) << "noise of one";
  EXPECT_EQ(after(0, 5, 0), 0) << "a film: nothing is known";
  EXPECT_NEAR(after(0, 2, 0.6), VolumeCorrection::swelling_pace * share * 0.2, 1e-12);
  EXPECT_NEAR(after(-0.03, 2, 0.6), -0.03 + VolumeCorrection::swelling_pace * share * 0.23, 1e-12);
  EXPECT_NEAR(after(0, 2, 0.52), VolumeCorrection::swelling_pace * share * 0.5 * 0.04, 1e-12) << "half believed";
  // Pressed again and again, the gap of a step is 0.04 at most.
  EXPECT_LE(after(-0.3, 3, 1, 100000), VolumeCorrection::widest_gap);
  EXPECT_LT(VolumeCorrection::widest_gap, VolumeCorrection::parted_strain) << "no gap of a relaxation counts as torn";
}

}  // namespace
}  // namespace dreampm

// Elastic matter that is crushed or turned inside out is driven back.
#include <gtest/gtest.h>

#include <cmath>

#include "states.h"

namespace dreampm {
namespace {
using namespace test;

/// Calls body(values, law, K) for laws of elastic solids, K = lambda + 2 mu.
template <class M, class Body>
void for_solids(const Body& body) {
  for (const double nu : {0.0, 0.3, 0.495}) {
    Values v;
    v.set("poissons_ratio", nu);
    v = complete(M::info, v);
    SCOPED_TRACE(std::string(M::info.name) + " with " + text_of(v));
    const Lame lame = Lame::of(v["youngs_modulus"], nu);
    body(v, M::template Law<double>::from(v), lame.lambda + 2 * lame.mu);
  }
}
template <class Body>
void for_all_solids(const Body& body) {
  for_solids<Elastic>([&](const auto&... of) { body.template operator()<Elastic>(of...); });
  for_solids<NeoHookean>([&](const auto&... of) { body.template operator()<NeoHookean>(of...); });
}

/// Pressed alike in all directions, in one, and in two.
std::vector<Mat3d> ways_to(double j) {
  const double s = std::cbrt(j), two = std::sqrt(j);
  return {Mat3d::diagonal(s, s, s), Mat3d::diagonal(1, j, 1), Mat3d::diagonal(two, 1, two),
          Mat3d::diagonal(2, j / 4, 2)};
}

TEST(Crushed, ThePressureGrowsWithoutBoundTowardsNothing) {
  for_all_solids([]<class M>(const Values&, const auto& law, double k) {
    for (std::size_t way = 0; way < ways_to(1).size(); ++way) {
      double before = 0;
      for (const double j : {0.15, 0.1, 0.03, 1e-2, 1e-3, 1e-4, 1e-5}) {
        const Sym3<double> tau = law.respond(typename M::template State<double>{ways_to(j)[way]}).tau;
        // Of the axes along which it is pressed.
        const double pressed = std::min(tau.xx, tau.yy);
        EXPECT_LT(pressed, before) << j;
        before = pressed;
      }
      EXPECT_LT(before, -50 * k);
    }
  });
}

TEST(Crushed, ItsStressIsTheDerivativeOfItsEnergy) {
  for_all_solids([]<class M>(const Values& v, const auto& law, double) {
    for (const double j : {0.19, 0.1, 1e-2, 1e-4, 1e-5, 1e-6, 1e-9})
      for (const Mat3d& f : ways_to(j)) {
        const double h = 1e-5;
        const Mat3d d{{1, 0.2, 0, -0.3, 0.8, 0.1, 0, 0.4, 1.1}};
        const auto at = [&](double x) { return law.respond(typename M::template State<double>{f + d * f * x}); };
        const StressResponse<double> r = at(0);
        const double slope = (at(h).energy - at(-h).energy) / (2 * h);
        const Mat3d tau = r.tau.full();
        double work = 0;
        for (int k = 0; k < 9; ++k) work += tau.m[k] * d.m[k];
        EXPECT_NEAR(slope, work, 1e-6 * v["density"] * r.sound_speed * r.sound_speed) << j;
      }
  });
}

TEST(Crushed, WavesStayBelowTheirBound) {
  // P waves along each axis: rho c^2 = d tau_nn/d eps_nn - tau_nn.
  for_all_solids([]<class M>(const Values& v, const auto& law, double) {
    for (const double j : {0.19, 0.1, 1e-2, 1e-4, 1e-9})
      for (const Mat3d& f : ways_to(j))
        for (int axis = 0; axis < 3; ++axis) {
          Mat3d d{};
          d(axis, axis) = 1;
          const auto along = [&](double x) {
            return law.respond(typename M::template State<double>{f + d * f * x}).tau.full()(axis, axis);
          };
          const double h = 1e-5, wave2 = (along(h) - along(-h)) / (2 * h) - along(0);
          const double bound = law.respond(typename M::template State<double>{f}).sound_speed;
          EXPECT_LE(wave2, v["density"] * bound * bound * (1 + 1e-6)) << j;
          EXPECT_GE(wave2, 0) << "no wave grows " << j;
        }
  });
}

TEST(Crushed, OrdinaryStrainsKnowNothingOfIt) {
  for_all_solids([]<class M>(const Values&, const auto& law, double k) {
    const auto energy = [&](double j) {
      return law.respond(typename M::template State<double>{Mat3d::diagonal(1, j, 1)}).energy;
    };
    // mu and lambda alone: of fixed corotated K/2 (1 - j)^2, and of neo-Hookean the same here.
    for (const double j : {0.2, 0.21, 0.5, 0.9}) EXPECT_NEAR(energy(j), 0.5 * k * (1 - j) * (1 - j), 1e-12 * k) << j;
    EXPECT_GT(energy(0.15), 0.5 * k * 0.85 * 0.85 * 1.001);
  });
}

TEST(Crushed, AStepThatTurnsItInsideOutLeavesItsMirrorImage) {
  for_all_solids([]<class M>(const Values& v, const auto& law, double) {
    Rng rng(31);
    for (int trial = 0; trial < 200; ++trial) {
      auto s = random_state<M, double>(law, rng, 0.1);
      const Mat3d q = random_rotation(rng), f = s.f;
      const Mat3d gradient = q * Mat3d::diagonal(between(rng, -1.9, -1.1), 0.1, -0.2) * transpose(q);
      const Mat3d inverted = f + gradient * f;
      ASSERT_LT(determinant(inverted), 0);
      const double before = law.respond(typename M::template State<double>{inverted}).energy;
      const StressResponse<double> r = law.advance(s, local<double>(gradient));
      EXPECT_NEAR(determinant(s.f), -determinant(inverted), 1e-12);
      EXPECT_LE(norm2(s.f * transpose(s.f) - inverted * transpose(inverted)), 1e-24);
      const double scale = v["density"] * r.sound_speed * r.sound_speed;
      EXPECT_NEAR(r.energy + r.dissipation.plastic, before, 1e-11 * scale);
      EXPECT_GE(r.dissipation.plastic, 0) << "nothing is gained";
    }
  });
}

/// One particle on a spring of inertia: what its own stress makes of its strain.
TEST(Crushed, ItSpringsBackByItself) {
  for_all_solids([]<class M>(const Values& v, const auto& law, double k) {
    typename M::template State<double> s{Mat3d::diagonal(0.02, 0.02, 0.02)};
    // d2(ln s)/dt2 = -tau/I, with a damping that stops it.
    const double dt = 0.01;
    double rate = 0, pressure = -law.respond(s).tau.xx;
    for (int i = 0; i < 20000; ++i) {
      rate = (rate + pressure / k * dt) * (1 - 2 * dt);
      pressure = -law.advance(s, local<double>(Mat3d::diagonal(rate * dt, rate * dt, rate * dt))).tau.xx;
    }
    EXPECT_NEAR(determinant(s.f), 1, 1e-3);
    (void)v;
  });
}

}  // namespace
}  // namespace dreampm

// How fast matter carries an impact: the jumps of mass and momentum across a front (Rankine 1870,
// Hugoniot 1887). With J behind a front of speed U that stops matter of speed v: J = 1 - v/U, rho0
// U v = stress at that J.
#include <gtest/gtest.h>

#include <cmath>

#include "states.h"

namespace dreampm {
namespace {
using namespace test;

/// The tolerance of a search of 12 halvings.
constexpr double searched = 2e-4;

TEST(Impact, SolidsLinearInUniaxialStrainCarryItWithTheirSound) {
  // Fixed corotated and the stable neo-Hookean law alike have P_xx = (lambda + 2 mu) (F_xx - 1)
  // there, whatever nu: so U = c, and to matter that arrives the front comes at v + c.
  for (const std::string_view name : {"elastic", "neo_hookean"})
    for (const double nu : {0.0, 0.3, 0.49}) {
      SCOPED_TRACE(std::string(name) + ", nu " + std::to_string(nu));
      Values given;
      given.set("poissons_ratio", nu);
      const Values v = complete(*find_material(name), given);
      const Lame lame = Lame::of(v["youngs_modulus"], nu);
      const double c = std::sqrt((lame.lambda + 2 * lame.mu) / v["density"]);
      EXPECT_EQ(shock_wave_speed(name, v, 0.299 * c), 0);
      for (double mach = 0.301; mach < 0.75; mach *= 1.03)
        EXPECT_NEAR(shock_wave_speed(name, v, mach * c), (1 + mach) * c, searched * c) << mach;
    }
}

TEST(Impact, LiquidsCarryItAsColesEquationTells) {
  for (const double gamma : {-1.0, 1.0, 4.5, 7.0}) {
    SCOPED_TRACE(gamma);
    Values given;
    given.set("bulk_modulus", 2.5e5);
    given.set("gamma", gamma);
    const Values v = complete(Newtonian::info, given);
    const double c = std::sqrt(2.5e5 / v["density"]);
    const auto pressure = [&](double j) { return 2.5e5 / gamma * (std::pow(j, -gamma) - 1); };
    EXPECT_EQ(shock_wave_speed("newtonian", v, 0.299 * c), 0);
    int asked = 0;
    // J from the front's speed, and the speed of the impact from J: no equation is left to solve.
    // The law keeps J above 0.4. Waves behind the front, c J^((1 - gamma)/2), are slower than the
    // front is to matter that arrives.
    for (double j = 0.95; j > 0.405; j -= 0.005) {
      const double speed = std::sqrt((1 - j) * pressure(j) / v["density"]), front = speed + speed / (1 - j);
      if (speed < 0.301 * c) continue;
      EXPECT_NEAR(shock_wave_speed("newtonian", v, speed), front, searched * front) << j;
      ++asked;
    }
    EXPECT_GT(asked, 50);
  }
}

TEST(Impact, HarderOnesAreFasterInEveryMaterial) {
  Materials::for_each([]<class M>() {
    SCOPED_TRACE(M::info.name);
    Rng rng(16);
    int asked = 0, failures = 0;
    for (int trial = 0; trial < 1000 && failures < 5; ++trial) {
      Values given;
      for (const Param& p : M::info.params)
        if (trial % 2 || rng() % 3 == 0) given.set(p.key, pick(p, rng));
      const Values v = within_range(M::info, given);
      const double c = facts_of(M::info, v).sound_speed;
      double before = 0;
      for (double speed = 0; speed <= 100; speed = std::max(1e-3, speed * 1.25)) {
        const double shock = shock_wave_speed(M::info.name, v, speed);
        // 0 only where it is far below sound; else no slower than sound at rest, which it is in
        // what yields, nor than a front that matter is pressed to nothing behind.
        const double least = speed < 0.3 * c ? 0 : std::max(2 * speed, c);
        const bool fine = std::isfinite(shock) && shock >= least * (1 - 1e-12) && (shock > 0) == (least > 0) &&
                          shock >= before * (1 - searched);
        if (!fine) ADD_FAILURE() << shock << " after " << before << " at " << speed << " with " << text_of(v);
        failures += !fine, asked += shock > 0;
        before = shock;
      }
    }
    EXPECT_GT(asked, 1000);
  });
}

}  // namespace
}  // namespace dreampm

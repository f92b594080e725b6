// Case 2 of the validation set: a still column and standing waves in a bar, both with exact
// solutions.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "liquids.h"
#include "validate/measure/column.h"
#include "validate/measure/fit.h"

namespace dreampm::exact_test {
namespace {
using namespace test;

/// Returns the errors of a still column after `settle` seconds of damping, over `watch` seconds.
validate::RowErrors column_errors(std::initializer_list<std::pair<std::string_view, double>> law, double settle,
                                  double watch) {
  const double dx = 0.02, spacing = dx / 2, g = 9.81, height = 0.4;
  World<float> w = empty_world<float>(dx, {6, 30, 4}, WallType::slip);
  w.walls[3] = {WallType::separate, 0};
  w.gravity = {0, -g, 0};
  Values values = values_of("newtonian", law);
  values.set("bulk_modulus", 1000 * 100 * 2 * g * height);  // c = 10 sqrt(2 g H)
  add_set(w, "newtonian", values, spacing);
  const Hydrostatic rest(values, g, height);
  const auto backend = make_cpu_backend();
  w.settings.fps = 100;
  const auto seeds = rest.fill({6 * dx, height, 4 * dx}, spacing);
  begin(w, *backend, {seeds});
  rest.press(w, seeds);
  return validate::column_errors(w, rest, height, settle, watch, [&] { step<float>(w, *backend, nullptr); });
}

// Every row counts, the one at the floor too: walls mirror the matter before them.
double worst_row(const validate::RowErrors& rows) {
  std::printf("still column: row means within %.2f %% of rho g H; the base row %+.2f %%\n",
              100 * rows.worst_above_the_base(), 100 * rows.base());
  return std::max(rows.worst_above_the_base(), std::abs(rows.base()));
}

TEST(Exact, StillColumnOfTheDefaultLiquid) { EXPECT_LE(worst_row(column_errors({}, 0.3, 0.6)), 0.04); }

TEST(Exact, StillColumnOfABareEquationOfState) {
  EXPECT_LE(worst_row(column_errors({{"gamma", -1}, {"tension", 1}, {"relaxation", 0}}, 0.6, 0.2)), 0.01);
}

struct Wave {
  double period = 0, amplitude = 0;  ///< relative to the exact ones
};

/// The grid's own dispersion makes the period longer by 0.108 (k dx)^2 = 0.10 % here; mirrored
/// walls add nothing.
constexpr int bar_cells = 32;

/// u = A sin(pi X/L) cos(pi c t/L) d in a bar between two walls, without an end across: started at
/// its middle, by its velocity. Returns the measured motion by its projection on the mode.
template <class R>
Wave bar_wave(Backend<R>& backend, std::string_view material, const Values& values, double c, int cells,
              const Vec3d& direction, WallType walls) {
  const double dx = 1.0 / cells, length_of_bar = 1, spacing = dx / 2, side = 4 * dx, a = 0.005;
  World<R> w = empty_world<R>(dx, {cells, 4, 4}, WallType::open);
  w.walls[0].type = w.walls[1].type = walls;
  w.periodic = {false, true, true};
  add_set(w, material, values, spacing);
  const double k = std::numbers::pi / length_of_bar, omega = k * c;
  const Field field = [&](const Vec3d& p) { return direction * (a * omega * std::sin(k * p.x)); };
  const std::vector<std::vector<ParticleSeed>> seeds{lattice({{}, {length_of_bar, side, side}}, spacing, field)};
  const double period = 2 * std::numbers::pi / omega;
  w.settings.fps = 1 / (3 * period);
  w.settings.cfl = 0.2;
  begin(w, backend, seeds);
  // q(t) = A sin(omega t)
  const Field mode = [&](const Vec3d& p) { return direction * std::sin(k * p.x); };
  validate::Swing swing;
  while (w.frame == 1) {
    step<R>(w, backend, nullptr);
    swing.add(w.time, validate::mode_amplitude(w, seeds[0], mode));
  }
  const Wave r{swing.period() / period, swing.extreme(3) / a};
  std::printf("bar of %s, %d cells: period %.5f, amplitude after two periods %.5f of the exact ones\n",
              std::string(material).c_str(), cells, r.period, r.amplitude);
  return r;
}

TEST(Exact, BarWaveOfAnElasticSolid) {
  // Uniaxial strain of the fixed corotated energy is linear: c^2 = (lambda + 2 mu)/rho0 at any
  // amplitude.
  const Values v = values_of("elastic", {{"youngs_modulus", 1e5}, {"poissons_ratio", 0.3}, {"density", 1000}});
  const Lame lame = Lame::of(1e5, 0.3);
  const Wave r = bar_wave(*make_cpu_backend(), "elastic", v, std::sqrt((lame.lambda + 2 * lame.mu) / 1000), bar_cells,
                          {1, 0, 0}, WallType::slip);
  EXPECT_NEAR(r.period, 1, 0.002);
  EXPECT_NEAR(r.amplitude, 1, 0.01);
}

// Along the walls and against them: a wall where matter sticks holds it at the wall itself, not
// half a cell before it.
TEST(Exact, ShearWaveBetweenWallsThatStick) {
  const Values v = values_of("elastic", {{"youngs_modulus", 1e5}, {"poissons_ratio", 0.3}, {"density", 1000}});
  const double c = std::sqrt(Lame::of(1e5, 0.3).mu / 1000);
  const Wave r = bar_wave(*make_cpu_backend(), "elastic", v, c, bar_cells, {0, 1, 0}, WallType::stick);
  EXPECT_NEAR(r.period, 1, 0.002);
  EXPECT_NEAR(r.amplitude, 1, 0.02);
}

TEST(Exact, BarWaveOfALinearLiquid) {
  const Values v = values_of("newtonian", {{"bulk_modulus", 1e5}, {"gamma", -1}, {"tension", 1}, {"relaxation", 0}});
  const Wave r = bar_wave(*make_cpu_backend(), "newtonian", v, 10, bar_cells, {1, 0, 0}, WallType::slip);
  EXPECT_NEAR(r.period, 1, 0.002);
  EXPECT_NEAR(r.amplitude, 1, 0.01);
}

}  // namespace
}  // namespace dreampm::exact_test

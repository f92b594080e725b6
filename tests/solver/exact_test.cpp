// Case 2 of the validation set: a still column and standing waves in a bar, both with exact solutions.
#include <gtest/gtest.h>

#include <numbers>

#include "liquids.h"

namespace dreampm {
namespace {
using namespace test;

/// Mean pressures of the rows of cells of a still column after `settle` seconds of damping, over `watch` seconds,
/// against the exact ones at the particles' own heights; relative to rho g H, from the floor up.
std::vector<double> column_errors(std::initializer_list<std::pair<std::string_view, double>> law, double settle,
                                  double watch) {
  const double dx = 0.02, spacing = dx / 2, g = 9.81, height = 0.4;
  World<float> w = empty_world<float>(dx, {6, 30, 4}, WallType::slip);
  w.walls[3] = {WallType::separate, 0};
  w.gravity = {0, -g, 0};
  Values values = values_of("newtonian", law);
  values.set("bulk_modulus", 1000 * 100 * 2 * g * height);  // c = 10 sqrt(2 g H)
  add_set(w, "newtonian", values, spacing);
  const Hydrostatic rest(values, g, height);
  const auto newborns = rest.fill({6 * dx, height, 4 * dx}, spacing);
  const auto backend = make_cpu_backend();
  w.settings.fps = 100;
  w.settings.damping = 20;
  begin(w, *backend, {newborns});
  rest.press(w, newborns);
  while (w.time < settle) step<float>(w, *backend, nullptr);
  w.settings.damping = 0;
  const auto rows = static_cast<std::size_t>(std::lround(height / dx));
  std::vector<double> error(rows, 0), n(rows, 0);
  while (w.time < settle + watch) {
    step<float>(w, *backend, nullptr);
    if (w.step % 20) continue;
    const auto& set = w.sets[0];
    for (std::size_t b = 0; b < w.particle_blocks.size(); ++b)
      for (std::size_t p = set.block_start[b]; p < set.block_start[b + 1]; ++p) {
        const double y = w.position(w.particle_blocks[b], Vec3f{set.u[0][p], set.u[1][p], set.u[2][p]}).y;
        const std::size_t row = std::min(static_cast<std::size_t>(y / dx), rows - 1);
        error[row] += rest.pressure(static_cast<double>(set.state[0][p])) - rest.pressure_at(y);
        n[row] += 1;
      }
  }
  for (std::size_t r = 0; r < rows; ++r) error[r] /= n[r] * rest.pressure_at(0);
  return error;
}

// The first row over a wall carries a tenth too much, whatever the law: node 1 is pressed from below by particles at
// 1/4 and 3/4 of a cell (0.383 of a cell's pressure), from above by three rows (0.422), as their images in the wall do
// not exist. It is printed and not compared.
double worst_above_the_base(const std::vector<double>& error) {
  double worst = 0;
  for (std::size_t r = 1; r < error.size(); ++r) worst = std::max(worst, std::abs(error[r]));
  std::printf("still column: row means within %.2f %% of rho g H; the base row %+.2f %%\n", 100 * worst,
              100 * error[0]);
  return worst;
}

TEST(Exact, StillColumnOfTheDefaultLiquid) { EXPECT_LE(worst_above_the_base(column_errors({}, 0.3, 0.6)), 0.04); }

TEST(Exact, StillColumnOfABareEquationOfState) {
  EXPECT_LE(worst_above_the_base(column_errors({{"gamma", -1}, {"tension", 1}, {"relaxation", 0}}, 0.6, 0.2)), 0.01);
}

struct Wave {
  double period = 0, amplitude = 0;  ///< relative to the exact ones
};

/// Walls cost the strain of the row of particles beside them a sixth (the nodes behind stand still): the period is too
/// long by 0.4 cells of the bar's length, 1.2 % at 32 cells.
constexpr int bar_cells = 64;

/// u = A sin(pi X/L) cos(pi c t/L) in a bar between slip walls: started at its middle, by its velocity. Returns the
/// measured motion by its projection on the mode.
template <class R>
Wave bar_wave(Backend<R>& backend, std::string_view material, const Values& values, double c, int cells) {
  const double dx = 1.0 / cells, length_of_bar = 1, spacing = dx / 2, side = 2 * dx, a = 0.01;
  World<R> w = empty_world<R>(dx, {cells, 2, 2}, WallType::slip);
  add_set(w, material, values, spacing);
  const double k = std::numbers::pi / length_of_bar, omega = k * c;
  const Field field = [&](const Vec3d& p) { return Vec3d{a * omega * std::sin(k * p.x), 0, 0}; };
  const std::vector<std::vector<Newborn>> newborns{lattice({{}, {length_of_bar, side, side}}, spacing, field)};
  const double period = 2 * std::numbers::pi / omega;
  w.settings.fps = 1 / (3 * period);
  w.settings.cfl = 0.2;
  begin(w, backend, newborns);
  // q(t) = A sin(omega t): its zeros give the period, its extremes the amplitude.
  double before = 0, t_before = 0, highest = 0;
  std::vector<double> zeros{0};
  while (w.frame == 1) {
    step<R>(w, backend, nullptr);
    const auto x = positions_by_id(w);
    double q = 0;
    for (const Newborn& n : newborns[0]) q += (x[n.id].x - n.position.x) * std::sin(k * n.position.x);
    q *= 2.0 / static_cast<double>(newborns[0].size());
    if (before != 0 && (q > 0) != (before > 0)) zeros.push_back(t_before + (w.time - t_before) * before / (before - q));
    if (zeros.size() > 4) highest = std::max(highest, std::abs(q));
    before = q, t_before = w.time;
  }
  const double halves = static_cast<double>(zeros.size() - 1);
  Wave r{(zeros.back() - zeros.front()) / halves * 2 / period, highest / a};
  std::printf(
      "bar of %s, %d cells: period %.5f, amplitude after two periods %.5f of the exact ones (%.0f half periods)\n",
      std::string(material).c_str(), cells, r.period, r.amplitude, halves);
  return r;
}

TEST(Exact, BarWaveOfAnElasticSolid) {
  // Uniaxial strain of the fixed corotated energy is linear: c^2 = (lambda + 2 mu)/rho0 at any amplitude.
  const Values v = values_of("elastic", {{"youngs_modulus", 1e5}, {"poissons_ratio", 0.3}, {"density", 1000}});
  const Lame lame = Lame::of(1e5, 0.3);
  const Wave r = bar_wave(*make_cpu_backend(), "elastic", v, std::sqrt((lame.lambda + 2 * lame.mu) / 1000), bar_cells);
  EXPECT_NEAR(r.period, 1, 0.01);
  EXPECT_NEAR(r.amplitude, 1, 0.01);
}

TEST(Exact, BarWaveOfALinearLiquid) {
  const Values v = values_of("newtonian", {{"bulk_modulus", 1e5}, {"gamma", -1}, {"tension", 1}, {"relaxation", 0}});
  const Wave r = bar_wave(*make_cpu_backend(), "newtonian", v, 10, bar_cells);
  EXPECT_NEAR(r.period, 1, 0.01);
  EXPECT_NEAR(r.amplitude, 1, 0.01);
}

}  // namespace
}  // namespace dreampm

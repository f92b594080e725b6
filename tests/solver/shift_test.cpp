// Liquids that are shifted: waves of density two cells long fade, and the sums know of what was
// moved.
#include <gtest/gtest.h>

#include <numbers>

#include "dreampm/physics/particle.h"
#include "dreampm/physics/shift.h"
#include "dreampm/state/volume_relaxation.h"
#include "worlds.h"

namespace dreampm::shift_test {
namespace {
using namespace test;

constexpr double dx = 0.02, spacing = dx / 2, sound = 10, density = 1000;

Values water(double relaxation) {
  return values_of("newtonian", {{"bulk_modulus", density * sound * sound}, {"relaxation", relaxation}});
}

/// The part of the wave cos(pi x/dx) in a full box that starts with one whose nodes hold 1 +-
/// `amplitude`, after `time` [s] over that at the start, far from the walls along z. The liquid is
/// sheared along y, which is periodic, so that ||D|| is `strain_rate` [1/s].
double wave_left(double amplitude, double relaxation, double strain_rate, double time) {
  const Vec3i cells{8, 8, 48};
  World<float> w = empty_world<float>(dx, cells, WallType::slip);
  w.periodic = {false, true, false};
  w.walls[2] = w.walls[3] = {WallType::open, 0};
  add_set(w, "newtonian", water(relaxation), spacing);
  const double rate = strain_rate * std::numbers::sqrt2;
  std::vector<ParticleSeed> seeds = lattice({{}, static_cast<Vec3d>(cells) * dx}, spacing,
                                            [&](const Vec3d& x) { return Vec3d{0, rate * (x.z - 24 * dx), 0}; });
  const auto part = [](double x) { return std::cos(std::numbers::pi * x / dx); };
  double start = 0, now = 0;
  const auto inside = [&](const ParticleSeed& n) { return std::abs(n.position.z / dx - 24) < 4; };
  for (ParticleSeed& n : seeds) {
    n.position.x -= amplitude * std::numbers::sqrt2 * dx * std::sin(std::numbers::pi * n.position.x / dx);
    if (inside(n)) start += part(n.position.x);
  }
  const auto backend = make_cpu_backend();
  begin(w, *backend, {seeds});
  while (w.time < time) step<float>(w, *backend, nullptr);
  const auto x = positions_by_id(w);
  for (const ParticleSeed& n : seeds)
    if (inside(n)) now += part(x[n.id].x);
  return now / start;
}

// Particles at 1/4 - d of crests and 1/4 + d of troughs: nodes hold 1 +- d exactly, and their
// second differences are 4 d. In a strain of 1 half of what d has beyond a quarter of the noise
// goes.
TEST(Shift, AWaveOfTwoCellsFadesByStrainToWhatIsNoise) {
  constexpr double d = 0.12;
  const double left = wave_left(d, 1, 4, 0.25), unshifted = wave_left(d, 0, 4, 0.25);
  std::printf("a wave of two cells after a strain of 1: %.3f, not shifted %.3f\n", left, unshifted);
  EXPECT_GT(unshifted, 0.9);
  const double noise = VolumeCorrection::shift_noise / 4, then = noise + (d - noise) * std::exp(-0.5);
  const auto part = [](double of) { return std::sin(std::numbers::pi * of); };
  EXPECT_NEAR(left / unshifted, part(then) / part(d), 0.02);
}

TEST(Shift, NoiseStays) { EXPECT_NEAR(wave_left(0.04, 1, 4, 0.25), wave_left(0.04, 0, 4, 0.25), 0.01); }

TEST(Shift, AtRestItStays) { EXPECT_GT(wave_left(0.12, 1, 0, 1), 0.9); }

// A sheared block of liquid with one sheet too many, on one side of a plane of nodes: it is shifted
// away from there.
TEST(Shift, TheSumsKnowOfIt) {
  World<double> w = empty_world<double>(dx, {32, 32, 32}, WallType::open);
  add_set(w, "newtonian", water(1), spacing);
  const auto moving = [](const Vec3d& x) { return Vec3d{0.3, 20 * (x.z - 16 * dx), 0.1}; };
  const Vec3d low{12 * dx, 12 * dx, 12 * dx}, high{20 * dx, 20 * dx, 20 * dx};
  std::vector<ParticleSeed> seeds = lattice({low, high}, spacing, moving);
  const auto sheet = lattice({{16.25 * dx, low.y, low.z}, {16.75 * dx, high.y, high.z}}, spacing, moving,
                             static_cast<std::uint32_t>(seeds.size()));
  for (ParticleSeed n : sheet) n.position.x -= 0.2 * dx, seeds.push_back(n);
  const auto backend = make_reference_backend<double>();
  begin(w, *backend, {seeds});
  const double mass = w.sets[0].mass * static_cast<double>(w.particles());
  Balance before = balance(w, initial_velocities(w, {seeds}));
  Vec3d place = validate::mean_position(w) * mass, shifted{};
  for (int i = 0; i < 20; ++i) {
    Motion<double> motion;
    const bool may = volume_relaxation_time(w, w.dt_next) > 0;
    const StepSums r = step(w, *backend, &motion, 0);
    const Balance now = balance(w, motion);
    const Vec3d new_place = validate::mean_position(w) * mass;
    EXPECT_LT(length(now.momentum - before.momentum), 1e-12 * length(before.momentum));
    EXPECT_LT(length(now.angular - before.angular - r.body.angular), 1e-12 * length(before.angular));
    EXPECT_LT(length(new_place - place - now.momentum * r.dt - r.pass.shifted), 1e-12 * length(place));
    EXPECT_TRUE(may || length(r.pass.shifted) == 0);
    shifted += r.pass.shifted;
    before = now, place = new_place;
  }
  std::printf("shifted by %.2e cells in the mean\n", shifted.x / mass / dx);
  EXPECT_GT(shifted.x, 1e-6 * mass * dx);
}

}  // namespace
}  // namespace dreampm::shift_test

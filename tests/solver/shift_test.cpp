// Liquids that are shifted: waves of density two cells long fade, and the sums know of what was moved.
#include <gtest/gtest.h>

#include <numbers>

#include "dreampm/physics/particle.h"
#include "dreampm/state/anchoring.h"
#include "worlds.h"

namespace dreampm {
namespace {
using namespace test;

constexpr double dx = 0.02, spacing = dx / 2, sound = 10, density = 1000;

Values water(double relaxation) {
  return values_of("newtonian", {{"bulk_modulus", density * sound * sound}, {"relaxation", relaxation}});
}

/// The part of the wave cos(pi x/dx) in a full box that starts with one, after `times` anchoring times over that at the
/// start.
double wave_left(double relaxation, double times) {
  const Vec3i cells{8, 8, 8};
  World<float> w = empty_world<float>(dx, cells, WallType::slip);
  add_set(w, "newtonian", water(relaxation), spacing);
  std::vector<Newborn> newborns = lattice({{}, static_cast<Vec3d>(cells) * dx}, spacing, still());
  const auto part = [](double x) { return std::cos(std::numbers::pi * x / dx); };
  double start = 0;
  for (Newborn& n : newborns) {
    n.position.x -= 0.03 * dx * std::sin(std::numbers::pi * n.position.x / dx);
    start += part(n.position.x);
  }
  const auto backend = make_cpu_backend();
  begin(w, *backend, {newborns});
  while (w.time < times * anchoring_cells * dx / sound) step<float>(w, *backend, nullptr);
  double now = 0;
  for (const Vec3d& x : positions_by_id(w)) now += part(x.x);
  return now / start;
}

// Particles at 1/4 - d of crests and 1/4 + d of troughs: nodes hold 1 +- d, and half of d goes in an anchoring time.
TEST(Shift, AWaveOfTwoCellsFades) {
  const double left = wave_left(1, 1);
  std::printf("a wave of two cells after an anchoring time: %.3f\n", left);
  EXPECT_NEAR(left, std::exp(-0.5), 0.02);
}

TEST(Shift, WithoutAnchoringItStays) { EXPECT_GT(wave_left(0, 3), 0.9); }

// A moving block of liquid with one sheet too many, on one side of a plane of nodes: it is shifted away from there.
TEST(Shift, TheSumsKnowOfIt) {
  World<double> w = empty_world<double>(dx, {32, 32, 32}, WallType::open);
  add_set(w, "newtonian", water(1), spacing);
  const Vec3d velocity{0.3, -0.2, 0.1};
  const auto moving = [&](const Vec3d&) { return velocity; };
  const Vec3d low{12 * dx, 12 * dx, 12 * dx}, high{20 * dx, 20 * dx, 20 * dx};
  std::vector<Newborn> newborns = lattice({low, high}, spacing, moving);
  const auto sheet = lattice({{16.25 * dx, low.y, low.z}, {16.75 * dx, high.y, high.z}}, spacing, moving,
                             static_cast<std::uint32_t>(newborns.size()));
  for (Newborn n : sheet) n.position.x -= 0.2 * dx, newborns.push_back(n);
  const auto backend = make_reference_backend<double>();
  begin(w, *backend, {newborns});
  const double mass = w.sets[0].mass * static_cast<double>(w.particles());
  Balance before = balance(w, motion_at_birth(w, {newborns}));
  Vec3d place = validate::mean_position(w) * mass, shifted{};
  for (int i = 0; i < 20; ++i) {
    Motion<double> motion;
    const bool may = shifts(w, w.dt_next);
    const StepReport r = step(w, *backend, &motion, 0);
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
}  // namespace dreampm

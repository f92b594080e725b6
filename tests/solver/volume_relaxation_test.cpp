// When liquids are relaxed, and that it leaves surfaces their pressure.
#include "dreampm/state/volume_relaxation.h"

#include <gtest/gtest.h>

#include "liquids.h"

namespace dreampm::volume_relaxation_test {
namespace {
using namespace test;

constexpr double dx = 0.02, spacing = dx / 2, sound = 10;

World<float> liquid_world(double relaxation) {
  World<float> w = empty_world<float>(dx, {8, 8, 8});
  add_set(w, "newtonian", values_of("newtonian", {{"bulk_modulus", 1e3 * sound * sound}, {"relaxation", relaxation}}),
          spacing);
  return w;
}

// Whatever the steps: each volume relaxation stands for the time since the last.
TEST(VolumeRelaxation, ItsTimesAddUpToWhatHasPassed) {
  for (const double relaxation : {0.3, 1.0, 10.0}) {
    World<float> w = liquid_world(relaxation);
    const double period = VolumeCorrection::relaxation_stride * dx / (std::max(relaxation, 1.0) * sound);
    double relaxed = 0;
    int steps = 0, volume_relaxation = 0;
    for (double dt = 0.1 * period; w.time < 50 * period;
         w.time += dt, dt = dt < 2.5 * period ? 1.3 * dt : 0.07 * period) {
      const double t = volume_relaxation_time(w, dt);
      relaxed += t, ++steps, volume_relaxation += t > 0;
      EXPECT_NEAR(relaxed, w.time + dt, period);
    }
    EXPECT_LT(volume_relaxation, steps);
  }
}

// A liquid that is drawn slowly is drawn as often, by less: what one volume relaxation stores grows
// as its square.
TEST(VolumeRelaxation, ASlowerPaceDoesNotMakeItCoarser) {
  const auto longest = [](double relaxation) {
    World<float> w = liquid_world(relaxation);
    double most = 0;
    for (const double dt = 0.3 * dx / sound; w.time < 100 * dx / sound; w.time += dt)
      most = std::max(most, volume_relaxation_time(w, dt));
    return most;
  };
  EXPECT_EQ(longest(0.01), longest(1));
  EXPECT_LT(longest(10), longest(1));
}

TEST(VolumeRelaxation, NothingIsRelaxedWithoutALiquidThatAsksForIt) {
  EXPECT_EQ(volume_relaxation_time(liquid_world(0), 1.0), 0);
  World<float> solid = empty_world<float>(dx, {8, 8, 8});
  add_set(solid, "elastic", values_of("elastic", {}), spacing);
  EXPECT_EQ(volume_relaxation_time(solid, 1.0), 0);
}

/// A column at rest, second 1 to 1.5: the mean pressure of its uppermost cell of particles, over
/// what it should be.
double pressing(double relaxation) {
  constexpr double g = 9.81, height = 8 * dx;
  World<float> w = empty_world<float>(dx, {4, 16, 4}, WallType::slip);
  w.gravity = {0, -g, 0};
  const Values v = values_of("newtonian", {{"bulk_modulus", 1000 * 100 * 2 * g * height}, {"relaxation", relaxation}});
  const Hydrostatic rest(v, g, height);
  add_set(w, "newtonian", v, spacing);
  const std::vector<ParticleSeed> column = rest.fill({4 * dx, height, 4 * dx}, spacing);
  const auto backend = make_cpu_backend();
  begin(w, *backend, {column});
  rest.press(w, column);
  double sum = 0;
  std::size_t n = 0;
  while (w.time < 1.5) {
    step<float>(w, *backend, nullptr);
    if (w.time < 1) continue;
    const auto& set = w.sets[0];
    for (std::size_t p = 0; p < set.size(); ++p)
      if (column[set.id[p]].position.y > height - dx)
        sum -= v["bulk_modulus"] * static_cast<double>(set.state[0][p]), ++n;
  }
  return sum / static_cast<double>(n) / (1000 * g * dx / 2);
}

TEST(VolumeRelaxation, RowsAtASurfacePressHoweverOften) {
  const double now = pressing(1), always = pressing(10);
  std::printf("the uppermost cell presses with %.3f of its weight; relaxed in every step, and more: %.3f\n", now,
              always);
  for (const double pressed : {now, always}) EXPECT_NEAR(pressed, 1, 0.25);
}

}  // namespace
}  // namespace dreampm::volume_relaxation_test

// Light bodies in water come up, and steps of any length take as long for it.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "scenes.h"

namespace dreampm {
namespace {
using namespace test;

constexpr double level = 0.14, half = 0.02;

/// m: how high a cork that is let go below still water stands after `time` [s], its center.
double height_of_cork(double time, const std::string& transfer, double longest_step) {
  Simulation s(parse_scene(fmt::format(R"(dreampm: 1
name: cork
space: {{max: [0.24, 0.24, 0.24], spacing: 0.01}}
time: {{fps: 24, dt_max: {}}}
materials: {{water: {{type: newtonian, preset: water, {}}}}}
bodies: {{pool: {{material: water, shape: {{difference: [{{box: {{min: [0, 0, 0], max: [0.24, 0.14, 0.24]}}}}, {{cylinder: {{radius: 0.03, height: 0.04}}, center: [0.12, 0.07, 0.12]}}]}}}}}}
rigid: {{cork: {{shape: {{cylinder: {{radius: 0.03, height: 0.04}}}}, density: 240, position: [0.12, 0.07, 0.12]}}}}
)",
                                       longest_step, transfer),
                           "cork.yaml"),
               quiet());
  s.advance_to(time);
  return s.collider("cork").twist.center.y;
}

TEST(Rise, ACorkIsUpWithinSixTenthsOfASecondAtAnyStep) {
  const double own = height_of_cork(0.6, "transfer: asflip", 1), fine = height_of_cork(0.6, "transfer: asflip", 2e-4);
  const double syrup = height_of_cork(0.6, "transfer: apic", 1);
  std::printf("from 0.07 m up to %.4f m; with short steps %.4f, by apic %.4f\n", own, fine, syrup);
  // Half of it stands out of the water.
  EXPECT_GT(own, level - half / 2);
  EXPECT_GT(fine, level - half / 2);
  EXPECT_NEAR(own, fine, 0.01);
  EXPECT_LT(syrup, level - half);
}

}  // namespace
}  // namespace dreampm

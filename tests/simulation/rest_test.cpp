// Fallen matter lies on the surface that it fell on: half a spacing is the room of particles of
// their volume.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "scenes.h"

namespace dreampm {
namespace {
using namespace test;

constexpr double spacing = 0.02;

/// The height of the lowest row over the ground [spacings], of a cube that fell by 0.1 m as a scene
/// has it, without damping. `top`: of a collider [m]; 0: the floor.
double gap(const std::string& material, double top) {
  const std::string collider =
      fmt::format("colliders: {{table: {{shape: {{box: {{min: [-1, -1, -1], max: [2, {}, 2]}}}}}}}}\n", top);
  Simulation s(
      parse_scene(fmt::format("dreampm: 1\nname: rest\nspace: {{max: [0.4, 0.4, 0.4], spacing: {}}}\n"
                              "time: {{fps: 24, frames: 60}}\nmaterials: {{matter: {}}}\n"
                              "bodies: {{cube: {{material: matter, shape: {{box: {{min: [0.14, {}, 0.14], max: "
                              "[0.26, {}, 0.26]}}}}, sample: {{pattern: lattice}}}}}}\n{}",
                              spacing, material, top + 0.1, top + 0.22, top > 0 ? collider : ""),
                  "rest.yaml"),
      quiet());
  s.advance_to(2.5);
  const ParticleView view = s.particles("matter");
  std::vector<double> heights;
  for (const Vec3f& p : view.position) heights.push_back((p.y - top) / spacing);
  std::sort(heights.begin(), heights.end());
  double mean = 0;
  constexpr int row = 36;
  for (int i = 0; i < row; ++i) mean += heights[static_cast<std::size_t>(i)] / row;
  return mean;
}

// On a wall and on a collider of type separate, also one that cuts through cells.
TEST(Rest, WhatFellLiesHalfASpacingAboveTheGround) {
  for (const char* material : {"{type: elastic, preset: jelly}", "{type: snow, preset: packed}"})
    for (const double top : {0.0, 0.08, 0.093}) {
      const double at = gap(material, top);
      std::printf("%s on %g m: %.2f spacings\n", material, top, at);
      EXPECT_GE(at, 0.25) << material << ", " << top;
      EXPECT_LE(at, 0.75) << material << ", " << top;
    }
}

}  // namespace
}  // namespace dreampm

// A material that is not part of DreaMPM: the damped rubber of docs/howto/add-a-material.md, which
// the build joins to the list of materials (-DDM_EXTRA_MATERIALS). Two cubes fall; the one with the
// stronger dashpot bounces less.
//   custom_material [cpu|reference]
#include <dreampm/simulation.h>

#include <algorithm>
#include <cstdio>

constexpr const char* scene = R"(
dreampm: 1
name: cubes
space: {min: [0, 0, 0], max: [0.4, 0.4, 0.2], spacing: 0.02}
materials:
  springy: {type: kelvin_voigt, mu: 2.0e4, lambda: 4.0e4, viscosity: 1}
  damped: {type: kelvin_voigt, mu: 2.0e4, lambda: 4.0e4, viscosity: 100}
bodies:
  left: {material: springy, shape: {box: {min: [0.04, 0.12, 0.06], max: [0.12, 0.2, 0.14]}}}
  right: {material: damped, shape: {box: {min: [0.28, 0.12, 0.06], max: [0.36, 0.2, 0.14]}}}
)";

float lowest(const dreampm::Simulation& simulation, const char* material) {
  float y = 1e30f;
  for (const dreampm::Vec3f& p : simulation.particles(material).position) y = std::min(y, p.y);
  return y;
}

int main(int count, char** words) try {
  dreampm::Simulation simulation(dreampm::parse_scene(scene, "cubes"), {.backend = count > 1 ? words[1] : "cpu"});
  simulation.advance_to(0.17);
  float springy = 0, damped = 0;
  for (int i = 0; i < 20; ++i) {
    simulation.advance_to(0.17 + 0.01 * i);
    springy = std::max(springy, lowest(simulation, "springy"));
    damped = std::max(damped, lowest(simulation, "damped"));
  }
  std::printf("after the bounce the lowest particle rises to %.3f m (springy) and %.3f m (damped)\n", springy, damped);
  return springy > damped ? 0 : 1;
} catch (const dreampm::Error& e) {
  std::fprintf(stderr, "%s\n", e.what());
  return e.exit_code();
}

// A drop of water falls into a pool; prints how high the water stands.
#include <dreampm/simulation.h>

#include <algorithm>
#include <cstdio>

constexpr const char* scene = R"(
dreampm: 1
name: drop
space: {min: [0, 0, 0], max: [0.4, 0.4, 0.4], spacing: 0.01}
materials: {water: {type: newtonian, preset: water}}
bodies:
  pool: {material: water, shape: {box: {min: [0, 0, 0], max: [0.4, 0.1, 0.4]}}}
  drop: {material: water, shape: {sphere: {radius: 0.05}, center: [0.2, 0.25, 0.2]}}
)";

int main() try {
  dreampm::Simulation simulation(dreampm::parse_scene(scene, "drop"));
  for (int i = 1; i <= 10; ++i) {
    simulation.advance_to(0.05 * i);
    float top = 0;
    for (const dreampm::Vec3f& p : simulation.particles("water").position) top = std::max(top, p.y);
    std::printf("t = %.2f s: %6llu steps, highest particle at %.3f m\n", simulation.time(),
                static_cast<unsigned long long>(simulation.steps()), top);
  }
} catch (const dreampm::Error& e) {
  std::fprintf(stderr, "%s\n", e.what());
  return e.exit_code();
}

// Goes back in time: a snapshot is taken, two futures are tried, and the first one comes out again
// bit by bit.
#include <dreampm/simulation.h>

#include <cstdio>

constexpr const char* scene = R"(
dreampm: 1
name: snapshot
space: {min: [0, 0, 0], max: [0.4, 0.3, 0.2], spacing: 0.01}
materials: {water: {type: newtonian, preset: water}}
bodies:
  dam: {material: water, shape: {box: {min: [0, 0, 0], max: [0.15, 0.2, 0.2]}}}
)";

int main() try {
  dreampm::Simulation simulation(dreampm::parse_scene(scene, "snapshot"));
  simulation.advance_to(0.2);
  const dreampm::Snapshot then = simulation.snapshot();
  std::printf("snapshot at %.3f s, %.1f MB\n", then.time(), 1e-6 * static_cast<double>(then.bytes()));

  simulation.advance_to(0.4);
  const auto down = simulation.hash();

  simulation.restore(then);
  simulation.set_gravity({0, 9.81, 0});
  simulation.advance_to(0.4);
  const auto up = simulation.hash();

  simulation.restore(then);
  simulation.advance_to(0.4);
  const bool same = simulation.hash() == down;
  std::printf("down %016llx, up %016llx, down again %s\n", static_cast<unsigned long long>(down),
              static_cast<unsigned long long>(up), same ? "the same bits" : "DIFFERENT");
  return same ? 0 : 1;
} catch (const dreampm::Error& e) {
  std::fprintf(stderr, "%s\n", e.what());
  return e.exit_code();
}

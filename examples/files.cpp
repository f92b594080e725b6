// Writes what `dreampm run` writes: a ledger, particles, probes, and moments to go on from.
#include <dreampm/observers.h>
#include <dreampm/simulation.h>

#include <cstdio>
#include <fstream>
#include <string>

constexpr const char* scene = R"(
dreampm: 1
name: files
space: {min: [0, 0, 0], max: [0.4, 0.3, 0.2], spacing: 0.02}
time: {fps: 50}
materials: {water: {type: newtonian, preset: water}}
bodies:
  dam: {material: water, shape: {box: {min: [0, 0, 0], max: [0.12, 0.2, 0.2]}}}
probes:
  level: {type: height, at: [0.3, 0.1]}
)";

int main() try {
  dreampm::Simulation simulation(dreampm::parse_scene(scene, "files"));
  attach(simulation, dreampm::LedgerFile{"written-files/ledger.csv"});
  attach(simulation, dreampm::ParticleFiles{"written-files/particles", {"velocity", "pressure"}});
  attach(simulation, dreampm::ProbeFiles{"written-files/probes"});
  attach(simulation, dreampm::CheckpointFiles{"written-files/checkpoint", 5});
  simulation.advance_frames(12);

  std::ifstream ledger("written-files/ledger.csv");
  int rows = -1;
  for (std::string line; std::getline(ledger, line);) ++rows;
  std::printf("%d rows of the ledger, one a frame\n", rows);

  simulation.load("written-files/checkpoint/checkpoint_000010.yaml");
  std::printf("back at frame %d: the files go on from there\n", simulation.frame());
  simulation.advance_frames(3);
  return rows == 13 ? 0 : 1;
} catch (const dreampm::Error& e) {
  std::fprintf(stderr, "%s\n", e.what());
  return e.exit_code();
}

// Small scenes for tests of simulations that a program holds.
#pragma once
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "dreampm/simulation.h"
#include "thrown.h"

namespace dreampm::test {

/// Lines of the library that a test looks at.
class ListeningHost final : public Host {
 public:
  void info(const std::string& line) override { infos.push_back(line); }
  void warning(const std::string& line) override { warnings.push_back(line); }
  bool stop_requested() override { return stop; }
  std::vector<std::string> infos, warnings;
  bool stop = false;
};

/// A dam of water, with a block of jelly above that keeps velocities where `transfer` says so.
inline Scene dam_and_jelly(const std::string& transfer = "apic") {
  return parse_scene(
      "dreampm: 1\nname: dam\nspace: {min: [0, 0, 0], max: [0.24, 0.2, 0.16], spacing: 0.02}\ntime: {fps: 50}\n"
      "materials:\n  water: {type: newtonian, preset: water}\n"
      "  jelly: {type: neo_hookean, density: 500, youngs_modulus: 2.0e4, poissons_ratio: 0.3, transfer: " +
          transfer +
          "}\n"
          "bodies:\n  dam: {material: water, shape: {box: {min: [0, 0, 0], max: [0.08, 0.12, 0.16]}}, velocity: [0.5, "
          "0, 0]}\n  cube: {material: jelly, shape: {box: {min: [0.12, 0.04, 0.04], max: [0.2, 0.12, 0.12]}}}\n",
      "dam.yaml");
}

/// Neither stderr nor signals.
inline SimulationOptions quiet(int threads = 1, const std::string& backend = "cpu") {
  static SilentHost silent;
  SimulationOptions o;
  o.threads = threads, o.backend = backend, o.host = &silent;
  return o;
}

}  // namespace dreampm::test

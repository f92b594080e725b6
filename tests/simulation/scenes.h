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

/// A ball of jelly that falls and turns.
inline model::Body ball(const std::string& name, const Vec3d& center) {
  return {name, "jelly", Shape::sphere(center, 0.03), {0, -1, 0}, {0, 0, 5}};
}

/// Every kind of edit of dam_and_jelly, at given steps. `each(step)` is called after each of 60
/// steps.
template <class Each>
void script(Simulation& s, const Each& each) {
  for (int step = 1; step <= 60; ++step) {
    s.step();
    if (step == 5) s.set_parameter("water", "viscosity", 2);
    if (step == 10) s.set_gravity({3, -9, 1});
    if (step == 15) s.set_wall(Side::z_max, {WallType::slip});
    if (step == 20) s.set_parameter("jelly", "youngs_modulus", 1e5), s.set_parameter("jelly", "density", 800);
    if (step == 25) s.add(ball("ball", {0.19, 0.16, 0.08}));
    if (step == 30) s.set_brush("hand", {{0.06, 0.04, 0.08}, 0.05, {1, 2, 0}, 300});
    if (step == 35) s.reset_state("jelly");
    if (step == 40)
      s.remove_brush("hand"),
          s.add_material(parse_material("{type: newtonian, preset: honey, bulk_modulus: 2.0e5}", "honey"));
    if (step == 42) s.add({"drop", "honey", Shape::sphere({0.06, 0.17, 0.08}, 0.02)});
    if (step == 44) s.add_particles("water", std::vector<Vec3d>{{0.21, 0.18, 0.08}, {0.21, 0.18, 0.11}}, {0, -2, 0});
    if (step == 45) s.remove(Shape::box({0, 0, 0}, {0.04, 0.2, 0.08}));
    each(step);
  }
}

/// Checks that a run from its start to `end` [s] has the same bits on 1 and 3 threads, and again
/// from a snapshot in the middle. `set_up` changes each simulation before it starts, `after` looks
/// at it in the end.
template <class SetUp, class After>
void expect_same_bits(const Scene& scene, double middle, double end, const SetUp& set_up, const After& after) {
  std::uint64_t half = 0, whole = 0;
  for (const int threads : {1, 3}) {
    Simulation s(scene, quiet(threads));
    set_up(s);
    s.advance_to(middle);
    const Snapshot snapshot = s.snapshot();
    if (threads == 1) half = s.hash();
    EXPECT_EQ(s.hash(), half) << threads;
    s.advance_to(end);
    if (threads == 1) whole = s.hash();
    EXPECT_EQ(s.hash(), whole) << threads;
    s.restore(snapshot);
    EXPECT_EQ(s.hash(), half) << threads;
    s.advance_to(end);
    EXPECT_EQ(s.hash(), whole) << threads;
    after(s);
  }
}
inline void expect_same_bits(const Scene& scene, double middle, double end) {
  expect_same_bits(scene, middle, end, [](Simulation&) {}, [](Simulation&) {});
}

}  // namespace dreampm::test

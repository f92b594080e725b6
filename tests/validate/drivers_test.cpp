// A scene steps the same, whoever drives it: the command, a program, validation.
#include <gtest/gtest.h>

#include <filesystem>

#include "dreampm/base/hash.h"
#include "dreampm/io/run_record.h"
#include "dreampm/pipeline/simulate.h"
#include "dreampm/scene/parse.h"
#include "dreampm/simulation.h"
#include "validate/validation_run.h"

namespace dreampm::validate {
namespace {
namespace fs = std::filesystem;

constexpr const char* dam = R"(dreampm: 1
name: dam
space: {min: [0, 0, 0], max: [0.24, 0.2, 0.16], spacing: 0.02}
time: {fps: 50, frames: 6}
materials: {water: {type: newtonian, preset: water}}
bodies: {dam: {material: water, shape: {box: {min: [0, 0, 0], max: [0.08, 0.12, 0.16]}}}}
rigid: {crate: {shape: {box: {size: [0.05, 0.05, 0.05]}}, position: [0.16, 0.05, 0.08], density: 400}}
probes: {floor: {type: force, on: floor, rate: 400}}
)";

std::string hex(std::uint64_t state) {
  Hash64 hash;
  hash.add(state);
  return hash.hex();
}

TEST(Drivers, OfASceneGiveTheSameBits) {
  const auto parsed = scene::parse_scene_text(dam, "dam.yaml", {});
  ASSERT_TRUE(parsed.ok()) << parsed.text();

  SimulateOptions options;
  options.folder = fs::path(DM_BINARY_DIR) / "test-files" / "drivers";
  fs::remove_all(options.folder);
  simulate(parsed.scene, {"dam.yaml", std::nullopt}, options);
  const std::string run = RunRecord::load(options.folder / "run.json").frames.at(5).state_hash;

  Simulation simulation(parse_scene(dam, "dam.yaml"));
  simulation.advance_frames(5);
  EXPECT_EQ(hex(simulation.hash()), run);

  Trial trial(Options{});
  ValidationRun<float> validation(trial, parsed.scene);
  validation.begin();
  while (validation.world.frame < 6) validation.step();
  EXPECT_EQ(hex(state_hash(validation.world)), run);
}

TEST(Drivers, RefuseAFixedStepThatCannotWork) {
  const auto parsed =
      scene::parse_scene_text(dam, "dam.yaml", {.variant = {}, .overrides = {"time.dt=0.1"}, .assets = {}});
  ASSERT_TRUE(parsed.ok()) << parsed.text();
  Trial trial(Options{});
  ValidationRun<float> validation(trial, parsed.scene);
  EXPECT_THROW(validation.begin(), InputError);
}

}  // namespace
}  // namespace dreampm::validate

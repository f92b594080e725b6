// The volume that liquids take: its column of the ledger, through checkpoints too, and the warning.
#include "dreampm/run/ledger_row.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "dreampm/backend/reference/reference.h"
#include "dreampm/io/run_record.h"
#include "dreampm/pipeline/checkpoint.h"
#include "dreampm/pipeline/simulate.h"
#include "dreampm/scene/parse.h"
#include "dreampm/setup/assemble.h"
#include "dreampm/solver/motion_by_id.h"

namespace dreampm {
namespace {
namespace fs = std::filesystem;
using testing::HasSubstr;

/// 1000 cm^3 of water over 400 cm^3 of sand, in cells of 0.02 m.
constexpr const char* water_on_sand = R"(dreampm: 1
name: swollen
space: {min: [0, 0, 0], max: [0.2, 0.2, 0.1], spacing: 0.01}
time: {fps: 24, frames: 5}
materials:
  water: {type: newtonian, preset: water, max_compression: 0.02}
  sand: {type: sand, preset: dry}
bodies:
  pool: {material: water, shape: {box: {min: [0, 0.02, 0], max: [0.2, 0.07, 0.1]}}}
  bed: {material: sand, shape: {box: {min: [0, 0, 0], max: [0.2, 0.02, 0.1]}}}
)";

/// A world with its matter, before any step.
struct WaterOnSand {
  explicit WaterOnSand(const std::vector<std::string>& overrides = {}) {
    const auto parsed =
        scene::parse_scene_text(water_on_sand, "swollen.yaml", {.variant = {}, .overrides = overrides, .assets = {}});
    if (!parsed.ok()) throw std::runtime_error(parsed.text());
    InitialState all = assemble(parsed.scene, "swollen.yaml");
    world = as_world<double>(all.world);
    begin(world, *backend, all.seeds);
    motion = initial_velocities(world, all.seeds);
  }
  LedgerRow row(const FrameSums& sums, const LedgerRow* before) const {
    return ledger_row(world, *backend, motion, sums, before);
  }
  World<double> world;
  std::unique_ptr<Backend<double>> backend = make_reference_backend<double>();
  Motion<double> motion;
};

FrameSums measured(std::optional<double> swollen) {
  FrameSums sums;
  StepSums step;
  step.dt = 1e-3;
  step.swollen = swollen;
  sums.add(step, 1e-3);
  return sums;
}

TEST(Swollen, IsAShareOfTheLiquidsVolumeAlone) {
  const WaterOnSand start;
  const LedgerRow first = start.row({}, nullptr);
  EXPECT_EQ(first.swollen, 0) << "as it was put there";
  EXPECT_NEAR(start.row(measured(5e-4), &first).swollen, 0.5, 1e-12);
}

TEST(Swollen, StandsUntilItIsMeasuredAgain) {
  const WaterOnSand start;
  const LedgerRow first = start.row({}, nullptr), second = start.row(measured(2e-4), &first);
  EXPECT_EQ(start.row(measured({}), &second).swollen, second.swollen);
  EXPECT_NEAR(start.row(measured(0), &second).swollen, 0, 1e-12);
  FrameSums sums = measured(3e-4);
  sums.add(StepSums{}, 1e-3);
  EXPECT_EQ(sums.swollen, 3e-4) << "a step without volume relaxation measures nothing";
}

TEST(Swollen, IsNoNumberWhereNothingMeasuresIt) {
  const WaterOnSand loose({"materials.water.relaxation=0"});
  const LedgerRow first = loose.row({}, nullptr);
  EXPECT_TRUE(std::isnan(first.swollen));
  EXPECT_TRUE(std::isnan(loose.row(measured({}), &first).swollen));
  const WaterOnSand dry({"materials.water={type: elastic, preset: jelly}"});
  EXPECT_EQ(dry.row({}, nullptr).swollen, 0) << "without a liquid nothing is swollen";
}

TEST(Swollen, GoesThroughACheckpointWithinAFrame) {
  const WaterOnSand start;
  const fs::path folder = fs::path(DM_BINARY_DIR) / "test-files" / "swollen";
  fs::create_directories(folder);
  for (const std::optional<double> swollen : {std::optional(1.5e-4), std::optional<double>()}) {
    save_checkpoint(folder / "c.h5", start.world, {"hash", "reference", "scalar", measured(swollen), 0, {}});
    WaterOnSand again;
    EXPECT_EQ(load_checkpoint(folder / "c.h5", "hash", again.world).sums.swollen, swollen);
  }
}

TEST(Swollen, IsWarnedOfWhereMatterIsCalmForLongerThanItFlies) {
  WaterOnSand start;
  LedgerRow row = start.row(measured(1.2e-4), nullptr);
  // sqrt(g dx) = 0.443 m/s, 2 sqrt(dx/g) = 0.0903 s.
  const double mass = row.mass, limit = 9.81 * 0.02 / 2 * mass;
  SwollenWatch watch;
  const auto look = [&](double time, double swollen, double kinetic) {
    start.world.time = time, row.swollen = swollen, row.kinetic = kinetic;
    return watch.look(start.world, row);
  };
  const auto lasts = [&](double swollen, double kinetic) {
    look(0, 0, 0), look(1, swollen, kinetic);
    return look(1.1, swollen, kinetic);
  };
  const auto calm = lasts(0.12, 0.1 * limit);
  ASSERT_TRUE(calm);
  EXPECT_THAT(*calm, testing::StartsWith(std::string(swollen_warning_start)));
  EXPECT_THAT(*calm, HasSubstr("+12 % at frame 1, though it is calm (0.14 m/s, rms)"));
  EXPECT_TRUE(lasts(0.12, 0.99 * limit));
  EXPECT_FALSE(lasts(0.12, 1.01 * limit)) << "a splash may be open";
  EXPECT_FALSE(lasts(0.09, 0));
  EXPECT_FALSE(lasts(std::nan(""), 0));
  look(0, 0, 0), look(1, 0.12, 0);
  EXPECT_FALSE(look(1.08, 0.12, 0)) << "still in flight";
  EXPECT_FALSE(look(1.09, 0.12, 2 * limit));
  EXPECT_FALSE(look(1.1, 0.12, 0)) << "it moved in between";
  start.world.gravity = {};
  EXPECT_FALSE(lasts(0.12, 0)) << "without gravity no speed says what is calm";
}

TEST(Swollen, IsNotWarnedOfWhereThereIsTooLittleLiquidToMeasure) {
  for (const auto& [high, warned] : {std::pair("[0.06, 0.08, 0.06]", true), std::pair("[0.06, 0.08, 0.05]", false)}) {
    WaterOnSand drop({std::string("bodies.pool.shape.box.max=") + high});  // of 27 and 22.5 cells
    LedgerRow row = drop.row({}, nullptr);
    row.swollen = 0.46, row.kinetic = 0;
    SwollenWatch watch;
    drop.world.time = 1;
    EXPECT_FALSE(watch.look(drop.world, row));
    drop.world.time = 2;
    EXPECT_EQ(watch.look(drop.world, row).has_value(), warned) << high;
  }
}

/// The warnings of a run of water in a box of 10 x 18 x 5 cells, up to a frame.
std::vector<std::string> warnings_of(const std::string& slab, int frames, bool resume) {
  const auto parsed = scene::parse_scene_text(R"(dreampm: 1
name: slab
space: {min: [0, 0, 0], max: [0.4, 0.7, 0.2], spacing: 0.02}
time: {fps: 24, frames: 40}
materials: {water: {type: newtonian, preset: water}}
output: {checkpoint: {every: 5}}
bodies: {slab: {material: water, shape: {box: )" + slab +
                                                  "}}}\n",
                                              "slab.yaml");
  if (!parsed.ok()) throw std::runtime_error(parsed.text());
  const fs::path folder = fs::path(DM_BINARY_DIR) / "test-files" / "swollen-slab";
  if (!resume) fs::remove_all(folder);
  SimulateOptions options;
  options.folder = folder, options.frames = frames, options.resume = resume;
  simulate(parsed.scene, {"slab.yaml", std::nullopt}, options);
  std::vector<std::string> all = RunRecord::load(folder / "run.json").warnings;
  std::erase_if(all, [](const std::string& w) { return !w.starts_with(swollen_warning_start); });
  return all;
}

TEST(Swollen, ARunWarnsOnce) {
  EXPECT_TRUE(warnings_of("{min: [0, 0, 0], max: [0.4, 0.12, 0.2]}", 10, false).empty()) << "still water";
  const std::string fallen = "{min: [0, 0.2, 0], max: [0.4, 0.28, 0.2]}";
  const auto first = warnings_of(fallen, 25, false);
  ASSERT_EQ(first.size(), 1u) << "a slab of two cells that fell flat";
  EXPECT_EQ(warnings_of(fallen, 30, true), first) << "nor again when it goes on";
}

}  // namespace
}  // namespace dreampm

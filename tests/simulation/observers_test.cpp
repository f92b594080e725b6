// Observers attached to a simulation: the files of `dreampm run`, through restarts too.
#include "dreampm/observers.h"

#include <gmock/gmock.h>

#include <filesystem>

#include "dreampm/base/file.h"
#include "dreampm/io/ledger.h"
#include "dreampm/io/numbered.h"
#include "dreampm/io/series.h"
#include "dreampm/pipeline/simulate.h"
#include "scenes.h"

namespace dreampm::test {
namespace {
namespace fs = std::filesystem;
using testing::HasSubstr;

/// Water that falls, a tap, a probe by frames and one by its rate.
Scene tap() {
  return parse_scene(
      "dreampm: 1\nname: tap\nspace: {min: [0, 0, 0], max: [0.2, 0.2, 0.16], spacing: 0.02}\n"
      "time: {fps: 50, frames: 9}\nmaterials: {water: {type: newtonian, preset: water}}\n"
      "bodies: {drop: {material: water, shape: {box: {min: [0, 0, 0], max: [0.08, 0.12, 0.16]}}}}\n"
      "emitters: {tap: {material: water, shape: {box: {min: [0.1, 0.14, 0.04], max: [0.16, 0.18, 0.12]}}, "
      "velocity: [0, -0.5, 0], pool: 4000}}\n"
      "probes: {level: {type: height, at: [0.05, 0.08]}, floor: {type: force, on: floor, rate: 300}}\n",
      "tap.yaml");
}

fs::path fresh_folder(const std::string& name) {
  const fs::path folder = fs::path(DM_BINARY_DIR) / "test-files" / ("observers-" + name);
  fs::remove_all(folder);
  fs::create_directories(folder);
  return folder;
}

void attach_all(Simulation& s, const fs::path& folder) {
  attach(s, LedgerFile{folder / "ledger.csv"});
  attach(s, ParticleFiles{folder / "particles"});
  attach(s, ProbeFiles{folder / "probes"});
}

std::vector<std::string> files_of_frames(int frames) {
  std::vector<std::string> names{"ledger.csv", "probes/level.csv", "probes/floor.csv"};
  for (int f = 1; f <= frames; ++f) names.push_back("particles/" + numbered("particles", f, ".ply"));
  return names;
}

TEST(Attached, FilesAreThoseOfARun) {
  const fs::path ours = fresh_folder("ours"), run = fresh_folder("run");
  for (const char* backend : {"cpu", "reference"}) {
    const int frames = std::string(backend) == "cpu" ? 9 : 3;
    SimulateOptions options;
    options.folder = run, options.backend = backend, options.frames = frames;
    simulate(tap().model(), {"tap.yaml", std::nullopt}, options);
    Simulation s(tap(), quiet(1, backend));
    attach_all(s, ours);
    s.advance_frames(frames - 1);
    for (const std::string& file : files_of_frames(frames))
      EXPECT_EQ(read_file(ours / file), read_file(run / file)) << file << " of " << backend;
  }
}

TEST(Attached, FilesGoOnFromWhereTheSimulationWasTakenBackTo) {
  const fs::path straight = fresh_folder("straight"), back = fresh_folder("back");
  Simulation one(tap(), quiet()), two(tap(), quiet());
  attach_all(one, straight), attach_all(two, back);
  one.advance_frames(8);
  two.advance_frames(4);
  const Snapshot then = two.snapshot();
  two.advance_frames(2);
  two.step();
  EXPECT_EQ(read_ledger(back / "ledger.csv").rows.size(), 7u);
  two.restore(then);
  EXPECT_EQ(read_ledger(back / "ledger.csv").rows.size(), 5u);
  EXPECT_EQ(read_series(back / "probes/floor.csv").rows.back().at(0),
            read_series(back / "probes/level.csv").rows.back().at(0));
  two.advance_frames(4);
  for (const std::string& file : files_of_frames(9))
    EXPECT_EQ(read_file(back / file), read_file(straight / file)) << file;
}

TEST(Attached, CheckpointsAreGoneOnFrom) {
  const fs::path folder = fresh_folder("checkpoints");
  Simulation s(tap(), quiet());
  attach(s, CheckpointFiles{folder / "saved", 2, 2});
  attach(s, LedgerFile{folder / "ledger.csv"});
  s.advance_frames(7);
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder / "saved")) names.push_back(entry.path().filename().string());
  EXPECT_THAT(names, testing::UnorderedElementsAre("checkpoint_000006.yaml", "checkpoint_000006.start.h5",
                                                   "checkpoint_000008.yaml", "checkpoint_000008.start.h5"));
  const std::uint64_t end = s.hash();
  const std::string ledger = read_file(folder / "ledger.csv");
  s.load(folder / "saved/checkpoint_000006.yaml");
  EXPECT_EQ(read_ledger(folder / "ledger.csv").rows.back().frame, 6) << "rows of later frames are cut";
  s.advance_frames(2);
  EXPECT_EQ(s.hash(), end);
  EXPECT_EQ(read_file(folder / "ledger.csv"), ledger);
}

TEST(Attached, AnyMomentIsABeginning) {
  const fs::path folder = fresh_folder("late");
  Simulation s(tap(), quiet());
  s.advance_frames(2);
  s.step();
  attach_all(s, folder);
  s.advance_frames(1);
  const Ledger ledger = read_ledger(folder / "ledger.csv");
  ASSERT_EQ(ledger.rows.size(), 2u);
  EXPECT_EQ(ledger.rows[0].time, s.time() - (ledger.rows[1].time - ledger.rows[0].time));
  EXPECT_EQ(ledger.rows[0].substeps, 0) << "nothing is counted before it is attached";
  EXPECT_EQ(ledger.rows[1].frame, 4);
  EXPECT_NEAR(ledger.rows[1].mass, ledger.rows[0].mass + ledger.rows[1].entered_mass, 1e-12);
  EXPECT_EQ(read_series(folder / "probes/level.csv").rows.size(), 4u) << "what was measured before is there too";
  EXPECT_FALSE(fs::exists(folder / "particles/particles_000002.ply"));
  EXPECT_TRUE(fs::exists(folder / "particles/particles_000004.ply"));
}

TEST(Attached, FilesOfOthersInTheFolderStay) {
  const fs::path folder = fresh_folder("together");
  replace_file_text(folder / "mine.csv", "1\n");
  Simulation s(tap(), quiet());
  attach(s, LedgerFile{folder / "ledger.csv"});
  attach(s, ProbeFiles{folder});
  attach(s, ParticleFiles{folder});
  attach(s, CheckpointFiles{folder, 1, 1});
  s.advance_frames(2);
  for (const char* file : {"mine.csv", "ledger.csv", "level.csv", "particles_000001.ply", "checkpoint_000003.yaml"})
    EXPECT_TRUE(fs::exists(folder / file)) << file;
  EXPECT_FALSE(fs::exists(folder / "checkpoint_000002.yaml"));
}

TEST(Attached, WhatCannotBeWrittenIsSaid) {
  Simulation s(tap(), quiet());
  const fs::path folder = fresh_folder("wrong");
  EXPECT_THAT(message_of<InputError>([&] { attach(s, ParticleFiles{folder, {"velocity", "mood"}}); }),
              HasSubstr("mood"));
  EXPECT_THAT(message_of<InputError>([&] { attach(s, CheckpointFiles{folder, 0}); }), HasSubstr("must be 1 or more"));
  replace_file_text(folder / "file", "");
  EXPECT_THROW(attach(s, LedgerFile{folder / "file/ledger.csv"}), Error);
  s.advance_frames(1);
}

}  // namespace
}  // namespace dreampm::test

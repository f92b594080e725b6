// A run gives the same bits however it is cut up: by threads, by kill -9, by what it writes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <regex>
#include <thread>

#include "dreampm/base/error.h"
#include "dreampm/base/file.h"
#include "dreampm/base/interrupt.h"
#include "dreampm/io/archive.h"
#include "dreampm/io/ledger.h"
#include "dreampm/io/numbered.h"
#include "dreampm/io/run_record.h"
#include "dreampm/io/series.h"
#include "dreampm/pipeline/inspect.h"
#include "dreampm/pipeline/simulate.h"
#include "dreampm/scene/parse.h"

namespace dreampm {
namespace {
namespace fs = std::filesystem;

constexpr const char* scene_text = R"(dreampm: 1
name: two
space: {min: [0, 0, 0], max: [0.6, 0.6, 0.4], spacing: 0.02, walls: {ceiling: {type: open}}}
time: {fps: 24, frames: 25, cfl: 0.4}
materials:
  water: {type: newtonian, preset: water, max_compression: 0.02}
  jelly: {type: elastic, preset: jelly}
bodies:
  pool: {material: water, shape: {box: {min: [0, 0, 0], max: [0.3, 0.3, 0.4]}}}
  cube: {material: jelly, shape: {box: {size: [0.12, 0.12, 0.12]}, center: [0.4, 0.3, 0.2]}, spin: [0, 0, 3]}
colliders:
  ball: {shape: {sphere: {radius: 0.08}, center: [0.45, 0.08, 0.2]}, type: separate, friction: 0.2}
output: {checkpoint: {every: 5}}
)";

model::Scene scene(const std::vector<std::string>& overrides = {}) {
  scene::ParseOptions options;
  options.overrides = overrides;
  const auto r = scene::parse_scene_text(scene_text, "two.yaml", options);
  if (!r.ok()) throw std::runtime_error(r.text());
  return r.scene;
}

/// The scene with a probe of every type, at rates between steps and frames.
model::Scene measured(std::vector<std::string> overrides = {}) {
  for (const char* probe : {"level={type: height, at: [0.1, 0.2], rate: 24}",
                            "p={type: pressure, at: [0, 0.1, 0.2], normal: [1, 0, 0], radius: 0.05}",
                            "v={type: velocity, at: [0.2, 0.1, 0.2], radius: 0.05, rate: 100}",
                            "fall={type: flux, plane: {point: [0.32, 0, 0], normal: [1, 0, 0]}, rate: 70}",
                            "tank={type: region, shape: {box: {min: [0, 0, 0], max: [0.3, 0.6, 0.4]}}}",
                            "push={type: force, on: floor, rate: 100}", "lift={type: force, on: ball}",
                            "front={type: extent, axis: x, material: water, rate: 1e6}",
                            "tip={type: point, body: cube, at: [0.46, 0.36, 0.26], rate: 7}"})
    overrides.push_back(std::string("probes.") + probe);
  return scene(overrides);
}
constexpr const char* probe_names[] = {"level", "p", "v", "fall", "tank", "push", "lift", "front", "tip"};

class Resume : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "dreampm-resume-XXXXXX").string();
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    folder_ = name;
  }
  void TearDown() override { fs::remove_all(folder_); }

  /// Runs in a process of its own, as a user would; gives its exit code, or -signal. `until`:
  /// called in the parent meanwhile.
  template <class During>
  int run(const std::string& name, SimulateOptions options, const model::Scene& s, const During& during) {
    const pid_t child = fork();
    if (child == 0) {
      std::freopen("/dev/null", "w", stderr);
      int code = 0;
      try {
        catch_interrupts();
        options.folder = folder_ / name;
        simulate(s, {"two.yaml", std::nullopt}, options);
      } catch (const Error& e) {
        std::ofstream(folder_ / (name + ".error")) << e.what();
        code = e.exit_code();
      }
      _exit(code);
    }
    during(child);
    int status = 0;
    waitpid(child, &status, 0);
    return WIFSIGNALED(status) ? -WTERMSIG(status) : WEXITSTATUS(status);
  }
  int run(const std::string& name, const SimulateOptions& options = {}, const model::Scene& s = scene()) {
    return run(name, options, s, [](pid_t) {});
  }
  std::vector<std::string> hashes(const std::string& name) const {
    std::vector<std::string> h;
    for (const FrameRecord& f : RunRecord::load(folder_ / name / "run.json").frames) h.push_back(f.state_hash);
    return h;
  }
  std::string probe_file(const std::string& name, const std::string& probe) const {
    return read_file(folder_ / name / "probes" / (probe + ".csv"));
  }
  std::string error_of(const std::string& name) const { return read_file(folder_ / (name + ".error")); }
  /// Waits until that many particle files are there.
  void wait_for_frames(const std::string& name, int frames) const {
    for (int i = 0; i < 30000 && !fs::exists(folder_ / name / "particles" / numbered("particles", frames, ".ply")); ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }

  fs::path folder_;
};

TEST_F(Resume, ThreadsAndOutputDoNotChangeTheBits) {
  ASSERT_EQ(run("one", {.folder = {}, .frames = {}, .threads = 1}), 0);
  const auto want = hashes("one");
  EXPECT_FALSE(fs::exists(folder_ / "one/probes"));
  ASSERT_EQ(want.size(), 25u);
  for (const int threads : {2, 3, 8}) {
    const std::string name = "threads" + std::to_string(threads);
    ASSERT_EQ(run(name, {.folder = {}, .frames = {}, .threads = threads}, measured()), 0);
    EXPECT_EQ(hashes(name), want) << threads << ": measuring changes nothing";
    for (const char* probe : probe_names)
      EXPECT_EQ(probe_file(name, probe), probe_file("threads2", probe)) << probe << " " << threads;
  }
  ASSERT_EQ(
      run("more", {},
          scene({"output.particles.attributes=[velocity, f, j, jp, density, pressure]", "output.checkpoint.every=0"})),
      0);
  EXPECT_EQ(hashes("more"), want);
}

/// A block that gravity strikes within one step, so hard that steps at cfl 0.5 cannot follow.
model::Scene jolted(const std::string& strength) {
  const std::string text = R"(dreampm: 1
name: jolt
space: {min: [0, 0, 0], max: [0.4, 0.8, 0.4], spacing: 0.02, walls: {ceiling: {type: open}}}
time: {fps: 24, frames: 8, cfl: 0.5}
gravity: {keys: [{t: 0.2, value: [0, 0, 0]}, {t: 0.2001, value: [0, STRENGTH, 0]}, {t: 0.2046, value: [0, STRENGTH, 0]},
                 {t: 0.2047, value: [0, 0, 0]}]}
materials: {jelly: {type: elastic, density: 1000, youngs_modulus: 1.0e4, poissons_ratio: 0.3}}
bodies: {a: {material: jelly, shape: {box: {size: [0.12, 0.12, 0.12]}, center: [0.2, 0.4, 0.2]}}}
output: {checkpoint: {every: 2}}
)";
  const auto r = scene::parse_scene_text(std::regex_replace(text, std::regex("STRENGTH"), strength), "jolt.yaml", {});
  if (!r.ok()) throw std::runtime_error(r.text());
  return r.scene;
}

TEST_F(Resume, ANumericalFailureGoesBackOnceAndOnAtHalfCfl) {
  ASSERT_EQ(run("jolt", {}, jolted("-2600")), 0);
  const RunRecord record = RunRecord::load(folder_ / "jolt/run.json");
  EXPECT_EQ(record.status, "complete");
  ASSERT_EQ(record.frames.size(), 8u);
  for (std::size_t i = 0; i < 8; ++i) EXPECT_EQ(record.frames[i].frame, static_cast<int>(i) + 1);
  ASSERT_EQ(record.warnings.size(), 1u);
  EXPECT_THAT(record.warnings[0], testing::HasSubstr("went on from frame 4 with time.cfl 0.25"));
  const Ledger ledger = read_ledger(folder_ / "jolt/ledger.csv");
  ASSERT_EQ(ledger.rows.size(), 8u);
  // The blow is not left out: 1.7 kg at 2600 m/s^2 over 4.6 ms.
  EXPECT_NEAR(ledger.rows[5].momentum.y, -20.7, 0.8);
}

TEST_F(Resume, TheSecondFailureStopsWithTheLastGoodState) {
  ASSERT_EQ(run("jolt", {}, jolted("-1e25")), 1);
  EXPECT_THAT(error_of("jolt"),
              testing::HasSubstr("lower time.cfl (now 0.25); the frames and checkpoints before it are whole"));
  EXPECT_EQ(RunRecord::load(folder_ / "jolt/run.json").status, "failed");
  EXPECT_TRUE(fs::exists(folder_ / "jolt/checkpoint/checkpoint_000004.h5"));
}

TEST_F(Resume, KilledThreeTimesItEndsInTheSameState) {
  ASSERT_EQ(run("whole", {}, measured()), 0);
  SimulateOptions again;
  again.resume = true;
  for (const int frame : {3, 9, 17}) {
    const int code = run("killed", again, measured(), [&](pid_t child) {
      wait_for_frames("killed", frame);
      kill(child, SIGKILL);
    });
    ASSERT_EQ(code, -SIGKILL) << "it ended before it could be killed";
  }
  ASSERT_EQ(run("killed", again, measured()), 0);
  EXPECT_EQ(hashes("killed"), hashes("whole"));
  for (const char* probe : probe_names) EXPECT_EQ(probe_file("killed", probe), probe_file("whole", probe)) << probe;
  for (int frame = 1; frame <= 25; ++frame) {
    const auto file = fs::path("particles") / numbered("particles", frame, ".ply");
    EXPECT_EQ(read_file(folder_ / "killed" / file), read_file(folder_ / "whole" / file)) << frame;
  }
  EXPECT_EQ(read_file(folder_ / "killed/ledger.csv"), read_file(folder_ / "whole/ledger.csv"));
}

TEST_F(Resume, WhatTheGridCarriesBesidesGoesOnTheSameWay) {
  const std::vector<std::string> kept{
      "time.frames=9",
      "space.periodic=[z]",
      "materials.water.transfer=asflip",
      "materials.jelly.transfer=flip",
      "gravity={keys: [{t: 0, value: [0, -9.81, 0]}, {t: 0.3, value: [4, -9.81, 0]}]}",
      "fields={gust: {type: wind, velocity: [0, 0, 3], coefficient: 2}, air: {type: drag, rate: 0.5}}"};
  const std::vector<std::string> filled{
      "time.frames=9", "materials.oil={type: newtonian, density: 300}", "materials.sand={type: sand}",
      "bodies.oil={material: oil, shape: {box: {min: [0, 0.3, 0], max: [0.3, 0.5, 0.4]}}}",
      "bodies.heap={material: sand, shape: {box: {min: [0.3, 0.3, 0], max: [0.5, 0.5, 0.12]}}}"};
  for (const auto& [name, overrides] :
       {std::pair{"kept velocities, periodic axes, fields", kept}, std::pair{"what several densities fill", filled}}) {
    SCOPED_TRACE(name);
    const model::Scene s = scene(overrides);
    ASSERT_EQ(run("whole", {}, s), 0);
    ASSERT_EQ(run("cut", {.folder = {}, .frames = 6}, s), 0);
    SimulateOptions again;
    again.resume = true;
    ASSERT_EQ(run("cut", again, s), 0);
    EXPECT_EQ(hashes("cut").size(), 9u);
    EXPECT_EQ(hashes("cut"), hashes("whole"));
    EXPECT_EQ(read_file(folder_ / "cut/ledger.csv"), read_file(folder_ / "whole/ledger.csv"));
  }
}

TEST_F(Resume, StagesOfViscosityGoOnTheSameWay) {
  const model::Scene s =
      scene({"time.frames=9", "materials.water.viscosity=1000", "materials.water.max_compression=0.2"});
  ASSERT_EQ(run("whole", {}, s), 0);
  ASSERT_EQ(run("cut", {.folder = {}, .frames = 6}, s), 0);
  const ArchiveReader saved(folder_ / "cut/checkpoint/checkpoint_000006.h5", "dreampm-checkpoint", 6);
  EXPECT_GE(saved.value<std::int32_t>("viscous_stages"), 2) << "or this tests nothing";
  SimulateOptions again;
  again.resume = true;
  ASSERT_EQ(run("cut", again, s), 0);
  EXPECT_EQ(hashes("cut"), hashes("whole"));
  EXPECT_EQ(read_file(folder_ / "cut/ledger.csv"), read_file(folder_ / "whole/ledger.csv"));
}

TEST_F(Resume, AProjectionGoesOnTheSameWayOnAnyThreads) {
  const model::Scene s = scene(
      {"time.frames=13", "time.solver=projection", "time.cfl=2", "materials.jelly={type: newtonian, preset: water}"});
  ASSERT_EQ(run("whole", {.folder = {}, .frames = {}, .threads = 1, .strict = true}, s), 0);
  ASSERT_EQ(run("cut", {.folder = {}, .frames = 7, .threads = 2}, s), 0);
  ASSERT_EQ(run("cut", {.folder = {}, .frames = {}, .threads = 3, .strict = true, .resume = true}, s), 0);
  EXPECT_EQ(hashes("cut").size(), 13u);
  EXPECT_EQ(hashes("cut"), hashes("whole"));
  EXPECT_EQ(read_file(folder_ / "cut/ledger.csv"), read_file(folder_ / "whole/ledger.csv"));
  std::uint64_t steps = 0;
  for (const FrameRecord& f : RunRecord::load(folder_ / "whole/run.json").frames) steps += f.substeps;
  EXPECT_LT(steps, 13u * 10);
}

TEST_F(Resume, AnInterruptSavesTheStateAndExits130) {
  ASSERT_EQ(run("whole", {}, measured()), 0);
  const int code = run("stopped", {}, measured(), [&](pid_t child) {
    wait_for_frames("stopped", 7);
    kill(child, SIGINT);
  });
  EXPECT_EQ(code, 130);
  EXPECT_EQ(RunRecord::load(folder_ / "stopped/run.json").status, "interrupted");
  SimulateOptions again;
  again.resume = true;
  ASSERT_EQ(run("stopped", again, measured()), 0);
  for (const char* probe : probe_names) EXPECT_EQ(probe_file("stopped", probe), probe_file("whole", probe)) << probe;
  EXPECT_EQ(hashes("stopped"), hashes("whole"));
  EXPECT_EQ(read_file(folder_ / "stopped/ledger.csv"), read_file(folder_ / "whole/ledger.csv"));
}

TEST_F(Resume, ACheckpointOfAnotherSceneIsRefused) {
  ASSERT_EQ(run("run", {.folder = {}, .frames = 6}), 0);
  SimulateOptions again;
  again.resume = true;
  EXPECT_EQ(run("run", again, scene({"gravity=[0, -1, 0]"})), 2);
  EXPECT_NE(error_of("run").find("another scene"), std::string::npos) << error_of("run");
}

TEST_F(Resume, ProbesLookAtTheirRates) {
  ASSERT_EQ(run("run", {.folder = {}, .frames = 13}, measured()), 0);  // 0.5 s
  const auto times = [&](const char* probe) {
    return read_series(folder_ / "run/probes" / (std::string(probe) + ".csv")).column("time");
  };
  const auto frames = times("p");
  ASSERT_EQ(frames.size(), 13u) << "once a frame";
  for (std::size_t i = 0; i < 13; ++i) EXPECT_EQ(frames[i], static_cast<double>(i) / 24);
  EXPECT_EQ(times("level"), frames) << "a rate that is that of the frames";
  EXPECT_EQ(times("lift").size(), 12u) << "a mean has no value at the start";
  const double longest = [&] {
    double dt = 0;
    for (const LedgerRow& row : read_ledger(folder_ / "run/ledger.csv").rows) dt = std::max(dt, row.dt_max);
    return dt;
  }();
  const auto fast = times("v");
  ASSERT_EQ(fast.size(), 51u);
  for (std::size_t i = 0; i < fast.size(); ++i) {
    const double due = static_cast<double>(i) / 100;
    EXPECT_GE(fast[i], due - 1e-7);
    EXPECT_LE(fast[i], due + longest) << "the first step end at or after its time";
  }
  std::uint64_t steps = 0;
  for (const FrameRecord& f : RunRecord::load(folder_ / "run/run.json").frames) steps += f.substeps;
  EXPECT_EQ(times("front").size(), steps + 1) << "never twice in a step";
  EXPECT_EQ(times("tip").size(), 4u);
}

TEST_F(Resume, RunAndInfoListTheProbes) {
  ASSERT_EQ(run("run", {.folder = {}, .frames = 1}, measured()), 0);
  const auto probes = RunRecord::load(folder_ / "run/run.json").probes;
  EXPECT_EQ(probes.size(), std::size(probe_names));
  EXPECT_EQ(probes.at("fall"), "flux");
  const auto reported = std::get<std::string>(inspect(folder_ / "run").facts.at("probes"));
  EXPECT_NE(reported.find("level (height)"), std::string::npos) << reported;
  ASSERT_EQ(run("run", {.folder = {}, .frames = 1}), 0);
  EXPECT_TRUE(RunRecord::load(folder_ / "run/run.json").probes.empty());
  EXPECT_FALSE(fs::exists(folder_ / "run/probes/level.csv")) << "of the run before";
}

TEST_F(Resume, AProbeThatIsNewOrChangedNeedsANewStart) {
  ASSERT_EQ(run("run", {.folder = {}, .frames = 6}, measured()), 0);
  SimulateOptions again;
  again.resume = true;
  EXPECT_EQ(run("run", again, measured({"probes.more={type: height, at: [0.1, 0.2]}"})), 2);
  EXPECT_NE(error_of("run").find("probe more is not in the checkpoint"), std::string::npos) << error_of("run");
  EXPECT_EQ(run("run", again, scene({"probes.push={type: force, on: x_min, rate: 100}"})), 2);
  EXPECT_NE(error_of("run").find("probe push was another one"), std::string::npos) << error_of("run");
  EXPECT_EQ(run("out", {}, measured({"probes.off={type: point, body: cube, at: [0.1, 0.1, 0.1]}"})), 2);
  EXPECT_NE(error_of("out").find("probe off: at [0.1, 0.1, 0.1] the body cube has no matter"), std::string::npos)
      << error_of("out");
}

TEST_F(Resume, ATruncatedCheckpointFallsBackToTheOneBefore) {
  ASSERT_EQ(run("run", {.folder = {}, .frames = 11}), 0);
  const fs::path newest = folder_ / "run/checkpoint" / numbered("checkpoint", 11, ".h5");
  ASSERT_TRUE(fs::exists(newest));
  fs::resize_file(newest, fs::file_size(newest) / 2);
  SimulateOptions again;
  again.resume = true;
  ASSERT_EQ(run("run", again), 0);
  ASSERT_EQ(run("whole"), 0);
  EXPECT_EQ(hashes("run"), hashes("whole"));
}

TEST_F(Resume, AFolderUnderAFileCannotBeMade) {
  replace_file_text(folder_ / "file", "x");
  SimulateOptions options;
  const pid_t child = fork();
  if (child == 0) {
    try {
      options.folder = folder_ / "file" / "run";
      simulate(scene(), {"two.yaml", std::nullopt}, options);
    } catch (const Error& e) {
      _exit(e.exit_code());
    }
    _exit(0);
  }
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_EQ(WEXITSTATUS(status), 2);
}

TEST_F(Resume, AFullDiskStopsTheRunAndLeavesWholeFilesOnly) {
  SimulateOptions options;
  const pid_t child = fork();
  if (child == 0) {
    std::freopen("/dev/null", "w", stderr);
    signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{40000, 40000};  // smaller than one particle file
    setrlimit(RLIMIT_FSIZE, &limit);
    try {
      options.folder = folder_ / "full";
      simulate(scene(), {"two.yaml", std::nullopt}, options);
    } catch (const Error& e) {
      _exit(e.exit_code());
    }
    _exit(0);
  }
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_EQ(WEXITSTATUS(status), 1);
  EXPECT_TRUE(fs::is_empty(folder_ / "full/particles"));
}

TEST_F(Resume, ABodyOutsideTheWallsIsRefusedWithItsPlace) {
  EXPECT_EQ(run("out", {}, scene({"bodies.cube.shape.center=[0.58, 0.3, 0.2]"})), 2);
  EXPECT_NE(error_of("out").find("body cube reaches 0.0"), std::string::npos) << error_of("out");
  EXPECT_NE(error_of("out").find("x_max"), std::string::npos) << error_of("out");
}

TEST_F(Resume, MoreMatterThanMemoryIsRefusedWithTheFigure) {
  EXPECT_EQ(run("huge", {}, scene({"space.spacing=0.00005"})), 2);
  EXPECT_NE(error_of("huge").find("GiB"), std::string::npos) << error_of("huge");
}

TEST_F(Resume, OverlappingBodiesAreWarnedOfWithTheirVolume) {
  ASSERT_EQ(run("overlap", {.folder = {}, .frames = 2}, scene({"bodies.cube.shape.center=[0.2, 0.2, 0.2]"})), 0);
  const auto warnings = RunRecord::load(folder_ / "overlap/run.json").warnings;
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_EQ(warnings[0].rfind("bodies pool and cube overlap by 0.0017", 0), 0u) << warnings[0];
}

TEST_F(Resume, TheReferenceRunsTheSameScene) {
  SimulateOptions options;
  options.backend = "reference";
  options.frames = 3;
  ASSERT_EQ(run("reference", options), 0);
  ASSERT_EQ(run("cpu", {.folder = {}, .frames = 3}), 0);
  const Ledger a = read_ledger(folder_ / "reference/ledger.csv"), b = read_ledger(folder_ / "cpu/ledger.csv");
  ASSERT_EQ(a.rows.size(), 3u);
  EXPECT_NEAR(a.rows[2].kinetic, b.rows[2].kinetic, 1e-4 * a.rows[2].kinetic);
}

}  // namespace
}  // namespace dreampm

// A run gives the same bits however it is cut up: by threads, by kill -9, by what it writes.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <thread>

#include "dreampm/base/error.h"
#include "dreampm/base/file.h"
#include "dreampm/base/interrupt.h"
#include "dreampm/io/ledger.h"
#include "dreampm/io/run_record.h"
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

SceneDescription scene(const std::vector<std::string>& overrides = {}) {
  scene::ParseOptions options;
  options.overrides = overrides;
  const auto r = scene::parse_scene_text(scene_text, "two.yaml", options);
  if (!r.ok()) throw std::runtime_error(r.text());
  return r.scene;
}

class Resume : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "dreampm-resume-XXXXXX").string();
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    folder_ = name;
  }
  void TearDown() override { fs::remove_all(folder_); }

  /// Runs in a process of its own, as a user would; gives its exit code, or -signal. `until`: called in the parent
  /// meanwhile.
  template <class During>
  int run(const std::string& name, SimulateOptions options, const SceneDescription& s, const During& during) {
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
  int run(const std::string& name, const SimulateOptions& options = {}, const SceneDescription& s = scene()) {
    return run(name, options, s, [](pid_t) {});
  }
  std::vector<std::string> hashes(const std::string& name) const {
    std::vector<std::string> h;
    for (const FrameRecord& f : RunRecord::load(folder_ / name / "run.json").frames) h.push_back(f.state_hash);
    return h;
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
  ASSERT_EQ(want.size(), 25u);
  for (const int threads : {2, 3, 8}) {
    const std::string name = "threads" + std::to_string(threads);
    ASSERT_EQ(run(name, {.folder = {}, .frames = {}, .threads = threads}), 0);
    EXPECT_EQ(hashes(name), want) << threads;
  }
  ASSERT_EQ(
      run("more", {},
          scene({"output.particles.attributes=[velocity, f, j, jp, density, pressure]", "output.checkpoint.every=0"})),
      0);
  EXPECT_EQ(hashes("more"), want);
}

TEST_F(Resume, KilledThreeTimesItEndsInTheSameState) {
  ASSERT_EQ(run("whole"), 0);
  SimulateOptions again;
  again.resume = true;
  for (const int frame : {3, 9, 17}) {
    const int code = run("killed", again, scene(), [&](pid_t child) {
      wait_for_frames("killed", frame);
      kill(child, SIGKILL);
    });
    ASSERT_EQ(code, -SIGKILL) << "it ended before it could be killed";
  }
  ASSERT_EQ(run("killed", again), 0);
  EXPECT_EQ(hashes("killed"), hashes("whole"));
  for (int frame = 1; frame <= 25; ++frame) {
    const auto file = fs::path("particles") / numbered("particles", frame, ".ply");
    EXPECT_EQ(read_file(folder_ / "killed" / file), read_file(folder_ / "whole" / file)) << frame;
  }
  EXPECT_EQ(read_file(folder_ / "killed/ledger.csv"), read_file(folder_ / "whole/ledger.csv"));
}

TEST_F(Resume, AnInterruptSavesTheStateAndExits130) {
  ASSERT_EQ(run("whole"), 0);
  const int code = run("stopped", {}, scene(), [&](pid_t child) {
    wait_for_frames("stopped", 7);
    kill(child, SIGINT);
  });
  EXPECT_EQ(code, 130);
  EXPECT_EQ(RunRecord::load(folder_ / "stopped/run.json").status, "interrupted");
  SimulateOptions again;
  again.resume = true;
  ASSERT_EQ(run("stopped", again), 0);
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
  EXPECT_NEAR(a.rows[2].values.at("kinetic"), b.rows[2].values.at("kinetic"), 1e-4 * a.rows[2].values.at("kinetic"));
}

}  // namespace
}  // namespace dreampm

// Films made beside the playground, by the command as it is built.
#include "dreampm/play/model/rendering.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <thread>

#include "dreampm/base/file.h"
#include "dreampm/io/run_record.h"
#include "dreampm/play/window/headless.h"
#include "dreampm/simulation.h"
#include "play/small_scene.h"

namespace dreampm::play::rendering_test {
namespace {
using namespace test;
using testing::EndsWith;
using testing::Gt;
using testing::HasSubstr;
using State = RenderStatus::State;

/// A folder of its own, which runs write into.
class Films : public testing::Test {
 protected:
  void SetUp() override {
    before = std::filesystem::current_path();
    folder = std::filesystem::path(testing::TempDir()) / fmt::format("films-{}", ::getpid());
    std::filesystem::create_directories(folder);
    std::filesystem::current_path(folder);
    PlayOptions options = quiet_options();
    options.program = DM_COMMAND;
    playground.emplace(tiny_scene(), options);
  }
  void TearDown() override {
    playground.reset();
    std::filesystem::current_path(before);
    std::filesystem::remove_all(folder);
  }

  static PlayScene tiny_scene() {
    return {"tank",
            small_scene().scene.with({"space.max=[0.4, 0.4, 0.25]", "render.size=[96, 64]", "render.samples=4"})};
  }
  std::shared_ptr<const RenderStatus> status() { return playground->frame()->rendering; }
  template <class Done>
  std::shared_ptr<const RenderStatus> wait_for(const Done& done) {
    for (int n = 0; n < 9000; ++n) {
      if (const auto now = status(); done(*now)) return now;
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    ADD_FAILURE() << "it takes longer than three minutes; stage " << status()->stage;
    return status();
  }
  std::shared_ptr<const RenderStatus> wait_for_end() {
    return wait_for([](const RenderStatus& s) { return !s.under_way(); });
  }

  std::filesystem::path before, folder;
  std::optional<Playground> playground;
};

TEST_F(Films, AreMadeWithTheEstimateFirst) {
  play(*playground, {"frames 12", "render a/film.yaml 0.1 1 0.5 1 0.2 0.1 0.12 40"});
  bool ran = false;
  const auto end = wait_for([&](const RenderStatus& s) {
    if (s.state == State::running) {
      ran = true;
      EXPECT_THAT(s.particles, Gt(0));
      EXPECT_THAT(s.disk_bytes, Gt(0));
      EXPECT_THAT(s.seconds, Gt(0));
      EXPECT_GE(s.share, 0);
      EXPECT_LT(s.share, 1);
    }
    return !s.under_way();
  });
  EXPECT_TRUE(ran);
  ASSERT_EQ(end->state, State::done) << end->what;
  EXPECT_EQ(end->particles, 8 * playground->simulation().particle_count());
  EXPECT_EQ(end->film, "out/film/film.mp4");
  EXPECT_TRUE(std::filesystem::exists(end->film));
  const RunRecord run = RunRecord::load("out/film/run.json");
  EXPECT_EQ(run.frames.size(), 7U);
  const Scene scene = load_scene("a/film.yaml");
  EXPECT_DOUBLE_EQ(scene.spacing(), 0.01);
}

TEST_F(Films, KeepMassMomentumAndDeformation) {
  play(*playground, {"frames 20"});
  play(*playground, {"estimate film.yaml 0.5"});
  ASSERT_EQ(wait_for_end()->state, State::estimated) << status()->what;
  Simulation fine(load_scene("film.yaml"), quiet_options().simulation);
  const Totals coarse = playground->simulation().totals(), start = fine.totals();
  EXPECT_NEAR(start.mass, coarse.mass, 1e-9 * coarse.mass);
  EXPECT_NEAR(start.momentum.x, coarse.momentum.x, 1e-3 * length(coarse.momentum));
  EXPECT_NEAR(start.momentum.y, coarse.momentum.y, 1e-3 * length(coarse.momentum));
  EXPECT_NEAR(start.elastic, coarse.elastic, 1e-3 * coarse.elastic);
  for (int n = 0; n < 12; ++n) {
    fine.advance_frames(1);
    play(*playground, {"frames 1"});
    const Totals f = fine.totals(), c = playground->simulation().totals();
    // Nothing lies so densely that it is thrown apart; finer matter is stirred the longer.
    if (n == 0) {
      EXPECT_NEAR(f.kinetic, c.kinetic, 0.1 * c.kinetic);
    }
    EXPECT_LT(f.kinetic, coarse.kinetic);
    EXPECT_NEAR(f.volume, c.volume, 0.01 * c.volume);
  }
}

TEST_F(Films, StopAndCanBeGoneOnWith) {
  play(*playground, {"frames 4", "render film.yaml 2"});
  wait_for([](const RenderStatus& s) { return s.state == State::running && s.done > 0; });
  // One at a time.
  play(*playground, {"refused render other.yaml 1", "render off"});
  EXPECT_EQ(wait_for_end()->state, State::stopped);
  EXPECT_THAT(read_file("film.log"), HasSubstr("interrupted"));
  EXPECT_TRUE(std::filesystem::exists("out/film/run.json"));
}

TEST_F(Films, ThatCannotBeWrittenAreRefused) {
  replace_file_text("file", "no folder");
  play(*playground, {"refused render file/film.yaml 1", "refused render /proc/film.yaml 1", "refused render film.txt 1",
                     "refused render film.yaml 0", "refused render film.yaml 1 2", "refused render off"});
  EXPECT_EQ(status(), nullptr);
  // The folder of the run is in the way.
  replace_file_text("out", "no folder");
  play(*playground, {"frames 1", "render film.yaml 1"});
  const auto end = wait_for_end();
  EXPECT_EQ(end->state, State::failed);
  EXPECT_THAT(end->what, HasSubstr("output.folder"));
  EXPECT_THAT(end->what, EndsWith("see film.log"));
}

TEST_F(Films, AreWaitedForWithoutAWindow) {
  replace_file_text("script.txt", "frames 4\nrender film.yaml 0.05\n");
  HeadlessOptions o;
  o.play = quiet_options(), o.play.program = DM_COMMAND, o.script = "script.txt", o.frames = 0;
  play_headless(tiny_scene(), o);
  EXPECT_TRUE(std::filesystem::exists("out/film/film.mp4"));
  std::filesystem::remove_all("out");
  replace_file_text("out", "no folder");
  EXPECT_THROW(play_headless(tiny_scene(), o), RunError);
}

TEST_F(Films, ThatWereOnlyEstimatedLeaveNothing) {
  play(*playground, {"frames 2", "estimate film.yaml 1"});
  EXPECT_TRUE(std::filesystem::exists("film.yaml"));
  play(*playground, {"render off"});
  EXPECT_EQ(status()->state, State::stopped);
  play(*playground, {"estimate film.yaml 1"});
  EXPECT_EQ(wait_for_end()->state, State::estimated);
  play(*playground, {"render off"});
  EXPECT_TRUE(std::filesystem::is_empty(folder));
}

// As a run that writes what it has to a slow disk, or hangs.
TEST_F(Films, ThatDoNotEndWhenInterruptedAreKilled) {
  replace_file_text("slow",
                    "#!/bin/sh\nif [ $1 = check ]; then echo '{\"particles\": 1, \"disk_bytes\": 1, \"memory_bytes\": "
                    "1, \"seconds\": {\"simulate\": 1, \"surface\": 1, \"render\": 1, \"video\": 1}, \"warnings\": "
                    "[]}'; exit; fi\ntrap '' INT\necho $$ > pid\nexec sleep 60\n");
  std::filesystem::permissions("slow", std::filesystem::perms::owner_all);
  const auto runs = [] {
    pid_t pid = 0;
    std::ifstream("pid") >> pid;
    return pid > 0 && ::kill(pid, 0) == 0;
  };
  auto began = std::chrono::steady_clock::now();
  {
    Rendering film(std::filesystem::absolute("slow"), "film.yaml", "cpu", true, std::chrono::milliseconds(200));
    for (int n = 0; n < 3000 && !runs(); ++n, std::this_thread::sleep_for(std::chrono::milliseconds(10))) film.look();
    ASSERT_TRUE(runs()) << film.look().what;
    began = std::chrono::steady_clock::now();
  }
  EXPECT_FALSE(runs());
  EXPECT_GT(std::chrono::steady_clock::now() - began, std::chrono::milliseconds(200)) << "it may end by itself";
  EXPECT_LT(std::chrono::steady_clock::now() - began, std::chrono::seconds(30));
}

TEST_F(Films, NeedTheCommand) {
  playground.emplace(tiny_scene(), quiet_options());
  play(*playground, {"refused render film.yaml 1"});
  EXPECT_EQ(status(), nullptr);
}

TEST_F(Films, OfAnEstimateNoFileStaysWhereTheProgramEnds) {
  playground->act(Action::parse("estimate tank-film.yaml 1"));
  EXPECT_TRUE(std::filesystem::exists("tank-film.yaml"));
  playground.reset();  // as a signal does, with the dialog open
  EXPECT_TRUE(std::filesystem::is_empty(folder));
}

}  // namespace
}  // namespace dreampm::play::rendering_test

// A playground on its own thread, and the script that it keeps.
#include "dreampm/play/model/worker.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <thread>

#include "dreampm/play/model/solver_choice.h"
#include "play/small_scene.h"

namespace dreampm::play::worker_test {
namespace {
using namespace test;

/// Waits until the frame shows it, for at most ten seconds.
template <class Shown>
bool wait_for(const Worker& worker, const Shown& shown) {
  for (int n = 0; n < 1000; ++n) {
    if (shown(*worker.latest())) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return false;
}

/// Its lines; to be read when the worker is gone.
Worker::Record into(std::vector<std::string>& script) {
  return [&script](const std::string& lines) {
    std::istringstream text(lines);
    for (std::string line; std::getline(text, line);) script.push_back(line);
  };
}

TEST(Worker, WhatItRecordsReplaysToTheSameBits) {
  std::vector<std::string> script;
  std::uint64_t steps = 0;
  {
    Worker worker(small_scene(), quiet_options(), into(script));
    EXPECT_TRUE(wait_for(worker, [](const Frame& f) { return f.steps > 20; }));
    worker.post(Action::parse("set material.water.viscosity 2"));
    worker.post(Action::parse("push 0.06 0.06 0.12 0.06 1 0 0"));
    EXPECT_TRUE(wait_for(worker, [](const Frame& f) { return f.time > 0.1; }));
    worker.post(Action::parse("release"));
    const std::uint64_t last = worker.post(Action::parse("set paused 1"));
    EXPECT_TRUE(wait_for(worker, [&](const Frame& f) { return f.actions >= last && f.meters.substeps == 0; }));
    steps = worker.latest()->steps;
    worker.check();
  }
  std::uint64_t hash = 0;
  for (int turn = 0; turn < 2; ++turn) {
    Playground again(small_scene(), quiet_options(turn + 1));
    play(again, script);
    EXPECT_EQ(again.simulation().steps(), steps);
    if (turn == 0) hash = again.hash();
    EXPECT_EQ(again.hash(), hash);
  }
}

/// A paused tick does nothing, and is a tick of no steps when it is played again.
TEST(Worker, WhatIsDoneWhilePausedReplaysToo) {
  std::vector<std::string> script;
  std::uint64_t steps = 0;
  std::size_t particles = 0;
  {
    Worker worker(small_scene(), quiet_options(), into(script));
    EXPECT_TRUE(wait_for(worker, [](const Frame& f) { return f.steps > 20; }));
    worker.post(Action::parse("set paused 1"));
    worker.post(Action::parse("set material.jelly.youngs_modulus 500000"));
    worker.post(Action::parse("pour 0.2 0.3 0.12 0.05 0 -1.5 0"));
    worker.post(Action::parse("shake 30 0 0"));
    // What is refused is no error of the record.
    worker.post(Action::parse("redo"));
    worker.post(Action::parse("drop sphere 9 9 9 0.1"));
    std::uint64_t last = worker.post(Action::parse("step"));
    EXPECT_TRUE(wait_for(worker, [&](const Frame& f) { return f.actions >= last; }));
    const std::uint64_t number = worker.latest()->number;
    EXPECT_TRUE(wait_for(worker, [&](const Frame& f) { return f.number > number + 10; }));
    last = worker.post(Action::parse("pour off"));
    EXPECT_TRUE(wait_for(worker, [&](const Frame& f) { return f.actions >= last; }));
    const std::shared_ptr<const Frame> frame = worker.latest();
    steps = frame->steps, particles = frame->particles;
  }
  Playground again(small_scene(), quiet_options());
  play(again, script);
  EXPECT_EQ(again.simulation().steps(), steps);
  EXPECT_EQ(again.simulation().particle_count(), particles);
}

TEST(Worker, PlaysARecordAgain) {
  const std::filesystem::path file = std::filesystem::path(testing::TempDir()) / "again.txt";
  std::vector<std::string> script;
  {
    Worker worker(load_play_scene("dam-break"), quiet_options(), into(script));
    worker.post(Action::parse("set material.water.viscosity 2"));
    EXPECT_TRUE(wait_for(worker, [](const Frame& f) { return f.steps > 30; }));
  }
  std::uint64_t steps = 0;
  {
    std::ofstream text(file);
    text << "# dreampm\nplays dam-break\n";
    for (const std::string& line : script) {
      text << line << "\n";
      if (line.starts_with("steps ")) steps += std::stoul(line.substr(6));
    }
  }
  std::vector<std::string> second;
  {
    Worker worker(small_scene(), quiet_options(), into(second));
    worker.post({"replay", {file.string()}});
    worker.post(Action::parse("push 0.1 0.1 0.1 0.05 1 0 0"));  // a pointer that passes
    EXPECT_TRUE(wait_for(worker, [](const Frame& f) { return f.message == "the record has ended"; }));
    EXPECT_EQ(worker.latest()->story, "dam-break");
    EXPECT_GE(worker.latest()->steps, steps);
    worker.post({"replay", {"/nowhere.txt"}});
    EXPECT_TRUE(wait_for(worker, [](const Frame& f) { return f.message_is_error; }));
  }
  // The same steps with the same numbers.
  std::vector<std::string> first_lines, second_lines;
  for (const std::string& line : script)
    if (!line.starts_with("#")) first_lines.push_back(line);
  for (const std::string& line : second)
    if (!line.starts_with("#")) second_lines.push_back(line);
  const auto opened = std::find(second_lines.begin(), second_lines.end(), "open dam-break");
  ASSERT_NE(opened, second_lines.end());
  const auto count = static_cast<std::ptrdiff_t>(first_lines.size());
  ASSERT_GT(second_lines.end() - opened, count);
  EXPECT_TRUE(std::equal(first_lines.begin(), first_lines.end(), opened + 1));
  std::filesystem::remove(file);
}

/// Many steps a tick.
PlayScene short_steps() { return by_solver(load_play_scene("dam-break"), SolverKind::explicit_steps); }

TEST(Worker, WhatWaitsToBeDoneEndsALongTick) {
  Playground p(short_steps(), quiet_options());
  play(p, {"steps 5"});
  Playground::Limit limit;
  limit.seconds = 10;
  int asked = 0;
  limit.ends = [&](double) { return ++asked == 2; };
  const double before = p.frame()->time;
  EXPECT_GT(p.tick(limit), 0);
  EXPECT_EQ(asked, 2);
  EXPECT_LT(p.frame()->time - before, 0.9 / 60) << "some of its steps are left out";
}

TEST(Worker, WhatATickGaveWayToIsMadeUpForByTheNext) {
  Playground p(short_steps(), quiet_options());
  Playground::Limit limit;
  limit.seconds = 10;
  int asked = 0;
  limit.gives_way = [&] { return ++asked == 1; };
  p.tick(limit);
  EXPECT_EQ(asked, 1);
  EXPECT_LT(p.frame()->time, 0.9 / 60);
  EXPECT_EQ(p.frame()->meters.rate, 0) << "it says nothing about the pace";
  p.tick({std::nullopt, 10});
  EXPECT_NEAR(p.frame()->time, 2.0 / 60, p.simulation().dt());
  EXPECT_NEAR(p.frame()->meters.rate, 1, 0.1);
}

TEST(Worker, GoesOnAfterWhatWasRefused) {
  Worker worker(small_scene(), quiet_options());
  const std::uint64_t number = worker.post(Action::parse("open nowhere"));
  EXPECT_TRUE(wait_for(worker, [&](const Frame& f) { return f.actions >= number; }));
  EXPECT_NE(worker.latest()->message.find("nowhere"), std::string::npos);
  const std::uint64_t before = worker.latest()->steps;
  EXPECT_TRUE(wait_for(worker, [&](const Frame& f) { return f.steps > before; }));
}

}  // namespace
}  // namespace dreampm::play::worker_test

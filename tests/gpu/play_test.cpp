// The playground by the kernels of a card, for which a stand-in is: all that hands do, and the
// past.
#include <cli/typed.h>
#include <gmock/gmock.h>
#include <simulation/scenes.h>

#include <cstdlib>

#include "dreampm/play/model/playground.h"
#include "play/small_scene.h"

namespace dreampm::play {
namespace {
using namespace play::test;
using testing::AllOf;
using testing::HasSubstr;

PlayOptions by_card() {
  setenv("DREAMPM_CUDA", STAND_IN, 1);
  PlayOptions options = quiet_options();
  options.simulation.backend = "cuda";
  return options;
}

TEST(PlayByCard, HandsDoWhatTheyDo) {
  Playground p(small_scene(), by_card());
  EXPECT_EQ(p.backend(), "cuda, sm_90");
  const std::size_t before = p.frame()->particles;
  play(p, {"frames 2", "push 0.1 0.1 0.12 0.06 1 0 0", "frames 2", "release", "set matter 1",
           "pour 0.2 0.3 0.12 0.03 0 -1 0", "frames 6", "pour off"});
  const std::size_t poured = p.frame()->particles;
  EXPECT_GT(poured, before);
  play(p, {"grab 0.28 0.08 0.12 0.06", "pull 0.2 0.2 0.12", "frames 6", "release", "drop crate 0.3 0.3 0.12 0.06",
           "frames 4", "set material.jelly.youngs_modulus 30000", "frames 4", "set gravity.x 3", "shake 4 0 0",
           "frames 3", "wall x_max 0.38", "frames 3", "cut 0.06 0.05 0.12 1 0 0 0.05", "frames 2", "step"});
  EXPECT_TRUE(finite(*p.frame()));
  EXPECT_GT(p.frame()->time, 0.1);
}

TEST(PlayByCard, UndoRedoAndRewindGoToTheVeryBits) {
  Playground p(small_scene(), by_card());
  play(p, {"steps 30"});
  expect_exact_undo_of_erasing(p);
  play(p, {"steps 20", "undo", "steps 20"});
  const std::uint64_t later = p.hash();
  play(p, {"seek 0.01"});
  EXPECT_NE(p.hash(), later);
}

TEST(PlayByCard, ARecordHasTheSameBits) {
  const std::vector<std::string> script{"steps 7",
                                        "pour 0.2 0.3 0.12 0.03 0 -1 0",
                                        "steps 9",
                                        "pour off",
                                        "push 0.1 0.1 0.12 0.06 0 1 0",
                                        "steps 8",
                                        "release",
                                        "compare on honey",
                                        "steps 6",
                                        "compare off",
                                        "restart",
                                        "steps 5"};
  PlayOptions more_threads = by_card();
  more_threads.simulation.threads = 2;
  Playground one(small_scene(), by_card()), two(small_scene(), more_threads), by_cpu(small_scene(), quiet_options());
  play(one, script), play(two, script), play(by_cpu, script);
  EXPECT_EQ(one.hash(), two.hash());
  EXPECT_NE(one.hash(), by_cpu.hash());
  EXPECT_EQ(one.frame()->particles, by_cpu.frame()->particles);
}

TEST(PlayByCard, LargeStepsToo) {
  Playground p(large_step_scene(), by_card());
  play(p, {"frames 4", "drop ball 0.25 0.3 0.12 0.06", "frames 4", "undo", "frames 2"});
  EXPECT_TRUE(finite(*p.frame()));
}

class PlayByCardTyped : public dreampm::test::Typing {};

TEST_F(PlayByCardTyped, TheCommandTakesIt) {
  write("tank.yaml", dreampm::test::tiny_dam);
  write("s.txt", "frames 3\nsave later.yaml\nrender film.yaml 0.05\n");
  const std::string here = "export DREAMPM_CUDA='" STAND_IN "'", nowhere = "export DREAMPM_CUDA=/nowhere.so";
  const auto one =
      type("play tank.yaml --headless --backend cuda --script s.txt --frames 0 --screenshot one.png", here);
  ASSERT_EQ(one.code, 0) << one.err;
  EXPECT_TRUE(std::filesystem::exists(folder / "one.png"));
  EXPECT_EQ(nlohmann::json::parse(read_file(folder / "out/film/run.json")).at("backend"), "cuda");
  // The saved moment goes on by either.
  EXPECT_EQ(type("run later.yaml --out a --backend cuda --set time.frames=4", here).code, 0);
  EXPECT_EQ(type("run later.yaml --out b --set time.frames=4", nowhere).code, 0);
  for (const char* how : {"--headless ", ""}) {
    const auto refused = type(std::string("play tank.yaml --backend cuda ") + how, nowhere + "; unset DISPLAY");
    EXPECT_EQ(refused.code, 2);
    EXPECT_THAT(refused.err, AllOf(HasSubstr("no CUDA: /nowhere.so"), HasSubstr("docs/guide/gpu.md")));
  }
}

}  // namespace
}  // namespace dreampm::play

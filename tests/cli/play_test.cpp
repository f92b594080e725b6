// The playground by its command: what is typed wrong, and what it plays without a display.
#include <gmock/gmock.h>

#include "typed.h"

namespace dreampm::test {
namespace {
using testing::HasSubstr;
using testing::StartsWith;

class Play : public Typing {
 protected:
  /// Returns the message for a line that exits with 2.
  std::string refusal(const std::string& line) const {
    const Typed t = type("play " + line);
    EXPECT_EQ(t.code, 2) << line << ": " << t.err;
    return t.err;
  }
};

TEST_F(Play, WithoutADisplayItSaysHowToPlay) {
  const Typed t = type("play", "unset DISPLAY WAYLAND_DISPLAY");
  EXPECT_EQ(t.code, 1);
  EXPECT_EQ(std::count(t.err.begin(), t.err.end(), '\n'), 1) << t.err;
  EXPECT_THAT(t.err, HasSubstr("without a display: dreampm play --headless"));
}

TEST_F(Play, RefusesWhatIsThereNot) {
  EXPECT_THAT(refusal("nowhere --headless"), HasSubstr("no story and no file nowhere; stories: report, dam-break"));
  EXPECT_THAT(refusal("report --preset 3 --headless"), HasSubstr("no preset 3; the config has 2"));
  EXPECT_THAT(refusal("report --preset 0 --headless"), HasSubstr("--preset"));
  for (const char* size : {"12", "0x5", "5x0", "9000x10", "x", "10x", "-3x4", "1e3x4", "10x10x10"})
    EXPECT_THAT(refusal(std::string("--headless --size ") + size), HasSubstr("must be WIDTHxHEIGHT")) << size;
  EXPECT_THAT(refusal("--headless --script none.txt"), HasSubstr("none.txt"));
}

TEST_F(Play, RefusesOptionsThatWouldDoNothing) {
  for (const char* option : {"--script s.txt", "--frames 3", "--screenshot out"})
    EXPECT_THAT(refusal(option), HasSubstr("--headless")) << option;
  EXPECT_THAT(refusal("--no-panels"), HasSubstr("--headless"));
  EXPECT_THAT(refusal("--headless --every 3"), HasSubstr("--screenshot"));
  EXPECT_THAT(refusal("--headless --record r.txt"), HasSubstr("--record"));
}

TEST_F(Play, NamesTheLineAndColumnOfABadConfig) {
  write("config.yaml", "presets: []\n\"grid number\": 3\n");
  EXPECT_THAT(refusal("config.yaml --headless"),
              HasSubstr("config.yaml:2:16: error: grid number is 3: must be a whole number between 8 and 256"));
  write("config.yaml", "presets: [\n");
  EXPECT_THAT(refusal("config.yaml --headless"), HasSubstr("config.yaml:2:1: error: not valid YAML"));
  write("scene.yaml", "dreampm: 1\nname: x\nfly: 3\n");
  EXPECT_THAT(refusal("scene.yaml --headless"), HasSubstr("scene.yaml:3:1: error: "));
}

TEST_F(Play, NamesTheBadLineOfAScript) {
  write("tank.yaml", tiny_dam);
  const auto error_of = [&](const std::string& script) {
    write("s.txt", script);
    return refusal("tank.yaml --headless --frames 0 --script s.txt");
  };
  EXPECT_THAT(error_of("frames 1\n# all is well\nfly 1 2\n"), HasSubstr("s.txt:3:1: error: no verb 'fly'"));
  EXPECT_THAT(error_of("set gravity.y down\n"), HasSubstr("s.txt:1:1: error: set: 'down' must be a number"));
  EXPECT_THAT(error_of("set gravity.y 11\n"), HasSubstr("s.txt:1:1: error: set: gravity.y is 11: must be between"));
  EXPECT_THAT(error_of("steps -1\n"), HasSubstr("s.txt:1:1: error: steps: '-1' must be a whole number"));
  EXPECT_THAT(error_of("frames 1e99\n"), HasSubstr("s.txt:1:1: error: frames: "));
  EXPECT_THAT(error_of("open report 3\n"), HasSubstr("s.txt:1:1: error: there is no preset 3"));
}

TEST_F(Play, MakesOnePictureOfTheLastFrameOrAFolderOfMany) {
  write("tank.yaml", tiny_dam);
  const std::string line = "play tank.yaml --headless --size 160x90 --frames 3 --screenshot ";
  ASSERT_EQ(type(line + "one.png").code, 0);
  EXPECT_TRUE(std::filesystem::is_regular_file(folder / "one.png"));
  ASSERT_EQ(type(line + "many").code, 0);
  for (const char* name : {"many/frame-0001.png", "many/frame-0002.png", "many/frame-0003.png"})
    EXPECT_TRUE(std::filesystem::is_regular_file(folder / name)) << name;
  EXPECT_THAT(refusal("tank.yaml --headless --frames 3 --screenshot x.jpg"),
              HasSubstr("must be a file that ends in .png"));
  EXPECT_FALSE(std::filesystem::exists(folder / "x.jpg"));
  EXPECT_THAT(refusal("tank.yaml --headless --frames 3 --screenshot x.png --every 2"), HasSubstr("needs a folder"));
}

TEST_F(Play, NamesTheFolderThatCannotBeMade) {
  write("tank.yaml", tiny_dam);
  write("file", "");
  const Typed t = type("play tank.yaml --headless --frames 1 --screenshot file/x");
  EXPECT_EQ(t.code, 2);
  EXPECT_THAT(t.err, HasSubstr("file/x"));
  EXPECT_THAT(refusal("tank.yaml --record file/r.txt"), HasSubstr("file"));
}

TEST_F(Play, TheSameScriptGivesTheSameHashForAnyNumberOfThreads) {
  write("tank.yaml", tiny_dam);
  write("s.txt",
        "frames 5\npush 0.1 0.1 0.15 0.08 2 1 0\nframes 3\nrelease\nset material.water.viscosity 3\nframes 4\n"
        "set matter 3\npour 0.4 0.3 0.15 0.05 0 -1.5 0\nframes 8\npour off\nsteps 7\nerase 0.1 0.05 0.15 0.05\n"
        "frames 2\nundo\nshake 10 0 0\nframes 4\n");
  const std::string line = "play tank.yaml --headless --frames 3 --script s.txt";
  const Typed first = type(line + " --threads 1");
  ASSERT_EQ(first.code, 0) << first.err;
  EXPECT_THAT(first.out, StartsWith("hash "));
  EXPECT_EQ(first.out.size(), 22u) << first.out;
  for (const char* threads : {" --threads 1", " --threads 2", ""}) EXPECT_EQ(type(line + threads).out, first.out);
  EXPECT_NE(type("play tank.yaml --headless --frames 3").out, first.out);
}

}  // namespace
}  // namespace dreampm::test

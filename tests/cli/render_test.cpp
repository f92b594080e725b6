// dreampm render as a user types it: EXR files, parts, turntables, comparisons, the denoiser.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "dreampm/io/exr.h"
#include "dreampm/io/png.h"
#include "typed.h"

namespace dreampm::test {
namespace {
using nlohmann::json;
using testing::AllOf;
using testing::ContainsRegex;
using testing::HasSubstr;
namespace fs = std::filesystem;

class RenderVerb : public Typing {
 protected:
  /// A run of three frames with surfaces: a falling block of water and a turning bar.
  void SetUp() override {
    Typing::SetUp();
    write("fall.yaml",
          "dreampm: 1\nname: fall\nspace: {min: [0, 0, 0], max: [1, 1, 0.5], spacing: 0.05}\n"
          "time: {frames: 3, fps: 24}\nmaterials: {water: {type: newtonian}}\n"
          "bodies: {block: {material: water, shape: {box: {min: [0.2, 0.4, 0.1], max: [0.6, 0.8, 0.4]}}, "
          "velocity: [0, -2, 0]}}\n"
          "colliders: {bar: {shape: {box: {size: [0.3, 0.05, 0.05]}, center: [0.75, 0.2, 0.25]}, "
          "motion: {spin: [0, 0, 8]}}}\n"
          "render: {size: [96, 64], samples: 8, stage: {floor: none}, camera: {shutter: 0.5, fstop: 1.4}}\n");
    const Typed run = type("run fall.yaml");
    ASSERT_EQ(run.code, 0) << run.err;
    ASSERT_EQ(type("surface out/fall").code, 0);
  }
  Typed render(const std::string& rest) { return type("render out/fall " + rest); }
  fs::path file(const std::string& name) const { return folder / "out/fall" / name; }
};

TEST_F(RenderVerb, WritesExrFilesBesideThePictures) {
  ASSERT_EQ(render("--exr").code, 0);
  const ExrPicture exr = read_exr(file("render/render_000002.exr"));
  EXPECT_EQ(exr.width, 96);
  EXPECT_EQ(exr.channels.size(), 13u);
  double fall = 0;
  for (const float v : exr.channel("motion.Y")->values) fall = std::min(fall, static_cast<double>(v));
  EXPECT_LT(fall, -2) << "pixels a frame downwards";
  EXPECT_THAT(render("--exr").err, HasSubstr("nothing to do"));
  // Another program reads the beauty and the depth.
  const Typed other = shell("ffmpeg -v error -i " + file("render/render_000002.exr").string() + " -f null -");
  EXPECT_EQ(other.code, 0) << other.err;
  // A picture of other settings has no file of the ones before beside it.
  ASSERT_EQ(render("--samples 4").code, 0);
  EXPECT_FALSE(fs::exists(file("render/render_000002.exr")));
  ASSERT_TRUE(fs::exists(file("render/render_000002.png")));
}

TEST_F(RenderVerb, TheLogAndTheRecordHaveTheErrorThatWasReached) {
  const Typed drawn = render("--frames 1-2");
  ASSERT_EQ(drawn.code, 0);
  EXPECT_THAT(drawn.err,
              ContainsRegex("frame 2: [0-9.]+ samples a pixel, error 0\\.[0-9]+; [0-9.e-]+ % of the pixels stopped"));
  const json stage = json::parse(read_file(file("run.json"))).at("stages").at("render");
  ASSERT_EQ(stage.at("pictures").size(), 2u);
  const json& second = stage.at("pictures")[1];
  EXPECT_EQ(second.at("frame"), 2);
  EXPECT_GE(second.at("samples"), 4);
  EXPECT_LE(second.at("samples"), 8);
  EXPECT_GT(second.at("error"), 0);
}

TEST_F(RenderVerb, APartHasThePixelsOfTheWhole) {
  ASSERT_EQ(render("--frame 2").code, 0);
  const Typed part = render("--frame 2 --crop 20,10,52,40 --exr");
  ASSERT_EQ(part.code, 0) << part.err;
  EXPECT_THAT(part.out, HasSubstr("crop_000002.png"));
  const RgbImage whole = read_png(file("render/render_000002.png")), cut = read_png(file("crop/crop_000002.png"));
  ASSERT_EQ(cut.width, 32);
  ASSERT_EQ(cut.height, 30);
  for (int y = 0; y < 30; ++y)
    for (int x = 0; x < 96; ++x) ASSERT_EQ(cut.at(0, y)[x], whole.at(20, 10 + y)[x]);
  EXPECT_EQ(read_exr(file("crop/crop_000002.exr")).x, 20);
  for (const char* wrong : {"1,2,3", "a,b,c,d", "20,10,20,40", "0,0,97,64", "1,2,3,4,5", "-1,0,4,4", "0,0,9,9,"}) {
    const Typed refused = render(std::string("--frame 2 --crop=") + wrong);
    EXPECT_EQ(refused.code, 2) << wrong;
    EXPECT_THAT(refused.err, AllOf(HasSubstr("crop"), HasSubstr(wrong)));
  }
}

TEST_F(RenderVerb, ATurntableGoesRound) {
  const Typed round = render("--frame 1 --turntable 4 --scale 0.5 --out round");
  ASSERT_EQ(round.code, 0) << round.err;
  const RgbImage first = read_png(folder / "round/turntable_000001.png"),
                 back = read_png(folder / "round/turntable_000003.png");
  EXPECT_EQ(first.width, 48);
  EXPECT_NE(first.pixels, back.pixels);
  EXPECT_FALSE(fs::exists(folder / "round/turntable_000005.png"));
  EXPECT_THAT(render("--turntable 4").err, HasSubstr("--frame"));
}

TEST_F(RenderVerb, ComparesRunsAndFiles) {
  ASSERT_EQ(render("--frame 2 --exr").code, 0);
  fs::copy(file(""), folder / "out/other", fs::copy_options::recursive);
  const Typed same = type("render --compare out/fall out/other --out seen");
  ASSERT_EQ(same.code, 0) << same.err;
  EXPECT_THAT(same.out, HasSubstr("frame 2: root mean square 0.000000, mean 0.000000, most 0.000000, 0.00 % of"));
  const RgbImage seen = read_png(folder / "seen/compare_000002.png");
  EXPECT_EQ(seen.width, 3 * 96);
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 96; ++x) ASSERT_EQ(seen.at(192 + x, y)[1], 0);
  RgbImage changed = read_png(file("render/render_000002.png"));
  // One channel of one pixel by 51 of 255: 0.2 / sqrt(3 * 96 * 64).
  std::uint8_t& one = changed.at(10, 20)[2];
  one = static_cast<std::uint8_t>(one < 128 ? one + 51 : one - 51);
  write_png(folder / "changed.png", changed);
  const Typed other = type("render --compare changed.png out/fall/render/render_000002.png");
  EXPECT_THAT(other.out, HasSubstr("root mean square 0.001473"));
  EXPECT_THAT(other.out, HasSubstr("most 0.200000, 0.02 % of"));
  const Typed kinds = type("render --compare changed.png out/fall/render/render_000002.exr");
  EXPECT_EQ(kinds.code, 2);
  EXPECT_THAT(kinds.err, HasSubstr("of two kinds"));
  EXPECT_EQ(type("render --compare changed.png").code, 2);
  EXPECT_THAT(type("render --compare changed.png out/fall").err, HasSubstr("a folder and a file"));
  EXPECT_THAT(type("render --compare none out/fall").err, HasSubstr("none: no such file or folder"));
  EXPECT_THAT(type("render --compare changed.png changed.png --frame 2 --out no").err,
              HasSubstr("changed.png is a picture; frames are chosen of two runs"));
  ExrPicture nan = read_exr(file("render/render_000002.exr"));
  for (ExrChannel& c : nan.channels)
    if (c.name == "G") c.values[96 + 3] = std::nanf("");
  write_exr(folder / "nan.exr", nan);
  const Typed not_finite = type("render --compare out/fall/render/render_000002.exr nan.exr --out no");
  EXPECT_EQ(not_finite.code, 2);
  EXPECT_THAT(not_finite.err, HasSubstr("nan.exr: pixel (3, 1) is not finite"));
  for (const char* drawing : {"--exr", "--samples 4", "--look water", "--crop 0,0,4,4"}) {
    const Typed both = type(std::string("render --compare changed.png changed.png --out no ") + drawing);
    EXPECT_EQ(both.code, 2) << drawing;
    EXPECT_THAT(both.err, HasSubstr("excludes")) << drawing;
    EXPECT_FALSE(fs::exists(folder / "no")) << drawing;
  }
}

TEST_F(RenderVerb, TheDenoiserIsThereOrRefused) {
  const json program = json::parse(type("info --json").out);
  EXPECT_EQ(program.at("kind"), "program");
  const bool found = program.at("denoiser").at("found");
  EXPECT_THAT(program.at("denoiser").at("text").get<std::string>(), HasSubstr("Open Image Denoise"));
  const Typed drawn = render("--frame 1 --denoise");
  if (found) {
    EXPECT_EQ(drawn.code, 0) << drawn.err;
    return;
  }
  EXPECT_EQ(drawn.code, 2);
  EXPECT_THAT(drawn.err, AllOf(HasSubstr("pip install pyoidn"), HasSubstr("--denoise")));
  EXPECT_FALSE(fs::exists(file("render/render_000001.png")));
}

}  // namespace
}  // namespace dreampm::test

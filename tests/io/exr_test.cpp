#include "dreampm/io/exr.h"

#include <cmath>
#include <cstdlib>

#include "dreampm/io/png.h"
#include "files.h"

namespace dreampm {
namespace {
namespace fs = std::filesystem;
using test::message_of;
using testing::AllOf;
using testing::HasSubstr;

/// Ramps that no half holds exactly, and each channel another.
ExrPicture exr_ramps(int width, int height, bool half) {
  ExrPicture p;
  p.width = p.full_width = width, p.height = p.full_height = height;
  float scale = 1;
  for (const char* name : {"R", "G", "B", "Z"}) {
    ExrChannel c{name, half, {}};
    for (int i = 0; i < width * height; ++i) c.values.push_back(scale * (0.1f + 0.01f * float(i)));
    p.channels.push_back(std::move(c));
    scale *= -7.3f;
  }
  return p;
}

TEST(Exr, FloatsComeBackAsTheyWereAndHalvesToElevenBits) {
  const fs::path file = test::fresh_folder() / "a.exr";
  for (const auto& [w, h] : {std::pair{1, 1}, {7, 3}, {40, 50}})
    for (const bool half : {false, true}) {
      const ExrPicture picture = exr_ramps(w, h, half);
      write_exr(file, picture);
      const ExrPicture back = read_exr(file);
      EXPECT_EQ(back.width, w);
      EXPECT_EQ(back.height, h);
      ASSERT_EQ(back.channels.size(), 4u);
      for (const ExrChannel& c : picture.channels) {
        const ExrChannel* other = back.channel(c.name);
        ASSERT_NE(other, nullptr) << c.name;
        EXPECT_EQ(other->half, half);
        const float share = half ? 1.0f / 2048 : 0;
        for (std::size_t i = 0; i < c.values.size(); ++i)
          EXPECT_NEAR(other->values[i], c.values[i], std::fabs(c.values[i]) * share) << c.name << " " << i;
      }
    }
  EXPECT_EQ(read_exr(file).channel("A"), nullptr);
}

TEST(Exr, APartKnowsItsPlaceAndTextItsName) {
  const fs::path file = test::fresh_folder() / "a.exr";
  ExrPicture picture = exr_ramps(7, 3, true);
  picture.x = 20, picture.y = 11, picture.full_width = 64, picture.full_height = 36;
  picture.notes["comments"] = "by hand";
  write_exr(file, picture);
  const ExrPicture back = read_exr(file);
  EXPECT_EQ(back.x, 20);
  EXPECT_EQ(back.y, 11);
  EXPECT_EQ(back.full_width, 64);
  EXPECT_EQ(back.full_height, 36);
  EXPECT_EQ(back.notes.at("comments"), "by hand");
}

TEST(Exr, ColorsAreThreeChannels) {
  const fs::path file = test::fresh_folder() / "a.exr";
  ExrPicture picture = exr_ramps(7, 3, false);
  write_exr(file, picture);
  const Image colors = read_exr_colors(file);
  ASSERT_EQ(colors.width, 7);
  ASSERT_EQ(colors.height, 3);
  for (std::size_t i = 0; i < 21; ++i) {
    EXPECT_EQ(colors.linear[i].x, picture.channels[0].values[i]);
    EXPECT_EQ(colors.linear[i].y, picture.channels[1].values[i]);
    EXPECT_EQ(colors.linear[i].z, picture.channels[2].values[i]);
  }
  picture.channels.erase(picture.channels.begin() + 1);
  write_exr(file, picture);
  EXPECT_THAT(message_of<InputError>([&] { read_exr_colors(file); }),
              AllOf(HasSubstr("a.exr: has the channels B, R, Z"), HasSubstr("R, G and B")));
}

TEST(Exr, HalvesStayFinite) {
  const fs::path file = test::fresh_folder() / "a.exr";
  ExrPicture picture = exr_ramps(2, 1, true);
  picture.channels[0].values = {1e9f, -1e9f};
  write_exr(file, picture);
  EXPECT_EQ(read_exr(file).channel("R")->values, (std::vector<float>{65504, -65504}));
}

TEST(Exr, AnotherProgramReadsIt) {
  const fs::path folder = test::fresh_folder();
  ExrPicture picture = exr_ramps(16, 8, true);
  for (ExrChannel& c : picture.channels)
    c.values.assign(c.values.size(), c.name == "R" ? 1.0f : c.name == "G" ? 0.5f : 0.0f);
  write_exr(folder / "a.exr", picture);
  // ffmpeg's own decoder, which shows linear light of 0.5 as 0.5^(1/2.2) = 0.730.
  const std::string command =
      fmt::format("ffmpeg -v error -apply_trc gamma22 -i {0}/a.exr -pix_fmt rgb24 -y {0}/a.png", folder.string());
  ASSERT_EQ(std::system(command.c_str()), 0);
  const RgbImage back = read_png(folder / "a.png");
  ASSERT_EQ(back.width, 16);
  ASSERT_EQ(back.height, 8);
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 16; ++x) {
      EXPECT_EQ(back.at(x, y)[0], 255);
      EXPECT_NEAR(back.at(x, y)[1], 255 * std::pow(0.5, 1 / 2.2), 1.5);
      EXPECT_EQ(back.at(x, y)[2], 0);
    }
}

TEST(Exr, DamagedFilesAreNamed) {
  const fs::path folder = test::fresh_folder();
  const auto read = [](const fs::path& file) { read_exr(file); };
  const auto error = test::refusal_of(folder, "bad.exr", read);
  write_exr(folder / "a.exr", exr_ramps(40, 50, false));
  const std::string whole = read_file(folder / "a.exr");
  test::expect_no_picture(folder, "exr", read);
  EXPECT_THAT(error("\x89PNG\r\n not this"), HasSubstr("bad.exr: not an OpenEXR picture"));
  test::expect_damage_is_named(folder, "exr", read, whole, {4, 9, 20, 200, 400, whole.size() - 30}, whole.size() - 500);
  // The window of data: left, top, right and bottom, after its name, type and size.
  std::string huge = whole;
  const std::size_t window = huge.find("dataWindow") + sizeof "dataWindow" + sizeof "box2i" + 4;
  huge.replace(window + 8, 8, std::string("\xff\xff\xff\x00\xff\xff\xff\x00", 8));
  EXPECT_THAT(error(huge), HasSubstr("bad.exr"));
}

// Whatever a byte of the header becomes, reading succeeds or names the file.
TEST(Exr, AnyByteOfTheHeaderMayBeWrong) {
  const fs::path folder = test::fresh_folder();
  write_exr(folder / "a.exr", exr_ramps(4, 3, true));
  const std::string whole = read_file(folder / "a.exr");
  int refused = 0;
  for (std::size_t at = 4; at < whole.size(); ++at)
    for (const int bit : {1, 64, 128}) {
      std::string bytes = whole;
      bytes[at] = static_cast<char>(bytes[at] ^ bit);
      try {
        decode_exr(bytes, "bad.exr");
      } catch (const InputError& e) {
        EXPECT_THAT(e.what(), HasSubstr("bad.exr"));
        ++refused;
      }
    }
  EXPECT_GT(refused, 300);
}

TEST(Exr, WrongSizesAndAFullDisk) {
  const fs::path folder = test::fresh_folder(), file = folder / "a.exr";
  const auto error = [&](const ExrPicture& p) { return message_of<InputError>([&] { write_exr(file, p); }); };
  ExrPicture picture = exr_ramps(64, 64, false);
  picture.channels[1].values.pop_back();
  EXPECT_THAT(error(picture), HasSubstr("channel G has 4095 values for 64 x 64 pixels"));
  picture = exr_ramps(64, 64, false);
  picture.channels[1].name = "R";
  EXPECT_THAT(error(picture), HasSubstr("'R' is no name"));
  EXPECT_THAT(error(ExrPicture()), HasSubstr("0 channels"));
  const test::FileSizeLimit small(1000);
  EXPECT_THAT(message_of<RunError>([&] { write_exr(file, exr_ramps(64, 64, false)); }), HasSubstr("File too large"));
  EXPECT_EQ(test::files_in(folder), 0u);
}

}  // namespace
}  // namespace dreampm

#include "dreampm/video/contact_sheet.h"

#include <gmock/gmock.h>

#include "dreampm/base/error.h"
#include "pictures.h"

namespace dreampm {
namespace {
namespace fs = std::filesystem;
using test::plain;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

TEST(ContactSheet, FramesAreSpreadFromFirstToLast) {
  EXPECT_THAT(spread_evenly(120, 4), ElementsAre(0, 40, 79, 119));
  EXPECT_THAT(spread_evenly(3, 12), ElementsAre(0, 1, 2));
  EXPECT_THAT(spread_evenly(9, 1), ElementsAre(0));
  EXPECT_THAT(spread_evenly(0, 4), ElementsAre());
  for (std::size_t total = 2; total < 60; ++total)
    for (std::size_t count = 2; count <= total; ++count) {
      const auto chosen = spread_evenly(total, count);
      ASSERT_EQ(chosen.front(), 0u);
      ASSERT_EQ(chosen.back(), total - 1);
      for (std::size_t i = 1; i < chosen.size(); ++i) ASSERT_GT(chosen[i], chosen[i - 1]);
    }
}

TEST(ContactSheet, ShrinkAveragesLight) {
  // Black and white stripes of one pixel are half the light: sRGB 188, not 128.
  RgbImage stripes = plain(64, 32, 0, 0, 0);
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 64; x += 2)
      for (int c = 0; c < 3; ++c) stripes.at(x, y)[c] = 255;
  const RgbImage small = shrink(stripes, 16);
  EXPECT_EQ(small.width, 16);
  EXPECT_EQ(small.height, 8);
  for (const std::uint8_t v : small.pixels) EXPECT_EQ(v, 188);
  // A width that does not divide: a plain color stays what it is.
  const RgbImage odd = shrink(plain(100, 70, 200, 10, 77), 33);
  EXPECT_EQ(odd.width, 33);
  EXPECT_EQ(odd.height, 23);
  for (int x = 0; x < 33; ++x)
    EXPECT_THAT(std::vector<int>(odd.at(x, 11), odd.at(x, 11) + 3), ElementsAre(200, 10, 77));
  EXPECT_EQ(shrink(stripes, 640).pixels, stripes.pixels);
}

TEST(ContactSheet, TallPicturesAreMadeSmallEnoughForAFile) {
  const fs::path folder = test::fresh_folder();
  std::vector<fs::path> pictures;
  for (int i = 0; i < 12; ++i) {
    pictures.push_back(folder / (std::to_string(i) + ".png"));
    write_png(pictures.back(), plain(16, 8000, 10, 20, 30));
  }
  write_contact_sheet(pictures, folder / "sheet.png");
  const RgbImage sheet = read_png(folder / "sheet.png");
  EXPECT_LE(sheet.height, widest_png);
  EXPECT_GT(sheet.height, widest_png / 2);
}

TEST(ContactSheet, TilesStandInOrder) {
  const fs::path folder = test::fresh_folder();
  std::vector<fs::path> files;
  for (int i = 0; i < 7; ++i) {
    files.push_back(test::numbered(folder, i + 1));
    write_png(files.back(), plain(32, 16, static_cast<std::uint8_t>(100 + 10 * i), 0, 0));
  }
  write_contact_sheet(files, folder / "sheet.png", {.count = 7, .columns = 3, .tile_width = 16, .gap = 2});
  const RgbImage sheet = read_png(folder / "sheet.png");
  EXPECT_EQ(sheet.width, 2 + 3 * (16 + 2));
  EXPECT_EQ(sheet.height, 2 + 3 * (8 + 2));
  for (int i = 0; i < 7; ++i) EXPECT_EQ(sheet.at(2 + (i % 3) * 18 + 8, 2 + (i / 3) * 10 + 4)[0], 100 + 10 * i);
  EXPECT_EQ(sheet.at(0, 0)[0], 24);
  EXPECT_EQ(sheet.at(2 + 18 + 8, 2 + 2 * 10 + 4)[0], 24);  // the eighth tile is empty
}

TEST(ContactSheet, BadInputIsNamed) {
  const fs::path folder = test::fresh_folder();
  write_png(folder / "a.png", plain(32, 16, 1, 1, 1));
  write_png(folder / "b.png", plain(32, 18, 1, 1, 1));
  const auto sheet = [&](const std::vector<fs::path>& files, const ContactSheetSettings& s = {}) {
    return test::message_of<InputError>([&] { write_contact_sheet(files, folder / "sheet.png", s); });
  };
  EXPECT_THAT(sheet({folder / "a.png", folder / "b.png"}), AllOf(HasSubstr("b.png: 32 x 18"), HasSubstr("32 x 16")));
  EXPECT_THAT(sheet({folder / "a.png", folder / "absent.png"}), HasSubstr("absent.png"));
  EXPECT_THAT(sheet({}), HasSubstr("no pictures"));
  EXPECT_THAT(sheet({folder / "a.png"}, {.count = 0}), HasSubstr("0 frames"));
  EXPECT_FALSE(fs::exists(folder / "sheet.png"));
}

}  // namespace
}  // namespace dreampm

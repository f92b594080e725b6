#include "dreampm/io/png.h"

#include <png.h>

#include "files.h"

namespace dreampm {
namespace {
namespace fs = std::filesystem;
using test::message_of;
using testing::AllOf;
using testing::HasSubstr;

RgbImage noise(int width, int height) {
  RgbImage image(width, height);
  std::uint32_t seed = 5;
  for (std::uint8_t& v : image.pixels) v = static_cast<std::uint8_t>((seed = seed * 1664525u + 1013904223u) >> 24);
  return image;
}

TEST(Png, PixelsComeBack) {
  const fs::path folder = test::fresh_folder();
  for (const auto& [w, h] : {std::pair{1, 1}, {7, 3}, {64, 48}}) {
    const RgbImage image = noise(w, h);
    write_png(folder / "a.png", image);
    const RgbImage back = read_png(folder / "a.png");
    EXPECT_EQ(back.width, w);
    EXPECT_EQ(back.height, h);
    EXPECT_EQ(back.pixels, image.pixels);
  }
}

TEST(Png, OtherKindsBecomeRgb) {
  const fs::path file = test::fresh_folder() / "a.png";
  const auto write = [&](png_uint_32 format, const void* pixels) {
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    image.width = 2;
    image.height = 1;
    image.format = format;
    ASSERT_TRUE(png_image_write_to_file(&image, file.c_str(), 0, pixels, 0, nullptr));
  };
  const std::uint8_t gray[] = {0, 200};
  write(PNG_FORMAT_GRAY, gray);
  EXPECT_EQ(read_png(file).pixels, (std::vector<std::uint8_t>{0, 0, 0, 200, 200, 200}));
  const std::uint8_t rgba[] = {10, 20, 30, 255, 10, 20, 30, 0};
  write(PNG_FORMAT_RGBA, rgba);
  EXPECT_EQ(read_png(file).pixels, (std::vector<std::uint8_t>{10, 20, 30, 0, 0, 0}));
}

TEST(Png, DamagedFilesAreNamed) {
  const fs::path folder = test::fresh_folder();
  const auto read = [](const fs::path& file) { read_png(file); };
  const auto error = test::refusal_of(folder, "bad.png", read);
  write_png(folder / "a.png", noise(40, 30));
  const std::string whole = read_file(folder / "a.png");
  test::expect_no_picture(folder, "png", read);
  EXPECT_THAT(error("not a picture at all"), HasSubstr("not a PNG picture"));
  test::expect_damage_is_named(folder, "png", read, whole, {9, 20, 40, 200, 1000, whole.size() - 30}, whole.size() / 2);
  // Width and height of two thousand million, with the checksum of that header.
  std::string huge = whole;
  huge.replace(16, 8, "\x00\x0f\x42\x40\x00\x0f\x42\x40", 8);
  const auto crc = static_cast<std::uint32_t>([&] {
    std::uint32_t c = 0xffffffffu;
    for (std::size_t i = 12; i < 29; ++i) {
      c ^= static_cast<unsigned char>(huge[i]);
      for (int k = 0; k < 8; ++k) c = c & 1 ? 0xedb88320u ^ (c >> 1) : c >> 1;
    }
    return ~c;
  }());
  for (int k = 0; k < 4; ++k) huge[static_cast<std::size_t>(29 + k)] = static_cast<char>(crc >> (24 - 8 * k));
  EXPECT_THAT(error(huge), HasSubstr("1000000"));
}

TEST(Png, WrongSizesAndAFullDisk) {
  const fs::path folder = test::fresh_folder();
  RgbImage image = noise(64, 64);
  image.pixels.pop_back();
  EXPECT_THAT(message_of<InputError>([&] { write_png(folder / "a.png", image); }),
              HasSubstr("64 x 64 pixels with 12287"));
  EXPECT_THROW(write_png(folder / "a.png", RgbImage()), InputError);
  const test::FileSizeLimit small(1000);
  EXPECT_THAT(message_of<RunError>([&] { write_png(folder / "a.png", noise(64, 64)); }), HasSubstr("File too large"));
  EXPECT_EQ(test::files_in(folder), 0u);
}

}  // namespace
}  // namespace dreampm

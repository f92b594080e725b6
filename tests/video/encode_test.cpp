#include "dreampm/video/encode.h"

#include <gmock/gmock.h>
#include <sys/resource.h>

#include <csignal>
#include <cstdlib>
#include <fstream>

#include "decoded.h"
#include "dreampm/base/error.h"
#include "dreampm/base/file.h"
#include "pictures.h"

namespace dreampm {
namespace {
namespace fs = std::filesystem;
using test::decode;
using test::Decoded;
using test::message_of;
using test::numbered;
using test::plain;
using testing::AllOf;
using testing::HasSubstr;

/// By FFmpeg's libraries, and by the program.
class Encode : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override { ::setenv("DREAMPM_FFMPEG", GetParam(), 1); }
  void TearDown() override { ::unsetenv("DREAMPM_FFMPEG"); }
};
INSTANTIATE_TEST_SUITE_P(By, Encode, testing::Values("", "ffmpeg"),
                         [](const auto& by) { return *by.param ? "Program" : "Libraries"; });

std::vector<fs::path> write_series(const fs::path& folder, int count, int width = 64, int height = 48) {
  std::vector<fs::path> files;
  for (int i = 0; i < count; ++i) {
    files.push_back(numbered(folder, i + 1));
    RgbImage image = plain(width, height, 40, 90, static_cast<std::uint8_t>(100 + i % 100));
    image.at(i % width, i % height)[0] = 255;
    write_png(files.back(), image);
  }
  return files;
}

TEST_P(Encode, PicturesThatComeOneByOneMakeTheSameFilm) {
  const fs::path folder = test::fresh_folder();
  int count = 0;
  encode_pictures(
      [&]() -> std::optional<RgbImage> {
        if (++count > 30) return std::nullopt;
        return plain(64, 48, 40, 90, static_cast<std::uint8_t>(100 + count));
      },
      folder / "film.mp4", {.fps = 30, .quality = 18, .quick = true});
  const Decoded d = decode(folder / "film.mp4");
  EXPECT_EQ(d.frames.size(), 30U);
  EXPECT_DOUBLE_EQ(d.container_seconds, 1.0);
  EXPECT_THAT(
      message_of<InputError>([&] { encode_pictures([] { return std::optional<RgbImage>(); }, folder / "none.mp4"); }),
      HasSubstr("no pictures"));
  EXPECT_THAT(message_of<InputError>(
                  [&] { encode_pictures([&] { return std::optional(plain(63, 48, 1, 2, 3)); }, folder / "odd.mp4"); }),
              HasSubstr("even"));
  int width = 64;
  EXPECT_THAT(message_of<InputError>([&] {
                encode_pictures([&] { return std::optional(plain(width += 2, 48, 1, 2, 3)); }, folder / "wide.mp4");
              }),
              HasSubstr("68 x 48"));
  EXPECT_FALSE(fs::exists(folder / "wide.mp4"));
}

TEST_P(Encode, A120FrameFilmAt24LastsFiveSeconds) {
  const fs::path folder = test::fresh_folder(), film = folder / "film.mp4";
  std::size_t last = 0;
  encode_video(write_series(folder, 120), film, {24, 18}, [&](std::size_t done) { last = done; });
  EXPECT_EQ(last, 120u);
  const Decoded d = decode(film);
  EXPECT_DOUBLE_EQ(d.container_seconds, 5.0);
  EXPECT_DOUBLE_EQ(d.stream_seconds, 5.0);
  EXPECT_DOUBLE_EQ(d.frames_a_second, 24.0);
  EXPECT_EQ(d.frames.size(), 120u);
  EXPECT_EQ(d.codec, "h264");
  EXPECT_EQ(d.pixels, "yuv420p");
  EXPECT_EQ(d.space, AVCOL_SPC_BT709);
  EXPECT_EQ(d.range, AVCOL_RANGE_MPEG);
  for (std::size_t i = 1; i < d.times.size(); ++i) ASSERT_EQ(d.times[i] - d.times[i - 1], d.times[1] - d.times[0]);
  EXPECT_FALSE(fs::exists(folder / "film.mp4.part"));
}

TEST_P(Encode, TheIndexComesBeforeThePictures) {
  const fs::path folder = test::fresh_folder(), film = folder / "film.mp4";
  encode_video(write_series(folder, 5), film);
  const std::string bytes = read_file(film);
  ASSERT_NE(bytes.find("moov"), std::string::npos);
  EXPECT_LT(bytes.find("moov"), bytes.find("mdat"));
}

TEST_P(Encode, ColorsComeBackClose) {
  const fs::path folder = test::fresh_folder();
  const std::uint8_t colors[][3] = {{255, 255, 255}, {0, 0, 0},       {200, 30, 30}, {30, 180, 40},
                                    {20, 60, 200},   {128, 128, 128}, {90, 160, 190}};
  std::vector<fs::path> files;
  for (const auto& c : colors) {
    files.push_back(numbered(folder, static_cast<int>(files.size()) + 1));
    write_png(files.back(), plain(64, 48, c[0], c[1], c[2]));
  }
  encode_video(files, folder / "film.mp4", {24, 10});
  const Decoded d = decode(folder / "film.mp4");
  ASSERT_EQ(d.frames.size(), std::size(colors));
  for (std::size_t i = 0; i < d.frames.size(); ++i)
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(d.frames[i].at(32, 24)[c], colors[i][c], 4) << "frame " << i;
}

TEST_P(Encode, FramesKeepTheirOrderAndRate) {
  const fs::path folder = test::fresh_folder();
  std::vector<fs::path> files;
  for (int i = 0; i < 30; ++i) {
    files.push_back(numbered(folder, i + 1));
    const auto gray = static_cast<std::uint8_t>(20 + 7 * i);
    write_png(files.back(), plain(32, 32, gray, gray, gray));
  }
  encode_video(files, folder / "film.mp4", {60, 12});
  const Decoded d = decode(folder / "film.mp4");
  EXPECT_DOUBLE_EQ(d.container_seconds, 0.5);
  ASSERT_EQ(d.frames.size(), 30u);
  for (std::size_t i = 0; i < 30; ++i) EXPECT_NEAR(d.frames[i].at(16, 16)[1], 20 + 7 * static_cast<int>(i), 3);
}

TEST_P(Encode, ARateNeedNotBeWhole) {
  const fs::path folder = test::fresh_folder();
  std::vector<fs::path> files;
  for (int i = 0; i < 3; ++i) write_png(files.emplace_back(numbered(folder, i + 1)), plain(32, 32, 90, 90, 90));
  encode_video(files, folder / "slow.mp4", {0.5, 20});
  EXPECT_DOUBLE_EQ(decode(folder / "slow.mp4").container_seconds, 6);
  encode_video(files, folder / "film.mp4", {23.976, 20});
  const Decoded d = decode(folder / "film.mp4");
  EXPECT_NEAR(d.frames_a_second, 23.976, 1e-3);
  EXPECT_EQ(d.frames.size(), 3u);
}

TEST_P(Encode, TheSamePicturesGiveTheSameBytes) {
  const fs::path folder = test::fresh_folder();
  const auto files = write_series(folder, 20);
  encode_video(files, folder / "a.mp4");
  encode_video(files, folder / "b.mp4");
  EXPECT_EQ(read_file(folder / "a.mp4"), read_file(folder / "b.mp4"));
}

TEST_P(Encode, BadPicturesAreNamedAndLeaveNoFile) {
  const fs::path folder = test::fresh_folder(), film = folder / "film.mp4";
  const auto good = write_series(folder, 4);
  const auto error = [&](const std::vector<fs::path>& files, const VideoSettings& settings = {}) {
    const std::string text = message_of<InputError>([&] { encode_video(files, film, settings); });
    EXPECT_FALSE(fs::exists(film));
    EXPECT_FALSE(fs::exists(folder / "film.mp4.part"));
    return text;
  };
  auto files = good;
  files[2] = folder / "absent.png";
  EXPECT_THAT(error(files), AllOf(HasSubstr("absent.png"), HasSubstr("No such file")));

  const std::string whole = read_file(good[1]);
  files[2] = folder / "half.png";
  replace_file_text(files[2], whole.substr(0, whole.size() / 2));
  EXPECT_THAT(error(files), AllOf(HasSubstr("half.png"), HasSubstr("damaged")));

  files[2] = folder / "wide.png";
  write_png(files[2], plain(66, 48, 1, 2, 3));
  EXPECT_THAT(error(files), AllOf(HasSubstr("wide.png: 66 x 48"), HasSubstr("64 x 48")));

  write_png(folder / "odd.png", plain(63, 48, 1, 2, 3));
  EXPECT_THAT(error({folder / "odd.png"}), AllOf(HasSubstr("odd.png: 63 x 48"), HasSubstr("even")));
  EXPECT_THAT(error({}), HasSubstr("no pictures"));
  EXPECT_THAT(error(good, {0, 18}), HasSubstr("0 frames a second"));
  EXPECT_THAT(error(good, {24, 60}), HasSubstr("quality 60"));
}

TEST_P(Encode, AFailedFilmLeavesTheOldOne) {
  const fs::path folder = test::fresh_folder(), film = folder / "film.mp4";
  auto files = write_series(folder, 4);
  encode_video(files, film);
  const std::string before = read_file(film);
  files.push_back(folder / "absent.png");
  EXPECT_THROW(encode_video(files, film), InputError);
  EXPECT_EQ(read_file(film), before);
}

TEST_P(Encode, AFullDiskIsAnErrorWithItsReason) {
  const fs::path folder = test::fresh_folder(), film = folder / "film.mp4";
  // Noise does not compress: the film is far larger than the limit.
  std::vector<fs::path> files;
  std::uint32_t seed = 1;
  for (int i = 0; i < 10; ++i) {
    RgbImage image(128, 96);
    for (std::uint8_t& v : image.pixels) v = static_cast<std::uint8_t>((seed = seed * 1664525u + 1013904223u) >> 24);
    files.push_back(numbered(folder, i + 1));
    write_png(files.back(), image);
  }
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  rlimit small = before;
  small.rlim_cur = 20000;
  setrlimit(RLIMIT_FSIZE, &small);
  const std::string text = message_of<RunError>([&] { encode_video(files, film); });
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  EXPECT_THAT(text, AllOf(HasSubstr("film.mp4"), HasSubstr("File too large")));
  EXPECT_FALSE(fs::exists(film));
  EXPECT_FALSE(fs::exists(folder / "film.mp4.part"));
}

TEST_P(Encode, AFolderThatIsNotThereIsAnError) {
  const fs::path folder = test::fresh_folder();
  const auto files = write_series(folder, 2);
  EXPECT_THAT(message_of<RunError>([&] { encode_video(files, folder / "none" / "film.mp4"); }),
              AllOf(HasSubstr("film.mp4"), HasSubstr("No such file")));
}

/// A program that stands in for ffmpeg: a script of the shell.
fs::path script(const fs::path& folder, const std::string& body) {
  const fs::path file = folder / "fake";
  replace_file_text(file, "#!/bin/sh\n" + body + "\n");
  fs::permissions(file, fs::perms::owner_exec, fs::perm_options::add);
  return file;
}

TEST(EncodeProgram, WhatItSaysOfItsFailureIsTheReason) {
  const fs::path folder = test::fresh_folder(), film = folder / "film.mp4";
  // Larger than a socket holds: the program is gone before it has all of them.
  const auto files = write_series(folder, 20, 256, 256);
  ::setenv("DREAMPM_FFMPEG", script(folder, "echo Unknown encoder >&2; exit 1").c_str(), 1);
  EXPECT_NO_THROW(check_encoder());
  EXPECT_THAT(message_of<RunError>([&] { encode_video(files, film); }),
              AllOf(HasSubstr("film.mp4"), HasSubstr("fake: Unknown encoder")));
  ::setenv("DREAMPM_FFMPEG", script(folder, "cat >/dev/null; kill -9 $$").c_str(), 1);
  EXPECT_THAT(message_of<RunError>([&] { encode_video(files, film); }), HasSubstr("fake: it was killed"));
  EXPECT_FALSE(fs::exists(film));
  ::setenv("DREAMPM_FFMPEG", (folder / "absent").c_str(), 1);
  EXPECT_THAT(message_of<RunError>([] { check_encoder(); }), HasSubstr("absent: no such program"));
  ::unsetenv("DREAMPM_FFMPEG");
  EXPECT_NO_THROW(check_encoder());
}

}  // namespace
}  // namespace dreampm

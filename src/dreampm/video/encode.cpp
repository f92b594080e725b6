#include "dreampm/video/encode.h"

#include "dreampm/base/error.h"
#include "dreampm/base/file.h"
#include "dreampm/base/interrupt.h"
#include "dreampm/io/png.h"
#include "dreampm/video/encoder.h"

namespace dreampm {
namespace fs = std::filesystem;
namespace {

void check_settings(const std::string& name, const VideoSettings& settings) {
  if (!(settings.fps >= 0.001 && settings.fps <= 10000))
    fail_input("{}: {} frames a second; 0.001 to 10000 work", name, settings.fps);
  if (settings.quality < 0 || settings.quality > 51)
    fail_input("{}: quality {}; 0 (lossless) to 51 (worst) work", name, settings.quality);
}

}  // namespace

void encode_pictures(const std::function<std::optional<RgbImage>()>& next, const fs::path& file,
                     const VideoSettings& settings) {
  const std::string name = file.string();
  check_settings(name, settings);
  replace_file(file, [&](const fs::path& temporary) {
    std::optional<RgbImage> picture = next();
    if (!picture) fail_input("{}: no pictures to make a video of", name);
    const int width = picture->width, height = picture->height;
    if (width % 2 || height % 2)
      fail_input("{}: pictures of {} x {} pixels; a yuv420p video needs an even width and height", name, width, height);
    const std::unique_ptr<Encoder> encoder = open_encoder({temporary, file, width, height, settings});
    for (; picture; picture = next()) {
      if (picture->width != width || picture->height != height)
        fail_input("{}: a picture has {} x {} pixels, but the first {} x {}", name, picture->width, picture->height,
                   width, height);
      encoder->add(*picture);
    }
    encoder->finish();
  });
}

void encode_video(const std::vector<fs::path>& pictures, const fs::path& file, const VideoSettings& settings,
                  const std::function<void(std::size_t)>& progress) {
  const std::string name = file.string();
  if (pictures.empty()) fail_input("{}: no pictures to make a video of", name);
  check_settings(name, settings);
  replace_file(file, [&](const fs::path& temporary) {
    RgbImage picture = read_png(pictures.front());
    const int width = picture.width, height = picture.height;
    if (width % 2 || height % 2)
      fail_input("{}: {} x {} pixels; a yuv420p video needs an even width and height", pictures.front().string(), width,
                 height);
    const std::unique_ptr<Encoder> encoder = open_encoder({temporary, file, width, height, settings});
    for (std::size_t i = 0; i < pictures.size(); ++i) {
      if (interrupted()) throw Interrupted(fmt::format("{}: stopped, no video written", name));
      if (i > 0) picture = read_png(pictures[i]);
      if (picture.width != width || picture.height != height)
        fail_input("{}: {} x {} pixels, but {} has {} x {}", pictures[i].string(), picture.width, picture.height,
                   pictures.front().string(), width, height);
      encoder->add(picture);
      if (progress) progress(i + 1);
    }
    encoder->finish();
  });
}

}  // namespace dreampm

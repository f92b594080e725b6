// Pictures to an H.264 film in an mp4 file.
#pragma once
#include <filesystem>
#include <functional>
#include <optional>
#include <vector>

#include "dreampm/image.h"

namespace dreampm {

struct VideoSettings {
  double fps = 24;     ///< above 0, up to 10000; need not be whole
  int quality = 18;    ///< x264's crf: 0 lossless .. 51 worst
  bool quick = false;  ///< for pictures that come while somebody waits: a larger file
};

/// Throws RunError with the remedy where no film can be encoded here: this build leaves it to the
/// program ffmpeg, and there is none. For what would else fail at the end of a long run.
void check_encoder();

/// Encodes the pictures in order, each shown for exactly 1/fps s: libx264, yuv420p, BT.709 limited
/// range, index first (plays while it loads). Width and height must be even and the same in all.
/// `progress` gets the number that is done. The file is written through replace_file. Throws
/// InputError naming the picture that is missing, damaged or of another size, RunError if encoding
/// or writing fails, Interrupted on a signal (no file is left).
void encode_video(const std::vector<std::filesystem::path>& pictures, const std::filesystem::path& file,
                  const VideoSettings& settings = {}, const std::function<void(std::size_t done)>& progress = {});

/// The same for pictures that come one after another: `next` gives each, and nothing after the
/// last. Throws InputError where there was none and where one is of another size than the first.
void encode_pictures(const std::function<std::optional<RgbImage>()>& next, const std::filesystem::path& file,
                     const VideoSettings& settings = {});

}  // namespace dreampm

// Who encodes a film: FFmpeg's libraries where this build has them, or else the program ffmpeg.
// With all that they need the libraries take more room than DreaMPM does.
#pragma once
#include <filesystem>
#include <memory>

#include "dreampm/video/encode.h"

namespace dreampm {

/// A film while it is written.
class Encoder {
 public:
  virtual ~Encoder() = default;
  virtual void add(const RgbImage& picture) = 0;
  /// Must be called after the last picture. Without it the file is not whole.
  virtual void finish() = 0;
};

struct FilmFile {
  std::filesystem::path temporary, target;  ///< what is written, and what messages name
  int width = 0, height = 0;
  VideoSettings settings;
};

/// The program that DREAMPM_FFMPEG names; without it the libraries, or `ffmpeg` on the PATH.
std::unique_ptr<Encoder> open_encoder(const FilmFile& film);

std::unique_ptr<Encoder> open_libav_encoder(const FilmFile& film);
std::unique_ptr<Encoder> open_program_encoder(const std::filesystem::path& program, const FilmFile& film);

/// Pictures between two that stand alone: two seconds of film.
int group_size(double fps);

}  // namespace dreampm

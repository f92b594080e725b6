// OpenEXR pictures: numbers of any size a channel, by the OpenEXR library.
#pragma once
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "dreampm/math/vec.h"

namespace dreampm {

inline constexpr int widest_exr = 32768;  ///< pixels a side

/// Linear colors, row by row from the top.
struct Image {
  int width = 0, height = 0;
  std::vector<Vec3f> linear;
};

struct ExrChannel {
  std::string name;           ///< as in the file: "R", "Z", "normal.X"
  bool half = false;          ///< stored in 16 bits; else in 32
  std::vector<float> values;  ///< row by row from the top
};

struct ExrPicture {
  int width = 0, height = 0;  ///< of the part that there are values of
  int x = 0, y = 0;           ///< where that part begins in the whole frame, from the upper left
  int full_width = 0, full_height = 0;
  std::vector<ExrChannel> channels;
  std::map<std::string, std::string> notes;  ///< attributes that are text, by name

  /// Null if there is none.
  const ExrChannel* channel(std::string_view name) const;
};

/// Reads every channel of halves, floats or whole numbers of the first part. Throws InputError if
/// the file is missing, damaged, not an OpenEXR picture, deep, larger than 32768 pixels a side, or
/// has a channel of fewer pixels than the picture.
ExrPicture read_exr(const std::filesystem::path& file);
/// The same of the bytes of a file; `name` stands for it in messages.
ExrPicture decode_exr(std::string_view bytes, const std::string& name);

/// The channels R, G and B of a picture, the part of it that there are values of. Throws InputError
/// as read_exr does, where one of the three is missing, and where a value is not finite.
Image read_exr_colors(const std::filesystem::path& file);

/// Writes the channels by scan lines, compressed without loss (ZIP), whole or not at all. Throws
/// InputError if sizes do not agree or a name is taken twice, RunError if the file cannot be
/// written.
void write_exr(const std::filesystem::path& file, const ExrPicture& picture);

}  // namespace dreampm

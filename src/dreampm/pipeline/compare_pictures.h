// Two pictures beside each other, with what differs.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "dreampm/image.h"

namespace dreampm {

/// Of the channels of all pixels: of PNG files from 0 to 1 as shown, of OpenEXR files linear light.
struct PictureDifference {
  double rms = 0;   ///< root mean square
  double mean = 0;  ///< of the absolute values
  double most = 0;
  double share = 0;  ///< of the pixels that differ at all
};

struct Comparison {
  std::string name;             ///< "frame 60", or the files' names
  std::filesystem::path a, b;   ///< what was compared
  std::filesystem::path shown;  ///< a, b and their difference beside each other
  PictureDifference difference;
};

/// The difference of two pictures of one size: a, b and the absolute difference, `gain` times
/// brighter, from left to right.
RgbImage beside(const RgbImage& a, const RgbImage& b, double gain);

/// Compares two files of one kind (.png or .exr), or the pictures of the frames that two runs'
/// folders both have; of frames `first` to `last`, 0, 0: all. Writes OUT/compare_*.png. Throws
/// InputError for other files, sizes that differ, and runs without a picture in common.
std::vector<Comparison> compare_pictures(const std::filesystem::path& a, const std::filesystem::path& b,
                                         const std::filesystem::path& out, int first = 0, int last = 0);

}  // namespace dreampm

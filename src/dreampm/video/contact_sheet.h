// Many frames on one picture.
#pragma once
#include <filesystem>
#include <vector>

#include "dreampm/io/png.h"

namespace dreampm {

struct ContactSheetSettings {
  int count = 12;  ///< frames shown, spread evenly from the first to the last
  int columns = 4;
  int tile_width = 320;  ///< pixels; larger pictures are averaged down, smaller ones stay as they are
  int gap = 6;           ///< pixels between tiles and around them
};

/// The indices of `count` of `total` pictures, first and last included.
std::vector<std::size_t> spread_evenly(std::size_t total, std::size_t count);

/// A picture averaged down in linear light to `width` pixels across, its proportions kept.
RgbImage shrink(const RgbImage& image, int width);

/// Writes the sheet. All pictures used must have the same size. Throws InputError naming the
/// picture.
void write_contact_sheet(const std::vector<std::filesystem::path>& pictures, const std::filesystem::path& file,
                         const ContactSheetSettings& settings = {});

}  // namespace dreampm

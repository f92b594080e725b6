// PNG pictures of 8 bits a channel: reading. Writing is public (dreampm/image.h).
#pragma once
#include <filesystem>
#include <string>
#include <string_view>

#include "dreampm/image.h"

namespace dreampm {

inline constexpr int widest_png = 16384;  ///< pixels a side

/// Reads any PNG as 8-bit RGB (gray and palettes expand, 16 bits round, alpha is laid over black).
/// Throws InputError if the file is missing, damaged or larger than 16384 pixels a side.
RgbImage read_png(const std::filesystem::path& file);
/// The same of the bytes of a file; `name` stands for it in messages.
RgbImage decode_png(std::string_view bytes, const std::string& name);

}  // namespace dreampm

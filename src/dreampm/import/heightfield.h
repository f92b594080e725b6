// Ground from a picture of its heights.
#pragma once
#include <filesystem>

#include "dreampm/geometry/model.h"

namespace dreampm {

inline constexpr int widest_heightfield = 2048;  ///< pixels a side

/// The ground under a picture's heights, closed: a vertex for each pixel, black at box.min.y, white
/// at box.max.y; columns go along x, rows along z from box.min.z on. It goes on below black by the
/// height of the box. Reads PNG of 1 to 16 bits a channel as it stands, without a gamma; of colors
/// the mean, alpha is ignored. Throws InputError, naming the file, if it is missing, damaged, less
/// than 2 or more than 2048 pixels a side.
Model heightfield_model(const std::filesystem::path& picture, const Box3d& box);

}  // namespace dreampm

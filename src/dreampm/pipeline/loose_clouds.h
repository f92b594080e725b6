// Checks of clouds that are no frames of a run.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "dreampm/math/vec.h"

namespace dreampm {

/// Throws InputError for a spacing that is no length above 0, and where there is none, naming the
/// one that the points of `file` have.
void check_spacing(const std::optional<double>& spacing, const std::vector<Vec3d>& points, const std::string& file);

/// Throws InputError where points lie so far apart that they cannot be wrapped (surface_reach),
/// naming the farthest.
void check_extent(const std::vector<Vec3d>& points, double spacing, const std::string& file);

}  // namespace dreampm

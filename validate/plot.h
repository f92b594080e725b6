// Plots as SVG: ours as lines, references as points.
#pragma once
#include <filesystem>
#include <string>

#include "validate/case.h"

namespace dreampm::validate {

/// The picture as text. Points that are not finite are left out.
std::string svg_of(const Plot& plot);
/// Writes FOLDER/NAME.svg, whole or not at all; returns its path. Throws RunError.
std::filesystem::path write_plot(const Plot& plot, const std::filesystem::path& folder);

}  // namespace dreampm::validate

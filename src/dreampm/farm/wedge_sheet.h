// The contact sheet of a wedge: pictures of all runs, with what was measured written beside them.
#pragma once
#include <filesystem>
#include <vector>

#include "dreampm/farm/wedge_table.h"

namespace dreampm::farm {

/// Writes the sheet. Up to twelve runs have a row each, with four frames from the first to the
/// last; of more, each has its last frame. A run without pictures has an empty place. Nothing is
/// written where no run has one: then false.
bool write_wedge_sheet(const Wedge& wedge, const std::vector<WedgeRow>& rows, const std::filesystem::path& folder,
                       const std::filesystem::path& file);

}  // namespace dreampm::farm

// Models known by name: asset:NAME.
#pragma once
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "dreampm/geometry/model.h"
#include "dreampm/import/asset_names.h"

namespace dreampm {

/// "asset:..." ?
bool is_asset(std::string_view name);
/// Returns the folder of fetched models: $DREAMPM_CACHE, else $XDG_CACHE_HOME/dreampm, else
/// ~/.cache/dreampm.
std::filesystem::path asset_folder();
/// True if the file of a fetched model is there; its content is not read.
bool is_fetched(std::string_view name);

/// A (2,3) torus knot as a closed tube of round section, made by code; about 3 units across, axis
/// Y.
TriMesh torus_knot();

/// The mesh of `name` (with "asset:"). Fetched ones are read from asset_folder() and their SHA-256
/// is checked. Throws InputError for an unknown name (lists them), a file that is not there (says
/// how to fetch it, and what works without) and one that is not the right file.
Model load_asset(std::string_view name);

}  // namespace dreampm

// The model files of a run, kept in its folder: what the run is does not change when they move, and
// needs no working folder.
#pragma once
#include <filesystem>

#include "dreampm/model/scene.h"

namespace dreampm {

/// The scene as it stands in a run's folder: models/HASH/NAME in place of every model file, HASH of
/// its bytes. Assets keep their names. Throws InputError for a file that cannot be read.
model::Scene with_kept_models(const model::Scene& scene);

/// The scene with the names of with_kept_models as paths in the folder.
model::Scene located_in(model::Scene kept, const std::filesystem::path& folder);

/// Writes scene.yaml and the copies of its models into the folder, and removes copies that it does
/// not name. Throws RunError if they cannot be written.
void write_run_scene(const model::Scene& scene, const std::filesystem::path& folder);

/// Writes the scene as `file`, and copies of its models beside it, as models/HASH/NAME: the folder
/// may move to another machine. Copies of other scenes there stay.
void write_portable_scene(const model::Scene& scene, const std::filesystem::path& file);

}  // namespace dreampm

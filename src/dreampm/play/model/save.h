// Writes what a side of the playground holds as a scene that `dreampm make` runs.
#pragma once
#include <filesystem>
#include <optional>

#include "dreampm/play/model/action.h"
#include "dreampm/play/tools/tool.h"
#include "dreampm/simulation.h"
#include "dreampm/vec.h"

namespace dreampm::play {

/// How a scene is saved.
struct SavedAs {
  bool finer = false;             ///< at half the spacing, each particle as eight
  std::optional<double> seconds;  ///< that it lasts; absent: as long as the scene it came from
  /// From where it is seen; absent: from where that was.
  struct Seen {
    Vec3d from, to;  ///< m
    double fov;      ///< degrees
  };
  std::optional<Seen> seen;
};

/// Writes a scene file, and beside it the moment that it starts from. `gravity` [m/s^2] is what was
/// set, without what tools add. Throws InputError for a file that does not end in .yaml, or cannot
/// be written.
void save_scene(const std::filesystem::path& file, const SavedAs& as, const Simulation& simulation,
                const Vec3d& gravity, const ToolSet& tools);
/// What the words FILE SECONDS FROM TO FOV of the verbs `estimate` and `render` ask for. Throws
/// InputError.
SavedAs finer_scene(const Action& action);

}  // namespace dreampm::play

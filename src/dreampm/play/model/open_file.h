// What a file is to the playground, that somebody opens or drops into the window.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "dreampm/play/model/action.h"

namespace dreampm::play {

enum class FileKind {
  scene,   ///< a scene, or a config of the report
  mesh,    ///< a mesh, or a cloud of points
  record,  ///< of a window (--record), which is played again
  other
};
FileKind kind_of_file(const std::filesystem::path& file);
/// What opens it in place of what is played; throws InputError for what cannot be opened.
Action opening(const std::filesystem::path& file);
/// Those of a folder that can be opened, by their names.
std::vector<std::string> files_to_open(const std::filesystem::path& folder);

/// A scene in which that mesh falls as jelly.
std::string scene_of_mesh(const std::filesystem::path& file);

}  // namespace dreampm::play

// What can be played: a scene, and how it is shown.
#pragma once
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "dreampm/scene.h"
#include "dreampm/simulation.h"

namespace dreampm::play {

/// An index into size_names(): as a scene says.
inline constexpr std::size_t medium_size = 1;

/// What can be played: a scene, and how it is shown.
struct PlayScene {
  std::string name;
  Scene scene;
  /// Of the report: its Time Step sets the pace, and its materials begin anew where they change.
  bool report = false;
  double max_time_step = 4;  ///< 1e-4 s
  double max_hard = 4;
  std::string file{};                  ///< as load_play_scene takes it; of the report
  std::vector<std::string> presets{};  ///< of the report: their names, of which one is played
  std::size_t preset = 0;
  std::map<std::string, double> opacity{};  ///< by material, where it is not 1
  struct Window {
    int width, height;  ///< pixels
  };
  std::optional<Window> window{};  ///< that a config asks for, and the report
  std::size_t size = medium_size;  ///< index into size_names()
  std::optional<Scene> other{};    ///< the same by the other solver, of medium size, where its file has that
};

/// A scene that is played, and how it begins.
struct LoadedScene {
  PlayScene scene;
  Snapshot start;
};

/// How many particles a scene has: small, medium as its file says, large.
const std::vector<std::string>& size_names();
/// The scene with that many. Throws InputError for those that cannot be had otherwise: the report's
/// grid, and a scene that starts from a moment.
PlayScene resized(PlayScene scene, std::size_t size);
/// A story by its name (stories.h), or a scene file or the report's config file. `preset`: which of
/// the config's presets, from 0. Throws InputError.
PlayScene load_play_scene(const std::string& name_or_file, std::size_t preset = 0);

}  // namespace dreampm::play

// The playground without a display: plays a script, and draws what it comes to.
#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "dreampm/play/model/playground.h"

namespace dreampm::play {

struct HeadlessOptions {
  PlayOptions play;
  int frames = 60;               ///< drawn ones, after the script
  std::filesystem::path script;  ///< empty: none
  /// A file that ends in .png: one picture, of the last frame; else a folder for many; empty: none
  /// is drawn.
  std::filesystem::path screenshots;
  int every = 1;  ///< drawn frames from picture to picture, in a folder
  int width = 1280, height = 720;
  std::optional<float> ui_scale = {};  ///< of letters and panels; absent: as the size asks
  bool panels = true;                  ///< draws them too; else pictures are of the whole window
  /// Seed of actions by chance between the frames after the script, which open another scene now
  /// and then: for runs that look for what breaks.
  std::optional<std::uint64_t> random_actions;
};

/// Plays, writes pictures, and gives the hash of the world in the end. A script has a line for each
/// action, "steps N" for a tick of that many steps, and "frames N" for that many drawn frames.
/// Throws InputError that names file and line for what cannot be done; RunError where random
/// actions brought matter out of the box, or made it something that is not a number.
std::uint64_t play_headless(PlayScene scene, const HeadlessOptions& options);

}  // namespace dreampm::play

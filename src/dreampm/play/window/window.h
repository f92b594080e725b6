// The playground in a window.
#pragma once
#include <filesystem>
#include <optional>
#include <string>

#include "dreampm/play/model/playground.h"

namespace dreampm::play {

struct WindowOptions {
  PlayOptions play;
  int width = 1280, height = 720;
  std::optional<float> ui_scale = {};  ///< of letters and panels; absent: as the monitor and the window's size ask
  std::string particles;               ///< one of size_names(); empty: as many as the machine keeps up with
  std::filesystem::path record;        ///< a script of all that happened is written here; empty: none
  bool fits_screen = false;            ///< whether it is smaller where the screen has less room
};

/// Opens a window and plays until it is closed. Throws RunError where there is no display or no
/// OpenGL 3.3, saying how to play without.
void play_in_window(PlayScene scene, const WindowOptions& options);

}  // namespace dreampm::play

// A button with a picture above its name.
#pragma once
#include <imgui.h>

#include <string>

#include "dreampm/play/panels/pictures.h"

namespace dreampm::play {

struct PictureButton {
  std::string picture, title, key;
  ImVec2 size;
  float letters;  ///< height, of the font's
  bool chosen;
  bool off = false;
};

/// Whether it was pressed.
bool picture_button(const Pictures* pictures, const PictureButton& button, float scale);

}  // namespace dreampm::play

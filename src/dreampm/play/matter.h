// The kinds of matter that can be poured and dropped.
#pragma once
#include <span>
#include <string_view>

#include "dreampm/vec.h"

namespace dreampm::play {

struct Matter {
  std::string_view name;  ///< of the material in a scene
  std::string_view title;
  std::string_view scene;  ///< what stands behind its name in the `materials` of a scene file
  std::string_view look;   ///< what stands behind its name in `render.looks`
  char key;                ///< on the keyboard
};

/// Ten, in the order of their keys.
std::span<const Matter> matters();

}  // namespace dreampm::play

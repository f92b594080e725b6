// Scenes that are known to be right.
#pragma once
#include <string>

#include "dreampm/scene.h"

namespace dreampm {

/// The way of the library's own files to a Scene that is not checked once more.
struct SceneAccess {
  /// `checked`: by the parser, or by scene::check_scene, and complete.
  static Scene make(model::Scene checked, std::string file);
};

}  // namespace dreampm

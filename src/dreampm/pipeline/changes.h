// What differs between two resolved scenes, for people.
#pragma once
#include <string>
#include <vector>

namespace dreampm {

/// "render.samples: 4 -> 8", one a changed key of two texts by scene::write_scene.
std::vector<std::string> changed_keys(const std::string& before, const std::string& after);

}  // namespace dreampm

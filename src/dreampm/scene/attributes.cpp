#include "dreampm/scene/attributes.h"

#include <algorithm>

namespace dreampm::scene {

std::vector<std::string> kept_attributes(const model::Scene& scene) {
  std::vector<std::string> kept = scene.output.attributes;
  const auto add = [&](const char* name) {
    if (std::find(kept.begin(), kept.end(), name) == kept.end()) kept.emplace_back(name);
  };
  const auto& of_surface = scene.surface.attributes;
  for (const char* name : {"j", "age", "source"})
    if (std::find(of_surface.begin(), of_surface.end(), name) != of_surface.end()) add(name);
  if (std::any_of(scene.emitters.begin(), scene.emitters.end(), [](const auto& e) { return e.color.has_value(); }))
    add("source");
  return kept;
}

}  // namespace dreampm::scene

#include "dreampm/scene/nearest.h"

#include <fmt/format.h>

#include "dreampm/scene/emit.h"
#include "dreampm/scene/tree.h"

namespace dreampm::scene {

std::string unknown_name(const model::Scene& scene, const std::string& path) {
  Problems problems;
  const YamlNode root = read_yaml(write_scene(scene), "", problems);
  const YamlNode* map = &root;
  for (std::size_t from = 0, dot = path.find('.'); dot != std::string::npos; dot = path.find('.', from)) {
    const std::string name = path.substr(from, dot - from);
    const YamlNode* next = map->find(name);
    if (!next) {
      std::vector<std::string> names;
      for (const Entry& e : map->entries) names.push_back(e.key);
      return fmt::format("no '{}' in {}{}", name, from == 0 ? "the scene" : path.substr(0, from - 1),
                         suggest(name, names));
    }
    map = next;
    from = dot + 1;
  }
  return {};
}

}  // namespace dreampm::scene

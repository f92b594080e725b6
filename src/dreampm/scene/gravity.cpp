// gravity: one vector, or keys over time.
#include "dreampm/scene/keys.h"
#include "dreampm/scene/sections.h"

namespace dreampm::scene {

Field<SceneDescription> gravity() {
  Field<SceneDescription> f = vector("gravity", &SceneDescription::gravity);
  const Schema<Keys<Vec3d>> schema = keys_schema<Vec3d>(vector("value", &Key<Vec3d>::value));
  f.read = [plain = f.read, schema](Reading& in, const YamlNode& n, const std::string& path, SceneDescription& out) {
    if (!n.is_map()) return plain(in, n, path, out);
    Keys<Vec3d> k;
    read_map(in, n, path, schema, k);
    out.gravity_keys = std::move(k.list);
    if (!out.gravity_keys.empty()) out.gravity = out.gravity_keys.front().value;
  };
  f.write = [plain = f.write, schema](const SceneDescription& s, const std::string& k, YamlNode& map) {
    if (s.gravity_keys.empty()) return plain(s, k, map);
    map.put(k, write_map(Keys<Vec3d>{s.gravity_keys}, schema));
  };
  return f;
}

}  // namespace dreampm::scene

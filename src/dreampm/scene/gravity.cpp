// gravity: one vector, or keys over time.
#include "dreampm/scene/keys.h"
#include "dreampm/scene/sections.h"

namespace dreampm::scene {

Field<model::Scene> gravity() {
  constexpr const char* unit = "m/s^2";
  Field<model::Scene> f = vector("gravity", &model::Scene::gravity, any_number(unit))
                              .says("The acceleration of all matter, constant or by keys over time.");
  const Schema<Keys<Vec3d>> schema =
      keys_schema<Vec3d>(vector("value", &Key<Vec3d>::value, any_number(unit)).says("The acceleration at that time."));
  f.value = either({f.value, map_of(schema)});
  f.read = [plain = f.read, schema](Reading& in, const YamlNode& n, const std::string& path, model::Scene& out) {
    if (!n.is_map()) return plain(in, n, path, out);
    Keys<Vec3d> k;
    read_map(in, n, path, schema, k);
    out.gravity_keys = std::move(k.list);
    if (!out.gravity_keys.empty()) out.gravity = out.gravity_keys.front().value;
  };
  f.write = [plain = f.write, schema](const model::Scene& s, const std::string& k, YamlNode& map) {
    if (s.gravity_keys.empty()) return plain(s, k, map);
    map.put(k, write_map(Keys<Vec3d>{s.gravity_keys}, schema));
  };
  return f;
}

}  // namespace dreampm::scene

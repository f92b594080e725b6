// gravity: one vector, or keys over time.
#include "dreampm/scene/sections.h"

namespace dreampm::scene {
namespace {

const Schema<Key<Vec3d>>& key_schema() {
  static const Schema<Key<Vec3d>> schema{
      number("t", &Key<Vec3d>::t, at_least_zero("s")).must(),
      vector("value", &Key<Vec3d>::value).must(),
  };
  return schema;
}

struct Keys {
  std::vector<Key<Vec3d>> list;
};

Field<Keys> keys() {
  return Field<Keys>{"keys",
                     [](Reading& in, const YamlNode& n, const std::string& path, Keys& out) {
                       if (!expect_list(in.problems, n, path)) return;
                       if (n.items.empty())
                         in.problems.error(n.at, fmt::format("{} is empty: give at least one key", path));
                       for (std::size_t i = 0; i < n.items.size(); ++i) {
                         const std::string name = fmt::format("{}[{}]", path, i);
                         const int before = in.problems.errors();
                         Key<Vec3d> key;
                         read_map(in, n.items[i], name, key_schema(), key);
                         if (in.problems.errors() > before) continue;
                         if (!out.list.empty() && !(key.t > out.list.back().t))
                           in.problems.error(
                               n.items[i].find("t")->at,
                               fmt::format("{}.t is {}: keys must follow in time, the one before is at {} s", name,
                                           key.t, out.list.back().t));
                         out.list.push_back(key);
                       }
                     },
                     [](const Keys& k, const std::string& name, YamlNode& map) {
                       std::vector<YamlNode> items;
                       for (const Key<Vec3d>& key : k.list) items.push_back(write_map(key, key_schema()));
                       map.put(name, YamlNode::list(std::move(items)));
                     }}
      .must();
}

}  // namespace

Field<SceneDescription> gravity() {
  Field<SceneDescription> f = vector("gravity", &SceneDescription::gravity);
  const Schema<Keys> schema{keys()};
  f.read = [plain = f.read, schema](Reading& in, const YamlNode& n, const std::string& path, SceneDescription& out) {
    if (!n.is_map()) return plain(in, n, path, out);
    Keys k;
    read_map(in, n, path, schema, k);
    out.gravity_keys = std::move(k.list);
    if (!out.gravity_keys.empty()) out.gravity = out.gravity_keys.front().value;
  };
  f.write = [plain = f.write, schema](const SceneDescription& s, const std::string& k, YamlNode& map) {
    if (s.gravity_keys.empty()) return plain(s, k, map);
    map.put(k, write_map(Keys{s.gravity_keys}, schema));
  };
  return f;
}

}  // namespace dreampm::scene

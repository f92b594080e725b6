// keys: [{t, value}, ...]: what changes with time.
#pragma once
#include "dreampm/math/keyframes.h"
#include "dreampm/scene/fields.h"

namespace dreampm::scene {

template <class V>
struct Keys {
  std::vector<Key<V>> list;
};

/// `value`: the field of a key's value.
template <class V>
Schema<Keys<V>> keys_schema(Field<Key<V>> value) {
  const Schema<Key<V>> key{number("t", &Key<V>::t, at_least_zero("s")).must().says("The time of the key."),
                           std::move(value).must()};
  return {Field<Keys<V>>{
      "keys",
      [key](Reading& in, const YamlNode& n, const std::string& path, Keys<V>& out) {
        if (!expect_list(in.problems, n, path)) return;
        if (n.items.empty()) in.problems.error(n.at, fmt::format("{} is empty: give at least one key", path));
        for (std::size_t i = 0; i < n.items.size(); ++i) {
          const std::string name = fmt::format("{}[{}]", path, i);
          const int before = in.problems.errors();
          Key<V> one;
          read_map(in, n.items[i], name, key, one);
          if (in.problems.errors() > before) continue;
          if (!out.list.empty() && !(one.t > out.list.back().t))
            in.problems.error(n.items[i].find("t")->at,
                              fmt::format("{}.t is {}: keys must follow in time, the one before is at {} s", name,
                                          one.t, out.list.back().t));
          out.list.push_back(one);
        }
      },
      [key](const Keys<V>& k, const std::string& name, YamlNode& map) {
        std::vector<YamlNode> items;
        for (const Key<V>& one : k.list) items.push_back(write_map(one, key));
        map.put(name, YamlNode::list(std::move(items)));
      }}.must()
              .takes(list_info(map_of(key), 1))
              .says("Values by time, in rising order; between two keys it changes linearly.")};
}

}  // namespace dreampm::scene

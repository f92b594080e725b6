// The whole scene as one table.
#include "dreampm/scene/sections.h"

namespace dreampm::scene {
namespace {

using Scene = SceneDescription;

Field<Scene> space() {
  return Field<Scene>{
      "space",
      [](Reading& in, const YamlNode& n, const std::string& path, Scene& out) {
        const int before = in.problems.errors();
        read_map(in, n, path, space_schema(), out.space);
        if (in.problems.errors() == before) finish_space(in, n, out.space);
      },
      [](const Scene& s, const std::string& k, YamlNode& map) { map.put(k, write_map(s.space, space_schema())); }}
      .must();
}

Field<Scene> name() {
  Field<Scene> f = text("name", &Scene::name);
  f.read = [](Reading& in, const YamlNode& n, const std::string& path, Scene& out) {
    const auto v = read_text(in.problems, n, path);
    if (!v) return;
    out.name = *v;
    if (!good_name(*v))
      in.problems.error(n.at, fmt::format("{} is {}: must be {}", path, n.describe(), good_name_rule));
  };
  return std::move(f).must();
}

/// A list of named things.
Field<Scene> names(std::string key, void (*read)(Reading&, const YamlNode&, Scene&), YamlNode (*write)(const Scene&)) {
  return {std::move(key), [=](Reading& in, const YamlNode& n, const std::string&, Scene& out) { read(in, n, out); },
          [=](const Scene& s, const std::string& k, YamlNode& map) {
            YamlNode all = write(s);
            if (!all.entries.empty()) map.put(k, std::move(all));
          }};
}

Field<Scene> start() {
  Field<Scene> f = text("start", &Scene::start);
  f.read = [](Reading& in, const YamlNode& n, const std::string& path, Scene& out) {
    if (const auto name = read_text(in.problems, n, path)) out.start = find_file(in, n, path, *name);
  };
  return f;
}

Field<Scene> bodies() {
  Field<Scene> f = names(
      "bodies",
      [](Reading& in, const YamlNode& n, Scene& out) {
        read_bodies(in, n, out);
        if (!out.start.empty())
          in.problems.error(n.at, "bodies together with start: all matter is in the file that start names");
      },
      write_bodies);
  return std::move(f).unless([](const Scene& s) { return !s.emitters.empty() || !s.start.empty(); });
}

}  // namespace

const Schema<Scene>& scene_schema() {
  static const Schema<Scene> schema{
      name(),
      text("about", &Scene::about),
      count("seed", &Scene::seed, 0, std::numeric_limits<std::int64_t>::max()),
      space(),
      section("time", &Scene::time, time_schema()),
      gravity(),
      names("materials", read_materials, write_materials).must(),
      names("emitters", read_emitters, write_emitters),
      start(),
      bodies(),
      names("colliders", read_colliders, write_colliders),
      names("rigid", read_rigid, write_rigid),
      names("pins", read_pins, write_pins),
      names("sinks", read_sinks, write_sinks),
      names("fields", read_fields, write_fields),
      names("probes", read_probes, write_probes),
      section("output", &Scene::output, output_schema()),
      section("surface", &Scene::surface, surface_schema()),
      section("render", &Scene::render, render_schema()),
      section("video", &Scene::video, video_schema()),
  };
  return schema;
}

std::string unknown_key(const YamlNode& map, const Entry& key, const std::string& name,
                        const std::vector<std::string>& known) {
  const bool digits = key.key.find_first_not_of("0123456789") == std::string::npos;
  const auto at = static_cast<std::size_t>(&key - map.entries.data());
  if (digits && key.value.kind == YamlNode::Kind::null && at > 0 && at < map.entries.size())
    if (const Entry& before = map.entries[at - 1]; before.value.kind == YamlNode::Kind::scalar)
      return fmt::format("'{0}: {1},{2}' has a comma: write {1}.{2}", before.key, before.value.text, key.key);
  return fmt::format("unknown key '{}'{}", name, suggest(key.key, known));
}

void check_alternatives(Problems& problems, const YamlNode& map, std::string_view path,
                        const std::vector<std::string>& known) {
  const auto is_known = [&](std::string_view k) { return std::find(known.begin(), known.end(), k) != known.end(); };
  const auto last_of = [&](const std::vector<std::string_view>& keys) {
    std::ptrdiff_t found = -1;
    for (std::size_t i = 0; i < map.entries.size(); ++i)
      if (std::find(keys.begin(), keys.end(), map.entries[i].key) != keys.end()) found = std::ptrdiff_t(i);
    return found;
  };
  for (const Alternative& a : alternatives()) {
    if (!is_known(a.left.front()) || !is_known(a.right.front())) continue;
    const std::ptrdiff_t l = last_of(a.left), r = last_of(a.right);
    if (l < 0 || r < 0) continue;
    const Entry& later = map.entries[std::size_t(std::max(l, r))];
    const Entry& first = map.entries[std::size_t(std::min(l, r))];
    problems.error(later.at, fmt::format("{}.{} together with {}: give one of them", path, later.key, first.key));
  }
}

}  // namespace dreampm::scene

// The whole scene as one table.
#include <algorithm>
#include <cctype>

#include "dreampm/scene/parse.h"
#include "dreampm/scene/sections.h"

namespace dreampm::scene {
namespace {

using Scene = model::Scene;

Field<Scene> space() {
  return Field<Scene>{
      "space",
      [](Reading& in, const YamlNode& n, const std::string& path, Scene& out) {
        const int before = in.problems.errors();
        read_map(in, n, path, space_schema(), out.space);
        if (in.problems.errors() == before) finish_space(in, n, out.space);
      },
      [](const Scene& s, const std::string& k, YamlNode& map) { map.put(k, write_map(s.space, space_schema())); }}
      .must()
      .takes(map_of(space_schema()))
      .says("The box that matter moves in, and its resolution.");
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
  return std::move(f)
      .must()
      .takes(text_info("a name", good_name_pattern))
      .says("Names the run's folder and its video.");
}

/// A list of named things.
Field<Scene> names(std::string key, void (*read)(Reading&, const YamlNode&, Scene&), YamlNode (*write)(const Scene&),
                   ValueInfo info) {
  Field<Scene> f{std::move(key),
                 [=](Reading& in, const YamlNode& n, const std::string&, Scene& out) { read(in, n, out); },
                 [=](const Scene& s, const std::string& k, YamlNode& map) {
                   YamlNode all = write(s);
                   if (!all.entries.empty()) map.put(k, std::move(all));
                 }};
  f.value = std::move(info);
  f.has_default = false;
  return f;
}

Field<Scene> start() {
  Field<Scene> f = text("start", &Scene::start);
  f.read = [](Reading& in, const YamlNode& n, const std::string& path, Scene& out) {
    if (const auto name = read_text(in.problems, n, path)) out.start = find_file(in, n, path, *name);
  };
  return std::move(f).takes(text_info("a file")).says("The file of a moment to go on from, in place of bodies.");
}

Field<Scene> bodies() {
  Field<Scene> f = names(
      "bodies",
      [](Reading& in, const YamlNode& n, Scene& out) {
        read_bodies(in, n, out);
        if (!out.start.empty())
          in.problems.error(n.at, "bodies together with start: all matter is in the file that start names");
      },
      write_bodies, bodies_info());
  return std::move(f)
      .unless([](const Scene& s) { return !s.emitters.empty() || !s.start.empty(); }, "there are emitters or a start")
      .says("Matter that is there at the start.");
}

}  // namespace

const Schema<Scene>& scene_schema() {
  static const Schema<Scene> schema{
      name(),
      text("about", &Scene::about).says("A sentence about the scene; nothing reads it."),
      count("seed", &Scene::seed, 0, std::numeric_limits<std::int64_t>::max())
          .says("The seed of all random numbers, such as the offsets of particles."),
      space(),
      section("time", &Scene::time, time_schema()).says("How long the film is, and how long a step."),
      gravity(),
      names("materials", read_materials, write_materials, materials_info()).must().says("What matter is made of."),
      names("emitters", read_emitters, write_emitters, emitters_info()).says("Where matter comes in."),
      start(),
      bodies(),
      names("colliders", read_colliders, write_colliders, colliders_info())
          .says("Solid things that matter meets, at rest or in a given motion."),
      names("rigid", read_rigid, write_rigid, rigid_info())
          .says("Rigid bodies: matter pushes them, and they push matter and each other."),
      names("pins", read_pins, write_pins, pins_info())
          .says("Regions that hold the matter inside them at the start and move it; they are not drawn."),
      names("sinks", read_sinks, write_sinks, sinks_info()).says("Where matter is taken out."),
      names("fields", read_fields, write_fields, fields_info()).says("Forces that act on matter from afar."),
      names("probes", read_probes, write_probes, probes_info()).says("What is measured while the scene runs."),
      section("output", &Scene::output, output_schema()).says("What a run writes."),
      foam(),
      section("surface", &Scene::surface, surface_schema()).says("How a surface is wrapped around particles."),
      section("render", &Scene::render, render_schema()).says("How pictures are drawn."),
      section("video", &Scene::video, video_schema()).says("How the video is encoded."),
  };
  return schema;
}

MapInfo scene_info() {
  MapInfo info{keys_info(scene_schema())};
  KeyInfo version{
      "dreampm", {WholeInfo{1, format_version}}, "The version of the format; it must be the first key.", {}};
  version.required = true;
  info.keys.insert(info.keys.begin(), std::move(version));
  info.keys.push_back(
      {"variants",
       names_info({OverlayInfo{"keys of the scene", [] { return MapInfo{keys_info(scene_schema())}; }}}),
       "Other values for some keys, by the names of `--variant`.",
       {}});
  info.at_least_one = {"bodies", "emitters", "start"};
  return info;
}

std::string sentence(std::string_view help) {
  std::string text(help);
  if (text.empty()) return text;
  // Symbols stay as they are: nu, xi, k. These short words are none.
  constexpr std::string_view words[] = {"a", "an", "as", "at", "by", "go", "if", "in", "no", "of", "on", "or", "to"};
  const std::string_view first = help.substr(0, help.find_first_not_of("abcdefghijklmnopqrstuvwxyz"));
  if (first.size() > 2 || std::find(std::begin(words), std::end(words), first) != std::end(words))
    text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  if (text.back() != '.') text += '.';
  return text;
}

std::string unknown_key(const YamlNode& map, const Entry& key, const std::string& name,
                        const std::vector<std::string>& known) {
  const bool digits = key.key.find_first_not_of("0123456789") == std::string::npos;
  const auto at = static_cast<std::size_t>(&key - map.entries.data());
  if (digits && key.value.kind == YamlNode::Kind::null && at > 0 && at < map.entries.size())
    if (const Entry& before = map.entries[at - 1]; before.value.kind == YamlNode::Kind::scalar)
      return fmt::format("'{0}: {1},{2}' has a comma: write {1}.{2}", before.key, before.value.text, key.key);
  // PyYAML and others write a bare `on` where a dict has it, and read it back as a boolean.
  if (key.key == "true" && std::find(known.begin(), known.end(), "on") != known.end())
    return fmt::format("unknown key '{}': YAML 1.1 takes a bare `on` for true; put it in quotes: \"on\"", name);
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

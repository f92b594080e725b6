#include "dreampm/scene/check.h"

#include <filesystem>
#include <set>

#include "dreampm/base/error.h"
#include "dreampm/scene/sections.h"

namespace dreampm::scene {
namespace {

/// Reports members that mean nothing in a struct which is as this one: files cannot say them.
template <class T>
void check_unused(Reading& in, const std::string& path, const T& given, const Schema<T>& schema) {
  static const T fresh{};
  for (const Field<T>& f : schema) {
    if (f.foreign || !f.applies || f.applies(given)) continue;
    const auto& write = f.write_always ? f.write_always : f.write;
    YamlNode here = YamlNode::map(), usual = YamlNode::map();
    write(given, f.key, here), write(fresh, f.key, usual);
    if (write_yaml(here) != write_yaml(usual))
      in.problems.error({}, fmt::format("{}.{} is only for {}", path, f.key, f.only));
  }
}

void check_unused_motion(Reading& in, const std::string& path, const std::optional<Motion>& motion) {
  if (motion) check_unused(in, path + ".motion", *motion, motion_schema());
}

/// Rigid bodies and pins are colliders that have a part of their members.
void check_kind(Reading& in, const Collider& c) {
  const std::string path = (c.rigid ? "rigid." : "pins.") + c.name;
  const auto refuse = [&](bool has, const char* what) {
    if (has) in.problems.error({}, fmt::format("{}.{} is only for colliders", path, what));
  };
  if (c.rigid && c.pin) in.problems.error({}, fmt::format("{} is a pin too: give one of them", path));
  refuse(c.sequence.has_value(), "sequence"), refuse(c.sticky != 0, "sticky"), refuse(c.voxel.has_value(), "voxel");
  refuse(c.deletes, "deletes"), refuse(c.thickness.has_value(), "thickness");
  if (c.rigid) refuse(c.holds, "holds"), refuse(c.motion.has_value(), "motion");
  if (c.pin) refuse(c.friction != 0, "friction"), refuse(c.type != WallType::separate, "type");
}

template <class T>
void check_names(Reading& in, const char* section, const std::vector<T>& list) {
  std::set<std::string> names;
  for (const T& one : list)
    if (!names.insert(one.name).second)
      in.problems.error({}, fmt::format("{}: two have the name '{}'", section, one.name));
}

void check_members(Reading& in, const model::Scene& s) {
  check_names(in, "materials", s.materials), check_names(in, "bodies", s.bodies);
  check_names(in, "colliders", s.colliders), check_names(in, "emitters", s.emitters);
  check_names(in, "sinks", s.sinks), check_names(in, "fields", s.fields), check_names(in, "probes", s.probes);
  for (std::size_t w = 0; w < s.space.walls.size(); ++w)
    check_unused(in, fmt::format("space.walls.{}", side_names[w]), s.space.walls[w], wall_schema());
  for (const Collider& c : s.colliders) {
    check_unused_motion(in, "colliders." + c.name, c.motion);
    if (c.rigid || c.pin)
      check_kind(in, c);
    else
      check_unused(in, "colliders." + c.name, c, collider_schema());
  }
  const Schema<Emitter> of_emitters = s.emitters.empty() ? Schema<Emitter>{} : emitter_schema(s.materials);
  for (const Emitter& e : s.emitters)
    check_unused(in, "emitters." + e.name, e, of_emitters), check_unused_motion(in, "emitters." + e.name, e.motion);
  for (const auto& [name, look] : s.render.looks) check_unused(in, "render.looks." + name, look, look_schema());
  for (const Sink& one : s.sinks) check_unused_motion(in, "sinks." + one.name, one.motion);
}

/// The maps that a value may be.
std::vector<MapInfo> maps_of(const ValueInfo& value) {
  if (const auto* map = std::get_if<MapOf>(&value.form)) return {map->make()};
  if (const auto* names = std::get_if<NamesInfo>(&value.form)) return maps_of(names->each.at(0));
  if (const auto* list = std::get_if<ListInfo>(&value.form)) return maps_of(list->item.at(0));
  std::vector<MapInfo> all;
  if (const auto* either = std::get_if<EitherInfo>(&value.form))
    for (const ValueInfo& one : either->of)
      for (MapInfo& map : maps_of(one)) all.push_back(std::move(map));
  return all;
}

std::string meaning_in(const MapInfo& map, std::string_view path) {
  const std::size_t dot = path.find('.');
  const auto look = [&](const std::vector<KeyInfo>& keys) -> std::string {
    for (const KeyInfo& key : keys) {
      if (key.key != path.substr(0, dot)) continue;
      if (dot == path.npos) return key.meaning;
      for (const MapInfo& inner : maps_of(key.value))
        if (std::string found = meaning_in(inner, path.substr(dot + 1)); !found.empty()) return found;
    }
    return {};
  };
  if (std::string found = look(map.keys); !found.empty()) return found;
  for (const MapInfo::Type& type : map.types)
    if (std::string found = look(type.keys); !found.empty()) return found;
  return {};
}

/// Throws InputError where there are any.
void refuse(const Problems& problems) {
  ParseResult result;
  result.problems = problems.list();
  if (result.ok()) return;
  std::string lines = result.text();
  lines.pop_back();
  throw InputError(lines);
}

/// Reads a text by `read`.
template <class T, class Read>
T parsed(std::string_view text, const std::string& name, const Read& read) {
  Problems problems;
  Reading in{problems, std::filesystem::path(name).parent_path().string(), asset_names()};
  const YamlNode node = read_yaml(text, name, problems);
  T out{};
  if (problems.errors() == 0) read(in, node, out);
  refuse(problems);
  return out;
}

}  // namespace

ParseResult check_scene(const model::Scene& given) {
  ParseResult result;
  Problems problems;
  Reading in{problems, {}, asset_names(), Reading::Models::as_named};
  check_members(in, given);
  result.scene = read_scene(in, write_map(given, scene_schema()), "");
  result.scene.marks = given.marks;
  result.problems = problems.list();
  return result;
}

void check_shape(const Shape& shape, const std::string& name) {
  Problems problems;
  Reading in{problems, {}, asset_names(), Reading::Models::as_named};
  Shape read;
  read_shape(in, write_shape(shape), name + ".shape", ShapeUse::collider, read);
  std::string lines;
  for (const Problem& p : problems.list()) lines += (lines.empty() ? "" : "\n") + p.message;
  if (!lines.empty()) throw InputError(lines);
}

std::string meaning_of(std::string_view path) { return meaning_in(scene_info(), path); }

std::string shape_text(const Shape& shape) {
  YamlNode map = YamlNode::map();
  map.put("all", YamlNode::list({write_shape(shape)}));  // lists stand on one line
  const std::string text = write_yaml(map);
  const std::size_t begin = text.find('[') + 1;
  return text.substr(begin, text.rfind(']') - begin);
}

Shape parse_shape_text(std::string_view text, const std::string& name) {
  return parsed<Shape>(text, name, [](Reading& in, const YamlNode& node, Shape& out) {
    read_shape(in, node, "shape", ShapeUse::collider, out);
  });
}

model::Material parse_material_text(std::string_view text, const std::string& name) {
  return parsed<Material>(text, name, [](Reading& in, const YamlNode& node, Material& out) {
    YamlNode all = YamlNode::map();
    all.put("material", node);
    model::Scene scene;
    read_materials(in, all, scene);
    if (!scene.materials.empty()) out = scene.materials[0];
  });
}

model::Look parse_look_text(std::string_view text, const std::string& name) {
  return parsed<Look>(text, name,
                      [](Reading& in, const YamlNode& node, Look& out) { read_look(in, node, "look", out); });
}

}  // namespace dreampm::scene

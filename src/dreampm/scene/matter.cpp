// materials, bodies, colliders: what there is.
#include <fmt/ranges.h>

#include <cmath>
#include <map>

#include "dreampm/physics/param.h"
#include "dreampm/scene/sections.h"

namespace dreampm::scene {
namespace {

std::vector<std::string> material_names() {
  std::vector<std::string> names;
  for (const MaterialInfo& m : material_infos()) names.emplace_back(m.name);
  return names;
}

/// A parameter: a number in its range, or one of its words.
std::optional<double> read_param(Reading& in, const YamlNode& n, const std::string& path, const Param& p) {
  std::vector<std::string> words;
  for (const Word& w : p.words) words.emplace_back(w.name);
  if (n.kind == YamlNode::Kind::scalar && !n.quoted)
    for (const Word& w : p.words)
      if (n.text == w.name) return w.value;
  if (p.words_only) {
    read_word(in.problems, n, path, words);
    return std::nullopt;
  }
  const std::string unit(p.unit == "1" ? "" : p.unit);
  Range range = between(p.min, p.max, unit.c_str());
  const std::string what = fmt::format("a number{}{}", words.empty() ? "" : " or ", fmt::join(words, " or "));
  return read_number(in.problems, n, path, range, what.c_str());
}

/// The other type that has this parameter, or null.
const MaterialInfo* owner_of(std::string_view key) {
  for (const MaterialInfo& m : material_infos())
    if (m.find(key)) return &m;
  return nullptr;
}

void check_excluded(Reading& in, const YamlNode& node, const std::string& path, const MaterialInfo& info) {
  for (const Param& p : info.params) {
    if (p.excludes.empty() || !node.find(p.key) || !node.find(p.excludes)) continue;
    const auto later = std::find_if(node.entries.rbegin(), node.entries.rend(),
                                    [&](const Entry& e) { return e.key == p.key || e.key == p.excludes; });
    in.problems.error(later->at, fmt::format("{}.{} together with {}: give one of them", path, later->key,
                                             later->key == p.key ? p.excludes : p.key));
  }
}

bool is_transfer_key(const std::string& key) {
  return std::find(transfer_keys().begin(), transfer_keys().end(), key) != transfer_keys().end();
}

void read_params(Reading& in, const YamlNode& node, const std::string& path, Material& out) {
  const MaterialInfo& info = info_of(out);
  std::map<std::string, double> values;
  std::vector<std::string> known{"type", "preset"};
  for (const Param& p : info.params) known.emplace_back(p.key);
  known.insert(known.end(), transfer_keys().begin(), transfer_keys().end());
  read_transfer(in, node, path, out);
  if (const YamlNode* n = node.find("preset")) {
    std::vector<std::string> names;
    for (const Preset& p : info.presets) names.emplace_back(p.name);
    if (names.empty())
      in.problems.error(n->at, fmt::format("{}.preset: {} has no presets", path, info.name));
    else if (const auto name = read_word(in.problems, *n, path + ".preset", names))
      for (const Preset& p : info.presets)
        if (p.name == *name)
          for (const Preset::Value& v : p.values) values[std::string(v.key)] = v.value;
  }
  for (const Entry& e : node.entries) {
    if (e.key == "type" || e.key == "preset" || is_transfer_key(e.key)) continue;
    const std::string name = fmt::format("{}.{}", path, e.key);
    const Param* p = info.find(e.key);
    if (!p) {
      const MaterialInfo* owner = owner_of(e.key);
      in.problems.error(e.at, owner ? fmt::format("{} is a key of type {}, not of {}", name, owner->name, info.name)
                                    : fmt::format("unknown key '{}'{}", name, suggest(e.key, known)));
      continue;
    }
    const auto v = read_param(in, e.value, name, *p);
    if (!v) continue;
    values[e.key] = *v;
    // A key of one's own also takes the place of the preset's other way to say it.
    for (const Param& q : info.params)
      if (!p->excludes.empty() ? q.key == p->excludes : q.excludes == p->key)
        if (!node.find(q.key)) values.erase(std::string(q.key));
  }
  check_excluded(in, node, path, info);
  for (const auto& [key, v] : values) out.values.set(key, v);
  out.values.with_defaults(info.params);
}

ValueInfo param_info(const Param& p) {
  std::vector<std::string> words;
  for (const Word& w : p.words) words.emplace_back(w.name);
  const bool is_flag = words == std::vector<std::string>{"false", "true"};
  ValueInfo by_word = is_flag ? ValueInfo{FlagInfo{}} : word_info(words);
  if (p.words_only) return by_word;
  // The unit is a literal of the table, so it ends with a zero.
  const ValueInfo number = number_info(between(p.min, p.max, p.unit == "1" ? "" : p.unit.data()));
  return words.empty() ? number : either({number, std::move(by_word)});
}

/// A parameter as a scene says it: its word if it has one for this value.
YamlNode write_param(const Param& p, double v) {
  for (const Word& w : p.words)
    if (w.value == v) return YamlNode::scalar(std::string(w.name));
  return write_number(v);
}

KeyInfo key_info(const Param& p) {
  KeyInfo key{std::string(p.key), param_info(p), sentence(p.help), {}};
  if (!std::isnan(p.value)) key.by_default = write_param(p, p.value);
  return key;
}

MapInfo::Type type_info(const MaterialInfo& m) {
  MapInfo::Type type{std::string(m.name), sentence(m.help), {}};
  std::vector<std::string> presets;
  for (const Preset& p : m.presets) presets.emplace_back(p.name);
  if (!presets.empty())
    type.keys.push_back({"preset", word_info(presets), "Values with a source; keys beside it win.", {}});
  for (const Param& p : m.params) type.keys.push_back(key_info(p));
  return type;
}

Field<Body> shape_field(ShapeUse use) {
  return Field<Body>{"shape",
                     [=](Reading& in, const YamlNode& n, const std::string& path, Body& out) {
                       read_shape(in, n, path, use, out.shape);
                     },
                     [](const Body& b, const std::string& k, YamlNode& map) { map.put(k, write_shape(b.shape)); }}
      .must()
      .takes(shape_info())
      .says("What is filled with particles.");
}

/// Names are looked up in `materials`.
Schema<Body> body_schema(const std::vector<Material>& materials) {
  return {
      material_name(materials, &Body::material).says("What it is made of."),
      shape_field(ShapeUse::body),
      vector("velocity", &Body::velocity, any_number("m/s")).says("At the start."),
      vector("spin", &Body::spin, any_number("rad/s")).says("At the start, about its center."),
      color("color", &Body::color).says("In sRGB; absent: the look of its material."),
      nested<Body>("sample", {choice("pattern", &Body::pattern, {"jitter", "lattice", "poisson"})
                                  .says("A lattice with random offsets, a plain lattice, or Poisson disks.")})
          .says("How its particles are placed."),
      names_of_things("cut", &Body::cut, "collider or rigid body")
          .says("What is cut out of it: it has no matter inside of these, as they stand at the start."),
  };
}

Field<Collider> on_touch() {
  static const std::vector<std::string> words{"keep", "delete"};
  return Field<Collider>{"on_touch",
                         [](Reading& in, const YamlNode& n, const std::string& path, Collider& out) {
                           if (const auto w = read_word(in.problems, n, path, words)) out.deletes = *w == "delete";
                         },
                         [](const Collider& c, const std::string& k, YamlNode& map) {
                           map.put(k, YamlNode::scalar(words[c.deletes ? 1 : 0]));
                         }}
      .takes(word_info(words))
      .says("`delete`: matter that touches it is taken out.");
}

Field<Collider> collider_shape() {
  return Field<Collider>{
      "shape",
      [](Reading& in, const YamlNode& n, const std::string& path, Collider& out) {
        read_shape(in, n, path, ShapeUse::collider, out.shape);
      },
      [](const Collider& c, const std::string& k, YamlNode& map) { map.put(k, write_shape(c.shape)); }}
      .must()
      .takes(shape_info())
      .says("Its shape.");
}

/// A shape, or a sequence of meshes.
Field<Collider> shape_or_sequence() {
  Field<Collider> f = collider_shape();
  f.read = [plain = f.read](Reading& in, const YamlNode& n, const std::string& path, Collider& out) {
    if (!is_sequence(n)) return plain(in, n, path, out);
    read_sequence(in, n, path, out.sequence.emplace());
    MeshShape& first = out.shape.form.emplace<MeshShape>();
    if (!out.sequence->files.empty()) first.path = out.sequence->files[0];
    first.scale = out.sequence->scale;
  };
  f.write = [plain = f.write](const Collider& c, const std::string& k, YamlNode& map) {
    if (!c.sequence) return plain(c, k, map);
    map.put(k, write_sequence(*c.sequence));
  };
  f.value = either({f.value, sequence_info()});
  f.meaning = "Its shape, or a sequence of meshes that deforms.";
  return f;
}

const Schema<Collider>& pin_schema() {
  static const Schema<Collider> schema{collider_shape(), motion_field<Collider>()};
  return schema;
}

}  // namespace

const Schema<Collider>& collider_schema() {
  static const Schema<Collider> schema{
      shape_or_sequence(),
      choice("type", &Collider::type, {"separate", "slip", "stick"})
          .when([](const Collider& c) { return !c.holds; }, "colliders that do not hold matter")
          .says("What its surface does to matter, as that of a wall."),
      number("friction", &Collider::friction, between(0, 100))
          .when([](const Collider& c) { return c.type != WallType::stick && !c.holds; },
                "type separate and slip, without holds")
          .says("Coulomb's coefficient."),
      written_when<Collider>(number("sticky", &Collider::sticky, at_least_zero("Pa")),
                             [](const Collider& c) { return c.sticky > 0; })
          .when([](const Collider& c) { return c.type == WallType::separate && !c.holds; },
                "type separate, without holds")
          .says("The tension up to which it holds matter that touches it."),
      written_when<Collider>(on_touch(), [](const Collider& c) { return c.deletes; }),
      number("voxel", &Collider::voxel, above_zero("m"))
          .says("The resolution of distances from a mesh; absent: the spacing, finer for thin walls."),
      number("thickness", &Collider::thickness, above_zero("m"))
          .when([](const Collider& c) { return !c.sequence; }, "shapes that do not change")
          .says("Makes a wall about the surface of its shape, half of it on either side; absent: the shape is solid."),
      written_when<Collider>(flag("holds", &Collider::holds), [](const Collider& c) { return c.holds; })
          .says("Matter that is inside at the start is held there, and moves with it."),
      motion_field<Collider>().when([](const Collider& c) { return !c.sequence; }, "shapes that do not change"),
  };
  return schema;
}

bool good_name(std::string_view s) {
  const auto letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9'); };
  if (s.empty() || s.size() > 64 || !letter(s[0])) return false;
  return std::all_of(s.begin(), s.end(), [&](char c) { return letter(c) || c == '_' || c == '-'; });
}

void read_named(Reading& in, const YamlNode& node, const std::string& path,
                const std::function<void(const Entry&, const std::string& path)>& each) {
  if (!expect_map(in.problems, node, path)) return;
  for (const Entry& e : node.entries) {
    if (!good_name(e.key))
      in.problems.error(e.at, fmt::format("{}: the name '{}' must be {}", path, e.key, good_name_rule));
    std::string own = fmt::format("{}.{}", path, e.key);
    each(e, own);
    in.marks[std::move(own)] = {e.at.line, e.at.column};
  }
}

void read_materials(Reading& in, const YamlNode& node, model::Scene& out) {
  read_named(in, node, "materials", [&](const Entry& e, const std::string& path) {
    Material& m = add_named(out.materials, e);
    if (!expect_map(in.problems, e.value, path)) return;
    const YamlNode* type = e.value.find("type");
    if (!type) return in.problems.error(e.value.at, fmt::format("missing key '{}.type'", path));
    const auto name = read_word(in.problems, *type, path + ".type", material_names());
    if (!name) return;
    m.type = *name;
    read_params(in, e.value, path, m);
  });
  if (node.is_map() && node.entries.empty()) in.problems.error(node.at, "materials is empty: name at least one");
  if (out.materials.size() > model::most_materials)
    in.problems.error(node.at,
                      fmt::format("materials: {} are named; at most {}", out.materials.size(), model::most_materials));
}

void read_bodies(Reading& in, const YamlNode& node, model::Scene& out) {
  const Schema<Body> schema = body_schema(out.materials);
  read_named(in, node, "bodies", [&](const Entry& e, const std::string& path) {
    read_map(in, e.value, path, schema, add_named(out.bodies, e));
  });
  if (node.is_map() && node.entries.empty()) in.problems.error(node.at, "bodies is empty: name at least one");
}

void check_cuts(Reading& in, const YamlNode* bodies, const model::Scene& scene) {
  if (!bodies || !bodies->is_map()) return;
  std::vector<std::string> names;
  for (const Collider& c : scene.colliders)
    if (!c.pin) names.push_back(c.name);
  for (const Entry& body : bodies->entries) {
    const YamlNode* cut = find_in(&body.value, "cut");
    if (!cut || cut->kind != YamlNode::Kind::list) continue;
    for (const YamlNode& n : cut->items)
      if (!n.text.empty() && std::find(names.begin(), names.end(), n.text) == names.end())
        in.problems.error(n.at, fmt::format("bodies.{}.cut: no collider or rigid body '{}'{}", body.key, n.text,
                                            suggest(n.text, names)));
  }
}

void read_colliders(Reading& in, const YamlNode& node, model::Scene& out) {
  read_named(in, node, "colliders", [&](const Entry& e, const std::string& path) {
    if (std::any_of(out.materials.begin(), out.materials.end(), [&](const Material& m) { return m.name == e.key; }))
      in.problems.error(e.at, fmt::format("{}: a material has this name too, and looks go by name", path));
    read_map(in, e.value, path, collider_schema(), add_named(out.colliders, e));
  });
}

void read_pins(Reading& in, const YamlNode& node, model::Scene& out) {
  read_named(in, node, "pins", [&](const Entry& e, const std::string& path) {
    const auto has_it = [&](const auto& list) {
      return std::any_of(list.begin(), list.end(), [&](const auto& one) { return one.name == e.key; });
    };
    if (has_it(out.materials) || has_it(out.colliders))
      in.problems.error(e.at, fmt::format("{}: a material, collider or rigid body has this name too", path));
    Collider& pin = add_named(out.colliders, e);
    pin.pin = pin.holds = true;
    read_map(in, e.value, path, pin_schema(), pin);
  });
}

ValueInfo materials_info() {
  return names_info(map_of([] {
    MapInfo info{transfer_info()};
    for (const MaterialInfo& m : material_infos()) info.types.push_back(type_info(m));
    return info;
  }));
}

ValueInfo bodies_info() {
  static const std::vector<Material> none;
  return names_info(map_of(body_schema(none)));
}

ValueInfo colliders_info() { return names_info(map_of(collider_schema())); }

ValueInfo pins_info() { return names_info(map_of(pin_schema())); }

YamlNode write_pins(const model::Scene& scene) {
  YamlNode all = YamlNode::map();
  for (const Collider& c : scene.colliders)
    if (c.pin) all.put(c.name, write_map(c, pin_schema()));
  return all;
}

YamlNode write_materials(const model::Scene& scene) {
  YamlNode all = YamlNode::map();
  for (const Material& m : scene.materials) {
    YamlNode one = YamlNode::map();
    one.put("type", YamlNode::scalar(m.type));
    const MaterialInfo* info = find_material(m.type);
    const std::span<const Param> params = info ? info->params : std::span<const Param>{};
    for (const Param& p : params) {
      bool given_otherwise = false;  // the other way to say it has a value
      for (const Param& q : params) given_otherwise |= q.excludes == p.key && m.values.has(q.key);
      if (m.values.has(p.key) && !given_otherwise) one.put(std::string(p.key), write_param(p, m.values[p.key]));
    }
    // To be refused: keys that the type has not, and what is no number where nothing works it out.
    for (const auto& [key, value] : m.values) {
      const Param* p = info ? info->find(key) : nullptr;
      if (!p || (std::isnan(value) && !std::isnan(p->value))) one.put(key, write_number(value));
    }
    write_transfer(m, one);
    all.put(m.name, std::move(one));
  }
  return all;
}

YamlNode write_bodies(const model::Scene& scene) {
  const Schema<Body> schema = body_schema(scene.materials);
  YamlNode all = YamlNode::map();
  for (const Body& b : scene.bodies) all.put(b.name, write_map(b, schema));
  return all;
}

YamlNode write_colliders(const model::Scene& scene) {
  YamlNode all = YamlNode::map();
  for (const Collider& c : scene.colliders)
    if (!c.rigid && !c.pin) all.put(c.name, write_map(c, collider_schema()));
  return all;
}

}  // namespace dreampm::scene

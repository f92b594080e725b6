// rigid: bodies that float, sink, fall and meet each other.
#include <fmt/ranges.h>

#include "dreampm/scene/sections.h"

namespace dreampm::scene {
namespace {

/// A rigid body as the scene gives it.
struct BodyDraft {
  Collider collider;
  Rigid rigid;
  WallType type = WallType::separate;
  double friction = 0.4;
  std::optional<Vec3d> position;
};

Field<BodyDraft> shape() {
  return Field<BodyDraft>{
      "shape",
      [](Reading& in, const YamlNode& n, const std::string& path, BodyDraft& out) {
        read_shape(in, n, path, ShapeUse::rigid, out.collider.shape);
        if (std::holds_alternative<PlaneShape>(out.collider.shape.form))
          in.problems.error(n.at, fmt::format("{} is a plane, which has no end: give a box", path));
      },
      [](const BodyDraft& d, const std::string& k, YamlNode& map) { map.put(k, write_shape(d.collider.shape)); }}
      .must()
      .takes(shape_info())
      .says("Its shape; what is in its hollows is met there.");
}

Field<BodyDraft> lock() {
  static const std::vector<std::string> words{"x", "y", "z", "rx", "ry", "rz"};
  return Field<BodyDraft>{
      "lock",
      [](Reading& in, const YamlNode& n, const std::string& path, BodyDraft& out) {
        if (!expect_list(in.problems, n, path)) return;
        for (std::size_t i = 0; i < n.items.size(); ++i)
          if (const auto w = read_word(in.problems, n.items[i], fmt::format("{}[{}]", path, i), words))
            out.rigid.locked[static_cast<std::size_t>(std::find(words.begin(), words.end(), *w) - words.begin())] =
                true;
      },
      [](const BodyDraft& d, const std::string& k, YamlNode& map) {
        std::vector<YamlNode> items;
        for (std::size_t i = 0; i < words.size(); ++i)
          if (d.rigid.locked[i]) items.push_back(YamlNode::scalar(words[i]));
        if (!items.empty()) map.put(k, YamlNode::list(std::move(items)));
      }}
      .takes(list_info(word_info(words), 0))
      .says("Axes along which it does not move (x, y, z), or about which it does not turn (rx, ry, rz).");
}

Field<BodyDraft> spring() {
  static const Schema<Spring> schema{
      vector("to", &Spring::to, any_number("m")).must().says("The point that it pulls to."),
      number("stiffness", &Spring::stiffness, above_zero("N/m")).must().says("Force by distance."),
      number("damping", &Spring::damping, at_least_zero("N s/m")).says("Force by speed, against it."),
  };
  return Field<BodyDraft>{"spring",
                          [](Reading& in, const YamlNode& n, const std::string& path, BodyDraft& out) {
                            read_map(in, n, path, schema, out.rigid.spring.emplace());
                          },
                          [](const BodyDraft& d, const std::string& k, YamlNode& map) {
                            if (d.rigid.spring) map.put(k, write_map(*d.rigid.spring, schema));
                          }}
      .takes(map_of(schema))
      .says("Pulls its center of mass to a point.");
}

template <class T>
Field<BodyDraft> of_rigid(Field<Rigid> f) {
  return Field<BodyDraft>{
      f.key,
      [read = f.read](Reading& in, const YamlNode& n, const std::string& path, BodyDraft& out) {
        read(in, n, path, out.rigid);
      },
      [write = f.write](const BodyDraft& d, const std::string& k, YamlNode& map) { write(d.rigid, k, map); }}
      .takes(f.value)
      .says(f.meaning);
}

const Schema<BodyDraft>& body_schema() {
  static const Schema<BodyDraft> all{
      shape(),
      of_rigid<Rigid>(
          number("density", &Rigid::density, between(0.1, 30000, "kg/m^3")).says("Mass by the volume of its shape.")),
      of_rigid<Rigid>(number("mass", &Rigid::mass, above_zero("kg")).says("Its mass, in place of a density.")),
      vector("position", &BodyDraft::position, any_number("m"))
          .says("The center of its shape, needed where the shape has none."),
      of_rigid<Rigid>(vector("velocity", &Rigid::velocity, any_number("m/s")).says("At the start.")),
      of_rigid<Rigid>(
          vector("spin", &Rigid::spin, any_number("rad/s")).says("At the start, about its center of mass.")),
      written_when<BodyDraft>(choice("type", &BodyDraft::type, {"separate", "slip", "stick"}),
                              [](const BodyDraft& d) { return d.type != WallType::separate; })
          .says("What its surface does to matter."),
      number("friction", &BodyDraft::friction, between(0, 100))
          .says("Coulomb's coefficient; between two bodies the product of both."),
      of_rigid<Rigid>(number("restitution", &Rigid::restitution, between(0, 1))
                          .says("The part of its speed that an impact on another body gives back.")),
      lock(),
      spring(),
  };
  return all;
}

}  // namespace

void read_rigid(Reading& in, const YamlNode& node, model::Scene& out) {
  read_named(in, node, "rigid", [&](const Entry& e, const std::string& path) {
    const auto taken = [&](const auto& list) {
      return std::any_of(list.begin(), list.end(), [&](const auto& one) { return one.name == e.key; });
    };
    if (taken(out.materials) || taken(out.colliders))
      in.problems.error(e.at, fmt::format("{}: a material or collider has this name too, and looks go by name", path));
    BodyDraft draft;
    const int before = in.problems.errors();
    read_map(in, e.value, path, body_schema(), draft);
    if (in.problems.errors() == before && draft.rigid.density.has_value() == draft.rigid.mass.has_value())
      in.problems.error(e.value.at, fmt::format("{}: give either a density or a mass", path));
    Collider& c = out.colliders.emplace_back(std::move(draft.collider));
    c.name = e.key;
    c.type = draft.type;
    c.friction = draft.friction;
    if (draft.position) c.shape.center = draft.position;
    if (!c.shape.center && in.problems.errors() == before)
      in.problems.error(e.value.at, fmt::format("missing key '{}.position'", path));
    c.rigid = draft.rigid;
  });
}

ValueInfo rigid_info() {
  return names_info(map_of([] {
    MapInfo info{keys_info(body_schema())};
    info.one_of = {{"density"}, {"mass"}};
    return info;
  }));
}

YamlNode write_rigid(const model::Scene& scene) {
  YamlNode all = YamlNode::map();
  for (const Collider& c : scene.colliders)
    if (c.rigid) all.put(c.name, write_map(BodyDraft{c, *c.rigid, c.type, c.friction, std::nullopt}, body_schema()));
  return all;
}

}  // namespace dreampm::scene

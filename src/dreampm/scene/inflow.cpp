// emitters, sinks: where matter comes in and goes out.
#include "dreampm/scene/sections.h"

namespace dreampm::scene {
namespace {

/// A shape with an end on every side.
template <class T>
Field<T> bounded_shape(Shape T::* member) {
  return Field<T>{"shape",
                  [member](Reading& in, const YamlNode& n, const std::string& path, T& out) {
                    read_shape(in, n, path, ShapeUse::collider, out.*member);
                    if (std::holds_alternative<PlaneShape>((out.*member).form))
                      in.problems.error(n.at, fmt::format("{} is a plane, which has no end: give a box", path));
                  },
                  [member](const T& t, const std::string& k, YamlNode& map) { map.put(k, write_shape(t.*member)); }}
      .must();
}

/// Names are looked up in `materials`.
Schema<Emitter> emitter_schema(const std::vector<Material>& materials) {
  return {
      material_name(materials, &Emitter::material),
      bounded_shape(&Emitter::shape),
      optional_vector("velocity", &Emitter::velocity),
      optional_number("flow", &Emitter::flow, above_zero("m^3/s")),
      vector("direction", &Emitter::direction)
          .when([](const Emitter& e) { return e.flow.has_value(); }, "emitters with a flow"),
      number("start", &Emitter::start, at_least_zero("s")),
      optional_number("stop", &Emitter::stop, above_zero("s")),
      count("pool", &Emitter::pool, 1, 4000000000).must(),
      written_when<Emitter>(flag("recycle", &Emitter::recycle), [](const Emitter& e) { return e.recycle; }),
  };
}

const Schema<Sink>& sink_schema() {
  static const Schema<Sink> schema{bounded_shape(&Sink::shape)};
  return schema;
}

}  // namespace

void read_emitters(Reading& in, const YamlNode& node, SceneDescription& out) {
  const Schema<Emitter> schema = emitter_schema(out.materials);
  read_named(in, node, "emitters", [&](const Entry& e, const std::string& path) {
    Emitter& one = out.emitters.emplace_back();
    one.name = e.key;
    one.mark = {e.at.line, e.at.column};
    const int before = in.problems.errors();
    read_map(in, e.value, path, schema, one);
    if (in.problems.errors() > before) return;
    if (one.velocity.has_value() == one.flow.has_value())
      in.problems.error(e.value.at, fmt::format("{}: give either a velocity or a flow", path));
    else if (length(one.velocity.value_or(one.direction)) == 0)
      in.problems.error(e.value.at, fmt::format("{}.{} is zero: matter has to move through the shape", path,
                                                one.velocity ? "velocity" : "direction"));
    if (one.stop && !(*one.stop > one.start))
      in.problems.error(e.value.find("stop")->at,
                        fmt::format("{}.stop is {}: must be above start, which is {} s", path, *one.stop, one.start));
  });
}

void read_sinks(Reading& in, const YamlNode& node, SceneDescription& out) {
  read_named(in, node, "sinks", [&](const Entry& e, const std::string& path) {
    Sink& one = out.sinks.emplace_back();
    one.name = e.key;
    one.mark = {e.at.line, e.at.column};
    read_map(in, e.value, path, sink_schema(), one);
  });
}

YamlNode write_emitters(const SceneDescription& scene) {
  const Schema<Emitter> schema = emitter_schema(scene.materials);
  YamlNode all = YamlNode::map();
  for (const Emitter& e : scene.emitters) all.put(e.name, write_map(e, schema));
  return all;
}

YamlNode write_sinks(const SceneDescription& scene) {
  YamlNode all = YamlNode::map();
  for (const Sink& s : scene.sinks) all.put(s.name, write_map(s, sink_schema()));
  return all;
}

}  // namespace dreampm::scene

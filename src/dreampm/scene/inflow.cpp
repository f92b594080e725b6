// emitters, sinks: where matter comes in and goes out.
#include "dreampm/scene/keys.h"
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
      .must()
      .takes(shape_info());
}

/// A number, or keys over time of which one is above 0.
Field<Emitter> flow() {
  static const Schema<Keys<double>> schema =
      keys_schema<double>(number("value", &Key<double>::value, at_least_zero("m^3/s")).says("The flow at that time."));
  return Field<Emitter>{
      "flow",
      [](Reading& in, const YamlNode& n, const std::string& path, Emitter& out) {
        if (!n.is_map()) {
          if (const auto v = read_number(in.problems, n, path, above_zero("m^3/s"))) out.flow = {{0, *v}};
          return;
        }
        Keys<double> k;
        const int before = in.problems.errors();
        read_map(in, n, path, schema, k);
        if (in.problems.errors() == before &&
            std::none_of(k.list.begin(), k.list.end(), [](const Key<double>& one) { return one.value > 0; }))
          in.problems.error(n.at, fmt::format("{} is 0 at every key: nothing would come in", path));
        out.flow = std::move(k.list);
      },
      [](const Emitter& e, const std::string& k, YamlNode& map) {
        if (e.flow.size() == 1)
          map.put(k, write_number(e.flow[0].value));
        else if (!e.flow.empty())
          map.put(k, write_map(Keys<double>{e.flow}, schema));
      }}
      .takes(either({number_info(above_zero("m^3/s")), map_of(schema)}))
      .says("How much comes in, constant or by keys over time, in place of a velocity.");
}

}  // namespace

Schema<Emitter> emitter_schema(const std::vector<Material>& materials) {
  return {
      material_name(materials, &Emitter::material).says("What comes in."),
      bounded_shape(&Emitter::shape).says("Where it comes in: the shape stays filled."),
      vector("velocity", &Emitter::velocity, any_number("m/s")).says("The velocity of what comes in."),
      flow(),
      vector("direction", &Emitter::direction)
          .when([](const Emitter& e) { return !e.flow.empty(); }, "emitters with a flow")
          .says("The direction of the flow."),
      written_when<Emitter>(number("swirl", &Emitter::swirl, {-1e4, 1e4, false, false, "rad/s"}),
                            [](const Emitter& e) { return e.swirl != 0; })
          .says("The spin of what comes in, about its direction through the middle of the shape."),
      written_when<Emitter>(number("jitter", &Emitter::jitter, between(0, Emitter::most_jitter, "spacings")),
                            [](const Emitter& e) { return e.jitter > 0; })
          .says("How far particles are off their places (blue noise) along each axis at most; more than 0.11 is taken "
                "as 0.11."),
      number("start", &Emitter::start, at_least_zero("s")).says("When it opens."),
      number("stop", &Emitter::stop, above_zero("s")).says("When it closes; absent: never."),
      color("color", &Emitter::color)
          .says("Of what comes in, in sRGB; absent: as matter of its material that has no color."),
      count("pool", &Emitter::pool, 1, 4000000000).must().says("The particles that it may give in all."),
      written_when<Emitter>(flag("recycle", &Emitter::recycle), [](const Emitter& e) { return e.recycle; })
          .says("The pool is what may be there of its material at once, not in all."),
      motion_field<Emitter>().says(
          "How its shape moves; it stands still if absent. Matter comes in at the velocity that it has in the shape, "
          "turned with it, and that of the shape."),
  };
}

namespace {

const Schema<Sink>& sink_schema() {
  static const Schema<Sink> schema{bounded_shape(&Sink::shape).says("Where matter is taken out."),
                                   motion_field<Sink>()};
  return schema;
}

}  // namespace

void read_emitters(Reading& in, const YamlNode& node, model::Scene& out) {
  const Schema<Emitter> schema = emitter_schema(out.materials);
  read_named(in, node, "emitters", [&](const Entry& e, const std::string& path) {
    Emitter& one = add_named(out.emitters, e);
    const int before = in.problems.errors();
    read_map(in, e.value, path, schema, one);
    if (in.problems.errors() > before) return;
    if (one.velocity.has_value() == !one.flow.empty())
      in.problems.error(e.value.at, fmt::format("{}: give either a velocity or a flow", path));
    else if (length(one.velocity.value_or(one.direction)) == 0)
      in.problems.error(e.value.at, fmt::format("{}.{} is zero: matter has to move through the shape", path,
                                                one.velocity ? "velocity" : "direction"));
    if (one.stop && !(*one.stop > one.start))
      in.problems.error(e.value.find("stop")->at,
                        fmt::format("{}.stop is {}: must be above start, which is {} s", path, *one.stop, one.start));
  });
}

void read_sinks(Reading& in, const YamlNode& node, model::Scene& out) {
  read_named(in, node, "sinks", [&](const Entry& e, const std::string& path) {
    if (std::any_of(out.colliders.begin(), out.colliders.end(), [&](const Collider& c) { return c.name == e.key; }))
      in.problems.error(e.at, fmt::format("{}: a collider has this name too", path));
    read_map(in, e.value, path, sink_schema(), add_named(out.sinks, e));
  });
}

ValueInfo emitters_info() {
  return names_info(map_of([] {
    static const std::vector<Material> none;
    MapInfo info{keys_info(emitter_schema(none))};
    info.one_of = {{"velocity"}, {"flow"}};
    return info;
  }));
}

ValueInfo sinks_info() { return names_info(map_of(sink_schema())); }

YamlNode write_emitters(const model::Scene& scene) {
  const Schema<Emitter> schema = emitter_schema(scene.materials);
  YamlNode all = YamlNode::map();
  for (const Emitter& e : scene.emitters) all.put(e.name, write_map(e, schema));
  return all;
}

YamlNode write_sinks(const model::Scene& scene) {
  YamlNode all = YamlNode::map();
  for (const Sink& s : scene.sinks) all.put(s.name, write_map(s, sink_schema()));
  return all;
}

}  // namespace dreampm::scene

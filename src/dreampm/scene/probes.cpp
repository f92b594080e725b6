// probes: what is measured. The keys of each type stand in a table of their own; the types in
// ProbeForm.
#include "dreampm/model/probes.h"

#include <map>
#include <utility>

#include "dreampm/scene/sections.h"

namespace dreampm::scene {
namespace {

/// Calls each.operator()<P>() for every type of probe.
template <class Each, std::size_t... I>
void for_each_type(const Each& each, std::index_sequence<I...>) {
  (each.template operator()<std::variant_alternative_t<I, ProbeForm>>(), ...);
}
template <class Each>
void for_each_type(const Each& each) {
  for_each_type(each, std::make_index_sequence<std::variant_size_v<ProbeForm>>{});
}

template <class T>
std::vector<std::string> names_of(const std::vector<T>& things) {
  std::vector<std::string> names;
  for (const T& t : things) names.push_back(t.name);
  return names;
}

/// The name of one of the scene's `things` ("material", "body").
template <class P, class T>
Field<P> reference(std::string key, std::string P::* member, const char* kind, const std::vector<T>& things) {
  return Field<P>{std::move(key),
                  [=, &things](Reading& in, const YamlNode& n, const std::string& path, P& out) {
                    const std::vector<std::string> names = names_of(things);
                    const auto name = read_text(in.problems, n, path);
                    if (!name) return;
                    const auto found = std::find(names.begin(), names.end(), *name);
                    if (found == names.end())
                      in.problems.error(n.at,
                                        fmt::format("{}: no {} '{}'{}", path, kind, *name, suggest(*name, names)));
                    else
                      out.*member = *name;
                  },
                  [=](const P& p, const std::string& k, YamlNode& map) {
                    if (!(p.*member).empty()) map.put(k, write_text(p.*member));
                  }}
      .takes(text_info(fmt::format("the name of a {}", kind)));
}

/// Says where on an axis a point lies outside the space; matter goes beyond open walls, and so may
/// probes.
void check_inside(Reading& in, const Place& at, const std::string& path, const Space& space, int axis, double v) {
  const Vec3d end = space.end();
  const bool below = v<space.min[axis], above = v> end[axis];
  if ((!below && !above) || space.walls[std::size_t(2 * axis + above)].type == WallType::open) return;
  in.problems.error(
      at, fmt::format("{} is {}: must be between the walls, {} and {} m", path, v, space.min[axis], end[axis]));
}

template <class P>
Field<P> place(std::string key, Vec3d P::* member, const model::Scene& scene) {
  Field<P> f = vector(std::move(key), member, any_number("m"));
  f.read = [=, &scene, read = f.read](Reading& in, const YamlNode& n, const std::string& path, P& out) {
    const int before = in.problems.errors();
    read(in, n, path, out);
    if (in.problems.errors() > before) return;
    for (int a = 0; a < 3; ++a)
      check_inside(in, n.items[std::size_t(a)].at, fmt::format("{}[{}]", path, a), scene.space, a, (out.*member)[a]);
  };
  return std::move(f).must().says("The place, between the walls of the box.");
}

template <class P>
Field<P> direction(std::string key, Vec3d P::* member, const char* way) {
  Field<P> f = vector(std::move(key), member);
  f.read = [=, read = f.read](Reading& in, const YamlNode& n, const std::string& path, P& out) {
    const int before = in.problems.errors();
    read(in, n, path, out);
    if (in.problems.errors() == before && length(out.*member) == 0)
      in.problems.error(n.at, fmt::format("{} is zero: it must point {}", path, way));
  };
  return std::move(f).must().says(fmt::format("Its direction: {}; any length above 0.", way));
}

/// A ball thinner than the spacing falls between the particles.
template <class P>
Field<P> radius(const model::Scene& scene) {
  Field<P> f = number("radius", &P::radius, above_zero("m"));
  f.read = [=, &scene, read = f.read](Reading& in, const YamlNode& n, const std::string& path, P& out) {
    const int before = in.problems.errors();
    read(in, n, path, out);
    if (in.problems.errors() == before && out.radius < scene.space.spacing)
      in.problems.error(n.at, fmt::format("{} is {}: must be at least the particle spacing, {} m", path, n.text,
                                          scene.space.spacing));
  };
  return std::move(f).must().says("Of the ball that it averages over, at least the spacing.");
}

constexpr std::string_view help_of(const HeightProbe*) { return "The height of the free surface above a point."; }
Schema<HeightProbe> keys_of(const HeightProbe*, const model::Scene& scene) {
  return {Field<HeightProbe>{
      "at",
      [&scene](Reading& in, const YamlNode& n, const std::string& path, HeightProbe& out) {
        if (n.kind != YamlNode::Kind::list || n.items.size() != 2) {
          const std::string is =
              n.kind == YamlNode::Kind::list ? fmt::format("a list of {}", n.items.size()) : n.describe();
          return in.problems.error(n.at, fmt::format("{} is {}: must be a list of 2 numbers, [x, z]", path, is));
        }
        for (int i = 0; i < 2; ++i) {
          const YamlNode& item = n.items[std::size_t(i)];
          const std::string name = fmt::format("{}[{}]", path, i);
          const auto v = read_number(in.problems, item, name, {});
          if (!v) continue;
          (i == 0 ? out.x : out.z) = *v;
          check_inside(in, item.at, name, scene.space, 2 * i, *v);
        }
      },
      [](const HeightProbe& p, const std::string& k, YamlNode& map) {
        map.put(k, YamlNode::list({write_number(p.x), write_number(p.z)}));
      }}.must()
              .takes(list_info(number_info(any_number("m")), 2, 2))
              .says("The place seen from above, [x, z].")};
}

constexpr std::string_view help_of(const PressureProbe*) { return "The pressure of the matter at a point of a wall."; }
Schema<PressureProbe> keys_of(const PressureProbe*, const model::Scene& scene) {
  return {place("at", &PressureProbe::at, scene),
          direction("normal", &PressureProbe::normal, "out of the wall, into the matter"),
          radius<PressureProbe>(scene)};
}

constexpr std::string_view help_of(const VelocityProbe*) { return "The mean velocity of the matter around a point."; }
Schema<VelocityProbe> keys_of(const VelocityProbe*, const model::Scene& scene) {
  return {place("at", &VelocityProbe::at, scene), radius<VelocityProbe>(scene)};
}

constexpr std::string_view help_of(const FluxProbe*) { return "The volume that passes a plane along its normal."; }
Schema<FluxProbe> keys_of(const FluxProbe*, const model::Scene& scene) {
  return {std::move(
              nested<FluxProbe>("plane", {place("point", &FluxProbe::point, scene),
                                          direction("normal", &FluxProbe::normal, "the way that counts as positive")}))
              .must()
              .says("The plane that matter passes.")};
}

constexpr std::string_view help_of(const RegionProbe*) { return "What lies within a shape."; }
Schema<RegionProbe> keys_of(const RegionProbe*, const model::Scene&) {
  return {Field<RegionProbe>{
      "shape",
      [](Reading& in, const YamlNode& n, const std::string& path, RegionProbe& out) {
        read_shape(in, n, path, ShapeUse::collider, out.shape);
      },
      [](const RegionProbe& p, const std::string& k, YamlNode& map) { map.put(k, write_shape(p.shape)); }}
              .must()
              .takes(shape_info())
              .says("Where to look.")};
}

constexpr std::string_view help_of(const ForceProbe*) {
  return "The force of the matter on a wall, collider or rigid body.";
}
Schema<ForceProbe> keys_of(const ForceProbe*, const model::Scene& scene) {
  return {Field<ForceProbe>{
      "on",
      [&scene](Reading& in, const YamlNode& n, const std::string& path, ForceProbe& out) {
        const auto name = read_text(in.problems, n, path);
        if (!name) return;
        const auto bad = [&](const std::string& why) { in.problems.error(n.at, fmt::format("{}: {}", path, why)); };
        out.on = *name;
        const std::optional<Side> wall = side_called(*name);
        std::vector<std::string> names = names_of(scene.colliders);
        const bool is_collider = std::find(names.begin(), names.end(), *name) != names.end();
        if (wall && is_collider) return bad(fmt::format("'{}' is a wall and a collider: rename the collider", *name));
        // The walls of a periodic axis are open ones inside, but no reader wrote so.
        if (wall && scene.space.periodic[index(*wall) / 2])
          return bad(fmt::format("'{}' is on the periodic axis {}: there is no wall", *name, "xyz"[index(*wall) / 2]));
        if (wall && scene.space.walls[index(*wall)].type == WallType::open)
          return bad(fmt::format("the wall '{}' is open: nothing is there to be pushed", *name));
        if (wall || is_collider) return;
        names.insert(names.end(), side_names.begin(), side_names.end());
        names.insert(names.end(), {"floor", "ceiling"});
        bad(fmt::format("no wall or collider '{}'{}", *name, suggest(*name, names)));
      },
      [](const ForceProbe& p, const std::string& k, YamlNode& map) { map.put(k, write_text(p.on)); }}
              .must()
              .takes(text_info("the name of a wall (`floor`, `ceiling`, `x_min` ...), collider or rigid body"))
              .says("What is pushed.")};
}

constexpr std::string_view help_of(const ExtentProbe*) { return "From where to where matter reaches along an axis."; }
Schema<ExtentProbe> keys_of(const ExtentProbe*, const model::Scene& scene) {
  return {choice("axis", &ExtentProbe::axis, {"x", "y", "z"}).must().says("Along which axis."),
          reference("material", &ExtentProbe::material, "material", scene.materials)
              .says("Of which material; absent: all matter.")};
}

constexpr std::string_view help_of(const PointProbe*) {
  return "A material point of a body: the one that starts at `at`.";
}
Schema<PointProbe> keys_of(const PointProbe*, const model::Scene& scene) {
  return {reference("body", &PointProbe::body, "body", scene.bodies).must().says("Of which body."),
          place("at", &PointProbe::at, scene)};
}

constexpr std::string_view help_of(const PoseProbe*) {
  return "Where a collider or rigid body stands, and how it moves.";
}
Schema<PoseProbe> keys_of(const PoseProbe*, const model::Scene& scene) {
  return {reference("on", &PoseProbe::on, "collider or rigid body", scene.colliders).must().says("Of what.")};
}

constexpr std::string_view help_of(const InflowProbe*) { return "What comes in by an emitter, or goes out by a sink."; }
Schema<InflowProbe> keys_of(const InflowProbe*, const model::Scene& scene) {
  return {Field<InflowProbe>{
      "on",
      [&scene](Reading& in, const YamlNode& n, const std::string& path, InflowProbe& out) {
        const auto name = read_text(in.problems, n, path);
        if (!name) return;
        out.on = *name;
        const auto is_in = [&](const std::vector<std::string>& names) {
          return std::find(names.begin(), names.end(), *name) != names.end();
        };
        std::vector<std::string> names = names_of(scene.emitters);
        std::vector<std::string> sinks = names_of(scene.sinks);
        for (const Collider& c : scene.colliders)
          if (c.deletes) sinks.push_back(c.name);
        const bool emits = is_in(names), takes = is_in(sinks);
        if (emits && takes)
          in.problems.error(n.at, fmt::format("{}: '{}' is an emitter and a sink: rename one", path, *name));
        if (emits || takes) return;
        names.insert(names.end(), sinks.begin(), sinks.end());
        in.problems.error(n.at, fmt::format("{}: no emitter, sink or collider that deletes '{}'{}", path, *name,
                                            suggest(*name, names)));
      },
      [](const InflowProbe& p, const std::string& k, YamlNode& map) { map.put(k, write_text(p.on)); }}
              .must()
              .takes(text_info("the name of an emitter, a sink, or a collider that deletes"))
              .says("Of what.")};
}

template <class P>
Schema<P> keys_of(const model::Scene& scene) {
  return keys_of(static_cast<const P*>(nullptr), scene);
}

std::vector<std::string> probe_types() {
  std::vector<std::string> names;
  for_each_type([&]<class P>() { names.emplace_back(P::type); });
  return names;
}

/// Each key with the types that have it, in words: "pressure and velocity".
std::map<std::string, std::string> owners(const model::Scene& scene) {
  std::map<std::string, std::vector<std::string>> types;
  for_each_type([&]<class P>() {
    for (const Field<P>& f : keys_of<P>(scene)) types[f.key].emplace_back(P::type);
  });
  std::map<std::string, std::string> words;
  for (const auto& [key, list] : types) {
    std::string& w = words[key];
    for (std::size_t i = 0; i < list.size(); ++i) w += (i == 0 ? "" : i + 1 == list.size() ? " and " : ", ") + list[i];
  }
  return words;
}

const Schema<Probe>& common_keys() {
  static const Schema<Probe> schema{written_when<Probe>(number("rate", &Probe::rate, {0, 1e6, true, false, "Hz"}),
                                                        [](const Probe& p) { return p.rate > 0; })
                                        .no_default()
                                        .says("Samples a second of simulated time; absent: one a frame.")};
  return schema;
}

/// The keys of type P in `node`, which has `rate` and `type` too.
template <class P>
void read_form(Reading& in, YamlNode node, const std::string& path, const model::Scene& scene, Probe& out) {
  const Schema<P> schema = keys_of<P>(scene);
  const auto all = owners(scene);
  std::erase_if(node.entries, [&](const Entry& e) {
    const bool own = std::any_of(schema.begin(), schema.end(), [&](const Field<P>& f) { return f.key == e.key; });
    const auto owner = all.find(e.key);
    if (own || owner == all.end()) return false;
    in.problems.error(e.at, fmt::format("{}.{} is a key of type {}, not of {}", path, e.key, owner->second, P::type));
    return true;
  });
  read_map(in, node, path, schema, out.form.emplace<P>(), {"type", "rate"});
}

}  // namespace

void read_probes(Reading& in, const YamlNode& node, model::Scene& out) {
  const std::vector<std::string> types = probe_types();
  read_named(in, node, "probes", [&](const Entry& e, const std::string& path) {
    Probe probe;
    probe.name = e.key;
    if (!expect_map(in.problems, e.value, path)) return;
    const YamlNode* type = e.value.find("type");
    if (!type) return in.problems.error(e.value.at, fmt::format("missing key '{}.type'", path));
    const auto name = read_word(in.problems, *type, path + ".type", types);
    if (!name) return;
    if (const YamlNode* rate = e.value.find("rate")) common_keys()[0].read(in, *rate, path + ".rate", probe);
    for_each_type([&]<class P>() {
      if (P::type == *name) read_form<P>(in, e.value, path, out, probe);
    });
    out.probes.push_back(std::move(probe));
  });
}

ValueInfo probes_info() {
  return names_info(map_of([] {
    static const model::Scene none;
    MapInfo info{keys_info(common_keys())};
    for_each_type([&]<class P>() {
      info.types.push_back(
          {std::string(P::type), std::string(help_of(static_cast<const P*>(nullptr))), keys_info(keys_of<P>(none))});
    });
    return info;
  }));
}

YamlNode write_probes(const model::Scene& scene) {
  YamlNode all = YamlNode::map();
  for (const Probe& p : scene.probes) {
    YamlNode one = YamlNode::map();
    std::visit(
        [&]<class P>(const P& form) {
          one.put("type", YamlNode::scalar(std::string(P::type)));
          for (Entry& e : write_map(form, keys_of<P>(scene)).entries) one.entries.push_back(std::move(e));
        },
        p.form);
    for (Entry& e : write_map(p, common_keys()).entries) one.entries.push_back(std::move(e));
    all.put(p.name, std::move(one));
  }
  return all;
}

}  // namespace dreampm::scene

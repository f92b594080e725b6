// foam: spray, foam, bubbles and dust.
#include "dreampm/scene/foam.h"

#include "dreampm/physics/materials.h"
#include "dreampm/physics/param.h"
#include "dreampm/scene/sections.h"

namespace dreampm::scene {
namespace {

using model::Foam;
using model::FoamLimits;
using model::FoamSource;

Schema<FoamLimits> limits_schema(const char* unit) {
  return {number("from", &FoamLimits::from, at_least_zero(unit))
              .says("Up to here nothing is emitted; absent: found from the frames."),
          number("to", &FoamLimits::to, above_zero(unit))
              .says("From here on all is emitted; absent: found from the frames.")};
}

/// Reports limits of which the upper one is not above the lower one.
void check_limits(Reading& in, const YamlNode& n, const std::string& path, const FoamLimits& limits) {
  if (limits.from && limits.to && !(*limits.to > *limits.from))
    in.problems.error(n.find("to")->at,
                      fmt::format("{0}.to is {1}: must be above {0}.from, {2}", path, *limits.to, *limits.from));
}

Field<Foam> limits(std::string key, FoamLimits Foam::* member, const char* unit) {
  Field<Foam> f = section(std::move(key), member, limits_schema(unit));
  f.read = [member, read = f.read](Reading& in, const YamlNode& n, const std::string& path, Foam& out) {
    const int before = in.problems.errors();
    read(in, n, path, out);
    if (in.problems.errors() == before) check_limits(in, n, path, out.*member);
  };
  return f;
}

/// share, from and to of a cause.
Schema<FoamSource> source_schema(const char* unit) {
  Schema<FoamSource> schema{
      number("share", &FoamSource::share, at_least_zero()).says("Of the rate that this cause can give; 0: none.")};
  for (const Field<FoamLimits>& f : limits_schema(unit)) {
    Field<FoamSource> of;
    of.key = f.key;
    of.read = [read = f.read](Reading& in, const YamlNode& n, const std::string& path, FoamSource& out) {
      read(in, n, path, out.limits);
    };
    of.write = [write = f.write](const FoamSource& s, const std::string& k, YamlNode& map) { write(s.limits, k, map); };
    of.value = f.value, of.meaning = f.meaning;
    schema.push_back(std::move(of));
  }
  return schema;
}

Field<Foam> source(std::string key, FoamSource Foam::* member, const char* unit) {
  const Schema<FoamSource> schema = source_schema(unit);
  Field<Foam> f = section(std::move(key), member, schema);
  f.value = map_of([schema, member] { return MapInfo{keys_info(schema, Foam{}.*member)}; });
  f.read = [member, read = f.read](Reading& in, const YamlNode& n, const std::string& path, Foam& out) {
    const int before = in.problems.errors();
    read(in, n, path, out);
    if (in.problems.errors() == before) check_limits(in, n, path, (out.*member).limits);
  };
  return f;
}

/// life: [shortest, longest]
Field<Foam> life() {
  const Range range = between(0.01, 1e6, "s");
  return Field<Foam>{
      "life",
      [range](Reading& in, const YamlNode& n, const std::string& path, Foam& out) {
        if (n.kind != YamlNode::Kind::list || n.items.size() != 2)
          return in.problems.error(
              n.at,
              fmt::format("{} is {}: must be a list of 2 numbers, [shortest, longest]", path,
                          n.kind == YamlNode::Kind::list ? fmt::format("a list of {}", n.items.size()) : n.describe()));
        const auto least = read_number(in.problems, n.items[0], path + "[0]", range);
        const auto most = read_number(in.problems, n.items[1], path + "[1]", range);
        if (!least || !most) return;
        if (*most < *least)
          return in.problems.error(n.items[1].at,
                                   fmt::format("{0}[1] is {1}: must not be below {0}[0], {2}", path, *most, *least));
        out.life_min = *least, out.life_max = *most;
      },
      [](const Foam& f, const std::string& k, YamlNode& map) {
        map.put(k, YamlNode::list({write_number(f.life_min), write_number(f.life_max)}));
      }}
      .takes(list_info(number_info(range), 2, 2))
      .says("The shortest and the longest life of foam on the surface; spray and bubbles do not age.");
}

}  // namespace

const Schema<Foam>& foam_schema() {
  static const Schema<Foam> schema{
      number("amount", &Foam::amount, between(0, 1000)).says("Times everything that is emitted: the key to turn."),
      names_of_things("of", &Foam::of, "material")
          .no_default()
          .says(
              "Which matter foams; absent: every liquid of at most 0.1 Pa s, and `snow` and `sand`, which give dust."),
      number("rate", &Foam::rate, above_zero("1/(m^3 s)"))
          .says("What a cause emits of a volume at its upper limit; absent: 5000 a second in the cube of `scale`."),
      number("scale", &Foam::scale, above_zero("m"))
          .says("The length over which motion is compared, at least a cell; absent: a 16th of the side of a cube of "
                "all foaming matter."),
      number("radius", &Foam::radius, above_zero("m"))
          .says("The mean radius, from half of which to one and a half of which there are all; absent: a 20th of "
                "`scale`."),
      limits("speed", &Foam::speed, "m/s").says("How fast matter must be, whatever the cause."),
      source("trapped_air", &Foam::trapped_air, "m/s")
          .says("Matter that meets matter or whirls: velocities that differ within `scale`."),
      source("crest", &Foam::crest, "1/m").says("Sharp waves of liquids that move the way they point: the curvature."),
      source("vorticity", &Foam::vorticity, "m/s").says("Eddies at the surface: the vorticity times `scale`."),
      count("most", &Foam::most, 1, 100000000).says("The most that are there at once; more are thinned out by lot."),
      life(),
      number("grow", &Foam::grow, between(0, 1e6, "s")).says("How long a radius grows after birth."),
      number("fade", &Foam::fade, between(0.001, 1e6, "s")).says("How long a radius shrinks before the end."),
      number("rise", &Foam::rise, at_least_zero("m/s"))
          .says("The speed at which bubbles rise in matter at rest; absent: by their radius in water."),
      number("drag", &Foam::drag, between(0, 1000))
          .says("Times the drag of air on a drop of that radius; 0: spray flies as in a vacuum."),
      color("color", &Foam::color).says("In sRGB; dust has the color of its matter."),
  };
  return schema;
}

Field<model::Scene> foam() {
  return Field<model::Scene>{"foam",
                             [](Reading& in, const YamlNode& n, const std::string& path, model::Scene& out) {
                               read_map(in, n, path, foam_schema(), out.foam.emplace());
                             },
                             [](const model::Scene& s, const std::string& k, YamlNode& map) {
                               if (s.foam) map.put(k, write_map(*s.foam, foam_schema()));
                             }}
      .takes(map_of(foam_schema()))
      .says("Spray, foam, bubbles and dust, made of the frames of a run; absent: none. `foam: {}` has all defaults.");
}

FoamKind foam_kind(const model::Material& material) {
  if (info_of(material).liquid) return FoamKind::water;
  // What comes apart into grains; jelly does not, and a liquid is its own.
  return material.type == "snow" || material.type == "sand" ? FoamKind::dust : FoamKind::none;
}

bool foams(const model::Foam& foam, const model::Material& material) {
  if (foam_kind(material) == FoamKind::none) return false;
  if (!foam.of.empty()) return std::find(foam.of.begin(), foam.of.end(), material.name) != foam.of.end();
  // Thick liquids, as honey, fold over air and do not break up into bubbles.
  constexpr double thick = 0.1;  // Pa s
  return !material.values.has("viscosity") || material.values["viscosity"] <= thick;
}

std::vector<int> foaming_materials(const model::Scene& scene) {
  std::vector<int> list;
  if (!scene.foam) return list;
  for (std::size_t m = 0; m < scene.materials.size(); ++m)
    if (foams(*scene.foam, scene.materials[m])) list.push_back(static_cast<int>(m));
  return list;
}

namespace {

/// Reports lengths that no motion in the scene's box has.
void check_lengths(Reading& in, const YamlNode& foam, const model::Scene& scene) {
  const Vec3d box = scene.space.end() - scene.space.min;
  const double widest = std::max({box.x, box.y, box.z}), cell = scene.space.dx();
  const auto check = [&](const char* key, const std::optional<double>& value, double least, double most,
                         const char* what) {
    if (const YamlNode* n = foam.find(key); n && value && (*value < least || *value > most))
      in.problems.error(n->at, fmt::format("foam.{} is {}: must be between {:.4g} and {:.4g} m, {}", key, n->text,
                                           least, most, what));
  };
  check("scale", scene.foam->scale, 0.05 * cell, widest, "a 20th of a cell and the longest side of the box");
  check("radius", scene.foam->radius, 1e-6, 0.1 * widest, "a micrometer and a tenth of the longest side of the box");
}

}  // namespace

void check_foam(Reading& in, const YamlNode* foam, const model::Scene& scene) {
  if (!foam || !scene.foam || !foam->is_map()) return;
  check_lengths(in, *foam, scene);
  std::vector<std::string> names;
  for (const Material& m : scene.materials) names.push_back(m.name);
  if (const YamlNode* of = foam->find("of"); of && of->kind == YamlNode::Kind::list) {
    for (const YamlNode& n : of->items) {
      const auto found = std::find(names.begin(), names.end(), n.text);
      if (found == names.end())
        in.problems.error(n.at, fmt::format("foam.of: no material '{}'{}", n.text, suggest(n.text, names)));
      else if (const Material& m = scene.materials[static_cast<std::size_t>(found - names.begin())];
               foam_kind(m) == FoamKind::none)
        in.problems.error(
            n.at,
            fmt::format("foam.of: '{}' is {}, a solid that does not foam: liquids, snow and sand do", n.text, m.type));
    }
  } else if (!scene.materials.empty() && foaming_materials(scene).empty()) {
    in.problems.error(foam->at, "foam: no material foams: liquids, snow and sand do");
  }
}

}  // namespace dreampm::scene

// space, time: where and when.
#include <cmath>
#include <map>

#include "dreampm/physics/dt.h"
#include "dreampm/physics/projection/time_step.h"
#include "dreampm/scene/sections.h"

namespace dreampm::scene {
namespace {

struct WallGroup {
  const char* key;
  std::vector<int> walls;  ///< as Side numbers them
};
/// The groups of walls from general to special: a later one wins, key by key.
const std::vector<WallGroup>& wall_groups() {
  static const std::vector<WallGroup> groups{
      {"all", {0, 1, 2, 3, 4, 5}},
      {"sides", {0, 1, 4, 5}},
      {"floor", {2}},
      {"ceiling", {3}},
      {"x_min", {0}},
      {"x_max", {1}},
      {"y_min", {2}},
      {"y_max", {3}},
      {"z_min", {4}},
      {"z_max", {5}},
  };
  return groups;
}

bool rubs(WallType t) { return t == WallType::separate || t == WallType::slip; }

/// An axis is periodic as a whole, so no wall is.
Field<Wall> wall_type() {
  Field<Wall> f = choice("type", &Wall::type, wall_type_words());
  f.read = [plain = f.read](Reading& in, const YamlNode& n, const std::string& path, Wall& out) {
    if (n.text == "periodic")
      return in.problems.error(n.at, fmt::format("{} is 'periodic': both ends of an axis are; say it as in "
                                                 "space.periodic: [x, z]",
                                                 path));
    plain(in, n, path, out);
  };
  return f;
}

}  // namespace

const Schema<Wall>& wall_schema() {
  static const Schema<Wall> schema{
      wall_type().says(
          "Matter may leave a wall of type `separate`, glides along `slip`, sticks to `stick`, and passes `open`."),
      number("friction", &Wall::friction, between(0, 100))
          .when([](const Wall& w) { return rubs(w.type); }, "type separate and slip")
          .says("Coulomb's coefficient."),
      flag("skin_friction", &Wall::skin_friction)
          .when([](const Wall& w) { return rubs(w.type); }, "type separate and slip")
          .says("Whether the wall slows liquids as a smooth wall with a thin boundary layer does."),
  };
  return schema;
}

namespace {

void read_walls(Reading& in, const YamlNode& node, const std::string& path, Space& out) {
  Problems& problems = in.problems;
  if (!expect_map(problems, node, path)) return;
  std::vector<std::string> keys;
  for (const WallGroup& g : wall_groups()) {
    keys.push_back(g.key);
    const YamlNode* value = node.find(g.key);
    if (!value) continue;
    for (const int i : g.walls) {
      Wall& wall = out.walls[std::size_t(i)];
      // Another type starts anew: friction of `all` means nothing to a sticking floor.
      if (const YamlNode* type = value->find("type"); type && (type->text == "stick" || type->text == "open"))
        wall = {};
      read_map(in, *value, fmt::format("{}.{}", path, g.key), wall_schema(), wall);
    }
  }
  for (const Entry& e : node.entries)
    if (std::find(keys.begin(), keys.end(), e.key) == keys.end())
      problems.error(e.at, fmt::format("unknown key '{}.{}'{}", path, e.key, suggest(e.key, keys)));
  for (const auto& [name, same] : {std::pair{"floor", "y_min"}, std::pair{"ceiling", "y_max"}})
    if (node.find(name) && node.find(same))
      problems.error(
          std::find_if(node.entries.begin(), node.entries.end(), [&](const Entry& e) { return e.key == same; })->at,
          fmt::format("{0}.{1} is the same wall as {0}.{2}: give one of them", path, same, name));
}

MapInfo walls_info() {
  static const std::map<std::string, std::string> meanings{
      {"all", "All six walls; more special keys win."},
      {"sides", "The four upright walls."},
      {"floor", "The lower wall, y_min."},
      {"ceiling", "The upper wall, y_max."},
      {"x_min", "The wall at the low end of x."},
      {"x_max", "The wall at the high end of x."},
      {"y_min", "The lower wall."},
      {"y_max", "The upper wall."},
      {"z_min", "The wall at the low end of z."},
      {"z_max", "The wall at the high end of z."},
  };
  MapInfo info;
  for (const WallGroup& g : wall_groups())
    info.keys.push_back({g.key, map_of(wall_schema(), "wall"), meanings.at(g.key), {}});
  return info;
}

void write_walls(const Space& space, const std::string& key, YamlNode& map) {
  YamlNode walls = YamlNode::map();
  for (std::size_t i = 0; i < side_names.size(); ++i)
    if (!space.periodic[i / 2]) walls.put(std::string(side_names[i]), write_map(space.walls[i], wall_schema()));
  if (!walls.entries.empty()) map.put(key, std::move(walls));
}

const std::vector<std::string>& axis_words() {
  static const std::vector<std::string> words{"x", "y", "z"};
  return words;
}

void read_periodic(Reading& in, const YamlNode& node, const std::string& path, Space& out) {
  if (!expect_list(in.problems, node, path)) return;
  for (std::size_t i = 0; i < node.items.size(); ++i) {
    const auto w = read_word(in.problems, node.items[i], fmt::format("{}[{}]", path, i), axis_words());
    if (!w) continue;
    bool& axis = out.periodic[static_cast<std::size_t>((*w)[0] - 'x')];
    if (axis) in.problems.error(node.items[i].at, fmt::format("{} has '{}' twice", path, *w));
    axis = true;
  }
}

void write_periodic(const Space& space, const std::string& key, YamlNode& map) {
  std::vector<YamlNode> axes;
  for (std::size_t a = 0; a < 3; ++a)
    if (space.periodic[a]) axes.push_back(YamlNode::scalar(axis_words()[a]));
  if (!axes.empty()) map.put(key, YamlNode::list(std::move(axes)));
}

/// A wall that a scene names by itself cannot be on a periodic axis; those of `all` and `sides`
/// there are none.
void check_periodic_walls(Reading& in, const YamlNode& walls, const Space& space) {
  if (!walls.is_map()) return;
  for (const WallGroup& g : wall_groups()) {
    const auto axis = static_cast<std::size_t>(g.walls.front() / 2);
    if (g.walls.size() > 1 || !space.periodic[axis]) continue;
    for (const Entry& e : walls.entries)
      if (e.key == g.key)
        in.problems.error(e.at, fmt::format("space.walls.{} is on the periodic axis {}: there is no wall", g.key,
                                            axis_words()[axis]));
  }
}

Field<Time> seconds() {
  return Field<Time>{"seconds",
                     [](Reading& in, const YamlNode& n, const std::string& path, Time& out) {
                       const auto s = read_number(in.problems, n, path, above_zero("s"));
                       if (!s) return;
                       const double frames = std::ceil(*s * out.fps - 1e-6);
                       if (frames > 1e6)
                         in.problems.error(n.at, fmt::format("{} is {}: {} frames at {} a second, more than 1000000",
                                                             path, n.text, frames, out.fps));
                       else
                         out.frames = std::max(1, int(frames));
                     },
                     {}}
      .takes(number_info(above_zero("s")));
}

}  // namespace

const std::vector<std::string>& wall_type_words() {
  static const std::vector<std::string> words{wall_type_names.begin(), wall_type_names.end()};
  return words;
}

const Schema<Space>& space_schema() {
  static const Schema<Space> schema{
      vector("min", &Space::min, any_number("m")).says("The low corner of the box that matter moves in."),
      vector("max", &Space::max, any_number("m"))
          .must()
          .says("The high corner; each side is rounded up to whole cells from `min`."),
      number("spacing", &Space::spacing, above_zero("m"))
          .must()
          .says("The distance between particles. It sets the resolution of everything."),
      number("particles_per_cell", &Space::particles_per_cell, between(1, 64))
          .says("Particles in a cell of the grid: dx = spacing * cbrt(particles_per_cell)."),
      Field<Space>{"walls", read_walls, write_walls}
          .takes(map_of(walls_info))
          .says("What the six sides of the box do to matter."),
      Field<Space>{"periodic", read_periodic, write_periodic}
          .takes(list_info(word_info(axis_words()), 0, 3))
          .says("Axes whose two ends meet; they have no walls, and are rounded up to whole blocks of 4 cells."),
  };
  return schema;
}

void finish_space(Reading& in, const YamlNode& node, Space& space) {
  const YamlNode* max = node.find("max");
  if (const YamlNode* walls = node.find("walls")) check_periodic_walls(in, *walls, space);
  for (std::size_t w = 0; w < space.walls.size(); ++w)
    if (space.periodic[w / 2]) space.walls[w] = {WallType::open};
  for (int i = 0; i < 3; ++i) {
    const double length = space.max[i] - space.min[i];
    if (!(length > 0)) {
      const Place& at = max && max->items.size() == 3 ? max->items[std::size_t(i)].at : node.at;
      in.problems.error(at, fmt::format("space.max[{0}] is {1}: must be above space.min[{0}], which is {2}", i,
                                        space.max[i], space.min[i]));
      continue;
    }
    constexpr double most = 1e9;  // a double is right to 1e-7 of a spacing there, as a particle's place in its cell
    const double far = std::max(std::abs(space.min[i]), std::abs(space.max[i])) / space.spacing;
    if (far > most)
      in.problems.error(node.at,
                        fmt::format("space reaches to {:.3g} spacings from the origin along {}: at most {:.3g} "
                                    "are possible, since numbers have no more digits",
                                    far, "xyz"[i], most));
    if (const double cells = space.cells_along(i); cells > 100000) {
      const YamlNode* spacing = node.find("spacing");
      in.problems.error(spacing ? spacing->at : node.at,
                        fmt::format("space.spacing is {}: gives {:.0f} cells along {}, at most 100000 are possible",
                                    space.spacing, cells, "xyz"[i]));
    }
  }
}

/// A fixed step and where it stands: how long it may be is known once the scene is filled.
Field<Time> fixed_dt() {
  Field<Time> f = number("dt", &Time::dt, {0, 1, true, false, "s"});
  f.read = [read = f.read](Reading& in, const YamlNode& n, const std::string& path, Time& out) {
    read(in, n, path, out);
    in.marks[path] = {n.at.line, n.at.column};
  };
  return f;
}

/// The field `solver`, before `cfl`, whose range and default it sets.
Field<Time> solver() {
  Field<Time> f = choice("solver", &Time::solver, {"explicit", "projection"});
  f.read = [plain = f.read](Reading& in, const YamlNode& n, const std::string& path, Time& out) {
    plain(in, n, path, out);
    if (out.solver == SolverKind::projection) out.cfl = usual_projection_cfl;
  };
  return written_when<Time>(std::move(f), [](const Time& t) { return t.solver != SolverKind::explicit_steps; });
}

Field<Time> cfl() {
  const Range of_all{0, largest_projection_cfl, true, false, ""};
  Field<Time> f = number("cfl", &Time::cfl, of_all);
  const Field<Time> of_explicit = number("cfl", &Time::cfl, {0, largest_cfl, true, false, ""});
  f.read = [all = f.read, few = of_explicit.read](Reading& in, const YamlNode& n, const std::string& path, Time& out) {
    (out.solver == SolverKind::projection ? all : few)(in, n, path, out);
  };
  return written_when<Time>(std::move(f), [](const Time& t) { return !t.dt; });
}

const Schema<Time>& time_schema() {
  static const Schema<Time> schema{
      number("fps", &Time::fps, between(0.001, 10000))  // what a video takes
          .takes(number_info(between(0.001, 10000, "1/s")))
          .says("Frames a second, of the simulation and of the video."),
      count("frames", &Time::frames, 1, 1000000).says("How many frames; frame 1 is the start."),
      seconds().says("The length of the film, in place of `frames`."),
      solver().says("How steps are made. `explicit`: of all materials, as short as sound asks for. `projection`: "
                    "liquids may cross cells in a step, for a pressure keeps their volume, and what lies in them "
                    "takes explicit ones between."),
      cfl().says(
          "Cells that sound or matter may cross in a step: at most 0.5, and of the projection that matter may cross, 2 "
          "unless given."),
      fixed_dt().says("A fixed time step; without it each step is chosen by `cfl`."),
      number("dt_max", &Time::dt_max, {0, 1, true, false, "s"}).says("The longest step that may be chosen."),
      number("damping", &Time::damping, at_least_zero())
          .takes(number_info(at_least_zero("1/s")))
          .says("Velocities decay as exp(-damping t)."),
      written_when<Time>(flag("surface_contact", &Time::surface_contact),
                         [](const Time& t) { return !t.surface_contact; })
          .says("Contact at the surfaces of colliders; `false`: at the grid's nodes, for comparison."),
  };
  return schema;
}

}  // namespace dreampm::scene

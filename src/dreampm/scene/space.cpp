// space, time: where and when.
#include <cmath>

#include "dreampm/physics/dt.h"
#include "dreampm/scene/sections.h"

namespace dreampm::scene {
namespace {

struct WallGroup {
  const char* key;
  std::vector<int> walls;
};
/// From general to special: a later one wins, key by key.
const std::vector<WallGroup>& wall_groups() {
  static const std::vector<WallGroup> groups{
      {"all", {0, 1, 2, 3, 4, 5}}, {"sides", {x_min, x_max, z_min, z_max}},
      {"floor", {y_min}},          {"ceiling", {y_max}},
      {"x_min", {x_min}},          {"x_max", {x_max}},
      {"y_min", {y_min}},          {"y_max", {y_max}},
      {"z_min", {z_min}},          {"z_max", {z_max}},
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

const Schema<Wall>& wall_schema() {
  static const Schema<Wall> schema{
      wall_type(),
      number("friction", &Wall::friction, between(0, 100))
          .when([](const Wall& w) { return rubs(w.type); }, "type separate and slip"),
      flag("skin_friction", &Wall::skin_friction)
          .when([](const Wall& w) { return rubs(w.type); }, "type separate and slip"),
  };
  return schema;
}

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

void write_walls(const Space& space, const std::string& key, YamlNode& map) {
  YamlNode walls = YamlNode::map();
  for (std::size_t i = 0; i < wall_names.size(); ++i)
    if (!space.periodic[i / 2]) walls.put(wall_names[i], write_map(space.walls[i], wall_schema()));
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
  return {"seconds",
          [](Reading& in, const YamlNode& n, const std::string& path, Time& out) {
            const auto s = read_number(in.problems, n, path, above_zero("s"));
            if (!s) return;
            const double frames = std::ceil(*s * out.fps - 1e-6);
            if (frames > 1e6)
              in.problems.error(n.at, fmt::format("{} is {}: {} frames at {} a second, more than 1000000", path, n.text,
                                                  frames, out.fps));
            else
              out.frames = std::max(1, int(frames));
          },
          {}};
}

}  // namespace

const std::vector<std::string>& wall_type_words() {
  static const std::vector<std::string> words{"separate", "slip", "stick", "open"};
  return words;
}

const Schema<Space>& space_schema() {
  static const Schema<Space> schema{
      vector("min", &Space::min),
      vector("max", &Space::asked_max).must(),
      number("spacing", &Space::spacing, above_zero("m")).must(),
      number("particles_per_cell", &Space::particles_per_cell, between(1, 64)),
      {"walls", read_walls, write_walls},
      {"periodic", read_periodic, write_periodic},
  };
  return schema;
}

void finish_space(Reading& in, const YamlNode& node, Space& space) {
  constexpr double block = 4;  // cells: the grid wraps by whole blocks
  const YamlNode* max = node.find("max");
  if (const YamlNode* walls = node.find("walls")) check_periodic_walls(in, *walls, space);
  for (std::size_t w = 0; w < space.walls.size(); ++w)
    if (space.periodic[w / 2]) space.walls[w] = {WallType::open};
  for (int i = 0; i < 3; ++i) {
    const double length = space.asked_max[i] - space.min[i];
    if (!(length > 0)) {
      const Place& at = max && max->items.size() == 3 ? max->items[std::size_t(i)].at : node.at;
      in.problems.error(at, fmt::format("space.max[{0}] is {1}: must be above space.min[{0}], which is {2}", i,
                                        space.asked_max[i], space.min[i]));
      continue;
    }
    constexpr double most = 1e9;  // a double is right to 1e-7 of a spacing there, as a particle's place in its cell
    const double far = std::max(std::abs(space.min[i]), std::abs(space.asked_max[i])) / space.spacing;
    if (far > most)
      in.problems.error(node.at,
                        fmt::format("space reaches to {:.3g} spacings from the origin along {}: at most {:.3g} "
                                    "are possible, since numbers have no more digits",
                                    far, "xyz"[i], most));
    // The slack keeps a length that is whole but for rounding from growing by a cell.
    double cells = std::max(1.0, std::ceil(length / space.dx() - 1e-6));
    if (space.periodic[std::size_t(i)]) cells = block * std::ceil(cells / block);
    if (cells > 100000) {
      const YamlNode* spacing = node.find("spacing");
      in.problems.error(spacing ? spacing->at : node.at,
                        fmt::format("space.spacing is {}: gives {:.0f} cells along {}, at most 100000 are possible",
                                    space.spacing, cells, "xyz"[i]));
    }
    space.max[i] = space.min[i] + cells * space.dx();
  }
}

/// A fixed step and where it stands: how long it may be is known once the scene is filled.
Field<Time> fixed_dt() {
  Field<Time> f = optional_number("dt", &Time::dt, {0, 1, true, false, "s"});
  f.read = [read = f.read](Reading& in, const YamlNode& n, const std::string& path, Time& out) {
    read(in, n, path, out);
    out.dt_mark = {n.at.line, n.at.column};
  };
  return f;
}

const Schema<Time>& time_schema() {
  static const Schema<Time> schema{
      number("fps", &Time::fps, between(0.001, 10000)),  // what a video takes
      count("frames", &Time::frames, 1, 1000000),
      seconds(),
      written_when<Time>(number("cfl", &Time::cfl, {0, largest_cfl, true, false, ""}),
                         [](const Time& t) { return !t.dt; }),
      fixed_dt(),
      optional_number("dt_max", &Time::dt_max, {0, 1, true, false, "s"}),
      number("damping", &Time::damping, at_least_zero()),
      written_when<Time>(flag("surface_contact", &Time::surface_contact),
                         [](const Time& t) { return !t.surface_contact; }),
  };
  return schema;
}

}  // namespace dreampm::scene

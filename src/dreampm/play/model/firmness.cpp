#include "dreampm/play/model/firmness.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <utility>

namespace dreampm::play {
namespace {

constexpr std::string_view keys[] = {"youngs_modulus", "poissons_ratio", "density"};

/// What stands over a square of the ground, as gravity has it.
struct Column {
  double lowest = std::numeric_limits<double>::max();  ///< m, upward: of the material in question
  Vec3d at{};                                          ///< m: there
  double above = 0, own = 0;                           ///< kg
};

/// The axis that gravity is nearest to, and which way is up along it.
struct Up {
  int axis = 1;
  double sign = 1;
  explicit Up(const Vec3d& gravity) {
    for (int a = 0; a < 3; ++a)
      if (std::abs(gravity[a]) > std::abs(gravity[axis])) axis = a;
    sign = gravity[axis] > 0 ? -1 : 1;
  }
  double height(const Vec3d& x) const { return sign * x[axis]; }
};

/// m: from that place down to the nearest collider, or to the side of the box.
double way_down(const std::vector<ColliderShape>& colliders, double cell, const Up& up, const model::Space& space,
                const Vec3d& from) {
  const double floor = up.sign > 0 ? space.min[up.axis] : -space.end()[up.axis];
  const double whole = std::max(0.0, up.height(from) - floor);
  constexpr int most_looks = 64;
  double way = 0;
  for (int n = 0; n < most_looks && way < whole; ++n) {
    Vec3d x = from;
    x[up.axis] -= up.sign * way;
    double near = std::numeric_limits<double>::max();
    for (const ColliderShape& c : colliders) near = std::min(near, c.distance(x));
    if (near < cell) break;
    way += near;
  }
  return std::min(way, whole);
}

Press press_on(const Simulation& simulation, const std::string& material, const std::vector<ColliderShape>& colliders,
               const Up& up, const model::Space& space) {
  const int u = (up.axis + 1) % 3, v = (up.axis + 2) % 3;
  const double side = simulation.stepping().cell;
  const auto square = [&](const Vec3d& x) {
    return std::pair{static_cast<std::int64_t>(std::floor(x[u] / side)),
                     static_cast<std::int64_t>(std::floor(x[v] / side))};
  };
  std::map<std::pair<std::int64_t, std::int64_t>, Column> columns;
  Press press;
  const auto count = static_cast<double>(simulation.particle_count(material));
  simulation.visit(material, {.velocity = true}, [&](const ParticleBatch& some) {
    for (std::size_t i = 0; i < some.size(); ++i) {
      const Vec3d& x = some.position[i];
      Column& c = columns[square(x)];
      if (up.height(x) < c.lowest) c.lowest = up.height(x), c.at = x;
      press.speed2 += length2(some.velocity[i]) / count;
    }
  });
  for (const std::string& other : simulation.scene().materials()) {
    const double mass = simulation.material(other).particle_mass;
    simulation.visit(other, {}, [&](const ParticleBatch& some) {
      for (const Vec3d& x : some.position) {
        const auto c = columns.find(square(x));
        if (c == columns.end() || up.height(x) < c->second.lowest) continue;
        (other == material ? c->second.own : c->second.above) += mass;
      }
    });
  }
  for (const auto& [at, c] : columns) {
    double above = (c.above + c.own) / (side * side);
    for (const ColliderShape& body : colliders) {
      if (!body.is_rigid()) continue;
      const Box3d box = body.bounds();
      if (c.at[u] < box.min[u] || c.at[u] > box.max[u] || c.at[v] < box.min[v] || c.at[v] > box.max[v]) continue;
      if (up.height(box.center()) > c.lowest) above += body.mass() / (box.size()[u] * box.size()[v]);
    }
    if (above > press.above) press.above = above, press.own = c.own / (side * side);
    press.fall = std::max(press.fall, way_down(colliders, side, up, space, c.at));
  }
  return press;
}

}  // namespace

bool is_elastic(const model::Material& m) {
  return m.type == "elastic" || m.type == "neo_hookean" || (m.type == "seed" && m.values["elastic"] != 0);
}

bool is_of_firmness(std::string_view key) { return std::find(std::begin(keys), std::end(keys), key) != std::end(keys); }

std::vector<std::optional<Press>> presses_on(const Simulation& simulation) {
  const model::Scene& scene = simulation.scene().model();
  std::vector<std::optional<Press>> presses(scene.materials.size());
  const auto is_asked = [&](std::size_t m) {
    return is_elastic(scene.materials[m]) && simulation.particle_count(scene.materials[m].name) > 0;
  };
  std::vector<std::size_t> asked;
  for (std::size_t m = 0; m < presses.size(); ++m)
    if (is_asked(m)) asked.push_back(m);
  if (asked.empty()) return presses;
  const std::vector<ColliderShape> colliders = simulation.collider_shapes();
  for (const std::size_t m : asked)
    presses[m] = press_on(simulation, scene.materials[m].name, colliders, Up(scene.gravity), scene.space);
  return presses;
}

}  // namespace dreampm::play

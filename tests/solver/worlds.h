// Small worlds for tests, made by hand.
#pragma once
#include <cmath>
#include <vector>

#include "dreampm/backend/cpu/cpu.h"
#include "dreampm/backend/reference/reference.h"
#include "dreampm/physics/materials.h"
#include "dreampm/solver/motion_by_id.h"
#include "dreampm/solver/step.h"
#include "validate/measure/motion.h"

namespace dreampm::test {
using validate::Field;
using validate::positions_by_id;
using validate::set_motion;

/// Values of a material's table with some of them given.
inline Values values_of(std::string_view material, std::initializer_list<std::pair<std::string_view, double>> given) {
  Values v;
  for (const auto& [key, value] : given) v.set(key, value);
  v.with_defaults(find_material(material)->params);
  return v;
}

/// A box of `cells` cells with its low corner at the origin.
template <class R>
World<R> empty_world(double dx, Vec3i cells, WallType walls = WallType::separate) {
  World<R> w;
  w.dx = dx;
  w.high = cells;
  w.walls.fill({walls, 0});
  w.settings.fps = 1e3;
  return w;
}

/// Adds a set whose particles have volume spacing^3.
template <class R>
std::size_t add_set(World<R>& w, std::string_view material, Values values, double spacing) {
  ParticleSet<R> set;
  set.name = set.material = std::string(material);
  set.liquid = find_material(material)->liquid;
  set.rest_volume = spacing * spacing * spacing;
  set.mass = values["density"] * set.rest_volume;
  set.values = std::move(values);
  w.sets.push_back(std::move(set));
  return w.sets.size() - 1;
}

/// A lattice of particles in the box, ids from `first`, moving as the field says.
inline std::vector<ParticleSeed> lattice(const Box3d& box, double spacing, const Field& velocity,
                                         std::uint32_t first = 0) {
  std::vector<ParticleSeed> all;
  const auto count = [&](double length) { return static_cast<int>(std::lround(length / spacing)); };
  const Vec3d size = box.size();
  for (int i = 0; i < count(size.x); ++i)
    for (int j = 0; j < count(size.y); ++j)
      for (int k = 0; k < count(size.z); ++k) {
        const Vec3d p = box.min + Vec3d{i + 0.5, j + 0.5, k + 0.5} * spacing;
        ParticleSeed n{first + static_cast<std::uint32_t>(all.size()), p, {}, {}};
        set_motion(n, velocity, spacing * 1e-3);
        all.push_back(n);
      }
  return all;
}

inline Field still() {
  return [](const Vec3d&) { return Vec3d{}; };
}

}  // namespace dreampm::test

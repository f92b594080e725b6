#include "bench/scenes.h"

#include <algorithm>
#include <cmath>

#include "dreampm/base/error.h"
#include "dreampm/base/parallel.h"
#include "dreampm/math/rng.h"
#include "dreampm/physics/materials.h"

namespace dreampm {
namespace {

constexpr double cells_per_step = 0.05;  ///< a sort every 18 or 19 steps; the fastest of a collapsing column

/// An empty domain for matter of `material`, a liquid as stiff as `depth` cells of it need.
World<float> domain_of(const MaterialInfo& material, const Vec3i& cells, int depth) {
  World<float> w;
  w.dx = bench_dx;
  w.set_domain(cells);
  w.gravity = {0, -9.81, 0};
  ParticleSet<float> set;
  set.name = set.material = std::string(material.name);
  set.liquid = material.liquid;
  set.values.with_defaults(material.params);
  if (material.find("bulk_modulus") && !set.values.has("bulk_modulus")) {
    const double c2 = 2 * 9.81 * depth * bench_dx / set.values["max_compression"];
    set.values.set("bulk_modulus", set.values["density"] * c2);
  }
  set.rest_volume = std::pow(bench_dx / 2, 3);
  set.mass = set.values["density"] * set.rest_volume;
  w.sets.push_back(std::move(set));
  return w;
}

/// Eight particles in each cell of the box, shaken by up to an eighth of a cell, all at one
/// velocity.
void fill(BenchScene& scene, const Vec3i& first, const Vec3i& cells, const Vec3d& velocity) {
  std::vector<ParticleSeed>& all = scene.seeds.at(0);
  const std::size_t there = all.size(), wide = static_cast<std::size_t>(2 * cells.x),
                    high = static_cast<std::size_t>(2 * cells.y), deep = static_cast<std::size_t>(2 * cells.z);
  all.resize(there + wide * high * deep);
  parallel_for(wide * high, 1 + 4096 / deep, [&](std::size_t column) {
    for (std::size_t k = 0; k < deep; ++k) {
      const std::size_t p = there + column * deep + k;
      const auto id = static_cast<std::uint32_t>(p);
      const auto at = [&](std::uint64_t axis, std::size_t n) {
        return 0.5 * (static_cast<double>(n) + 0.5) + 0.25 * (uniform(axis, id) - 0.5);
      };
      const Vec3d place = static_cast<Vec3d>(first) + Vec3d{at(1, column / high), at(2, column % high), at(3, k)};
      all[p] = {id, place * bench_dx, velocity, {}};
    }
  });
}

/// The speed [m/s] at which matter moves `cells_per_step`: v dt/dx with dt = cfl dx/(c + v).
double speed_of(const World<float>& world, const MaterialInfo& material) {
  const double c = facts_of(material, world.sets[0].values).sound_speed;
  return c * cells_per_step / (world.settings.cfl - cells_per_step);
}

}  // namespace

BenchScene column_scene(const MaterialInfo& material, const Vec3i& cells) {
  BenchScene scene{domain_of(material, {2 * cells.x, cells.y + cells.y / 2 + 2, cells.z}, cells.y), {{}}};
  fill(scene, {}, cells, {speed_of(scene.world, material), 0, 0});
  return scene;
}

BenchScene tank_scene(const MaterialInfo& material, const Vec3i& cells) {
  BenchScene scene{domain_of(material, {cells.x, cells.y + cells.y / 2 + 2, cells.z}, cells.y), {{}}};
  fill(scene, {}, cells, {});
  return scene;
}

BenchScene droplets_scene(const MaterialInfo& material, std::uint64_t count) {
  constexpr int apart = 8;
  const int n = std::max(1, static_cast<int>(std::ceil(std::cbrt(static_cast<double>(count)))));
  BenchScene scene{domain_of(material, {n * apart, n * apart, n * apart}, 64), {{}}};
  const Vec3d velocity{0, -speed_of(scene.world, material), 0};
  for (std::uint64_t d = 0; d < count; ++d) {
    const int index = static_cast<int>(d);
    const auto at = [&](int along, std::uint64_t axis) {
      return along * apart + 2 + static_cast<int>(4 * uniform(10 + axis, d));
    };
    fill(scene, {at(index / (n * n), 0), at(index / n % n, 1), at(index % n, 2)}, {1, 1, 1}, velocity);
  }
  return scene;
}

BenchScene drop_scene(const MaterialInfo& material, int width, const Vec3i& domain) {
  BenchScene scene{domain_of(material, domain, 64), {{}}};
  const Vec3i first{(domain.x - width) / 2, (domain.y - width) / 2, (domain.z - width) / 2};
  fill(scene, first, {width, width, width}, {0, -speed_of(scene.world, material), 0});
  return scene;
}

const MaterialInfo& bench_material(const std::string& name) {
  if (const MaterialInfo* material = find_material(name)) return *material;
  std::string names;
  for (const MaterialInfo& m : material_infos()) names += (names.empty() ? "" : ", ") + std::string(m.name);
  fail_input("--material {}: there is no such material; there are {}", name, names);
}

void check_particles(std::uint64_t particles) {
  if (particles < 64 || particles > 200000000) fail_input("--particles {}: give 64 to 200000000", particles);
}

Vec3i column_cells(std::uint64_t particles) {
  const double cells = static_cast<double>(particles) / 8;
  const int depth = std::max(1, static_cast<int>(std::lround(std::cbrt(cells / 4))));
  const int side = std::max(2, static_cast<int>(std::lround(std::sqrt(cells / depth))));
  return {side, side, depth};
}

}  // namespace dreampm

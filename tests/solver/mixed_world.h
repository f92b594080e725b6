// A small scene that touches all that a step does, and the way through it.
#pragma once
#include "worlds.h"

namespace dreampm::test {

inline constexpr double mixed_spacing = 0.01;

/// Values at which every material of the list is soft enough for steps of 1e-4 s.
inline Values soft(std::string_view name) {
  const MaterialInfo& info = *find_material(name);
  Values v;
  v.set("density", 1000);
  if (info.find("youngs_modulus")) v.set("youngs_modulus", 2e4);
  if (info.find("bulk_modulus")) v.set("bulk_modulus", 1e5);
  v.with_defaults(info.params);
  return v;
}

inline std::shared_ptr<const Region> sphere(const Vec3d& center, double radius) {
  Shape s;
  s.form = SphereShape{radius};
  s.center = center;
  return make_region(s, 0.01, {});
}

/// Matter of `name` and an elastic block thrown at each other over a sphere, in a box with walls of
/// every kind; the one presses on a wall where it sticks, the other on one that mirrors it.
template <class R>
World<R> mixed_world(std::string_view name, std::vector<std::vector<ParticleSeed>>& seeds) {
  World<R> w = empty_world<R>(0.02, {20, 20, 10});
  w.walls[0] = {WallType::slip, 0.2};
  w.walls[1] = {WallType::slip, 0};
  w.walls[2] = {WallType::separate, 0.3};
  w.walls[4] = {WallType::stick, 0};
  w.walls[5] = {WallType::slip, 0};
  w.gravity = {0, -9.81, 0};
  w.colliders.push_back({"ball", sphere({0.2, 0.06, 0.1}, 0.05), WallType::separate, 0.4});
  w.settings.fps = 100;
  w.settings.fixed_dt = 2e-4;
  add_set(w, name, soft(name), mixed_spacing);
  add_set(w, "elastic", soft("elastic"), mixed_spacing);
  w.sets[1].name = "block";
  const Field left = [](const Vec3d& p) { return Vec3d{1.5 - 3 * p.y, -1, -0.5}; };
  const Field right = [](const Vec3d&) { return Vec3d{-1, -1.5, 0.3}; };
  const auto a = lattice({{0.06, 0.12, 0}, {0.16, 0.22, 0.12}}, mixed_spacing, left);
  const auto b =
      lattice({{0.19, 0.12, 0.08}, {0.27, 0.21, 0.2}}, mixed_spacing, right, static_cast<std::uint32_t>(a.size()));
  seeds = {a, b};
  return w;
}

template <class R>
void advance(World<R>& w, Backend<R>& backend, int steps, Motion<R>* motion = nullptr) {
  for (int i = 0; i < steps; ++i) step<R>(w, backend, motion);
}

template <class R>
World<R> ran(std::string_view name, Backend<R>& backend, int steps) {
  std::vector<std::vector<ParticleSeed>> seeds;
  World<R> w = mixed_world<R>(name, seeds);
  begin(w, backend, seeds);
  advance(w, backend, steps);
  return w;
}

}  // namespace dreampm::test

// The cpu backend against the reference, and what must not change a bit: threads, output, place in space, a copy.
#include <gtest/gtest.h>

#include "dreampm/base/parallel.h"
#include "worlds.h"

namespace dreampm {
namespace {
using namespace test;

constexpr double spacing = 0.01;

/// Values at which every material of the list is soft enough for steps of 1e-4 s.
Values soft(std::string_view name) {
  const MaterialInfo& info = *find_material(name);
  Values v;
  v.set("density", 1000);
  if (info.find("youngs_modulus")) v.set("youngs_modulus", 2e4);
  if (info.find("bulk_modulus")) v.set("bulk_modulus", 1e5);
  v.with_defaults(info.params);
  return v;
}

std::shared_ptr<const Region> sphere(const Vec3d& centre, double radius) {
  Shape s;
  s.form = SphereShape{radius};
  s.center = centre;
  return make_region(s, 0.01, {});
}

/// Matter of `name` and an elastic block thrown at each other over a sphere, in a box with walls of every kind.
template <class R>
World<R> scene(std::string_view name, std::vector<std::vector<Newborn>>& newborns) {
  World<R> w = empty_world<R>(0.02, {20, 20, 16});
  w.walls[0] = {WallType::slip, 0.2};
  w.walls[1] = {WallType::slip, 0};
  w.walls[2] = {WallType::separate, 0.3};
  w.walls[4] = {WallType::stick, 0};
  w.gravity = {0, -9.81, 0};
  w.colliders.push_back({"ball", sphere({0.2, 0.06, 0.16}, 0.05), WallType::separate, 0.4});
  w.settings.fps = 100;
  w.settings.fixed_dt = 2e-4;
  add_set(w, name, soft(name), spacing);
  add_set(w, "elastic", soft("elastic"), spacing);
  w.sets[1].name = "block";
  const Field left = [](const Vec3d& p) { return Vec3d{1.5 - 3 * p.y, -1, 0.5}; };
  const Field right = [](const Vec3d&) { return Vec3d{-1, -1.5, -0.3}; };
  const auto a = lattice({{0.06, 0.12, 0.08}, {0.16, 0.22, 0.18}}, spacing, left);
  const auto b = lattice({{0.19, 0.12, 0.11}, {0.27, 0.21, 0.2}}, spacing, right, static_cast<std::uint32_t>(a.size()));
  newborns = {a, b};
  return w;
}

template <class R>
void advance(World<R>& w, Backend<R>& backend, int steps, Motion<R>* motion = nullptr) {
  for (int i = 0; i < steps; ++i) step<R>(w, backend, motion);
}

template <class R>
World<R> ran(std::string_view name, Backend<R>& backend, int steps) {
  std::vector<std::vector<Newborn>> newborns;
  World<R> w = scene<R>(name, newborns);
  begin(w, backend, newborns);
  advance(w, backend, steps);
  return w;
}

TEST(Backend, CpuFollowsTheReferenceForEveryMaterialAndInstructionSet) {
  for (const MaterialInfo& m : material_infos()) {
    const auto reference = make_reference_backend<float>();
    const auto want = positions_by_id(ran<float>(m.name, *reference, 200));
    std::vector<std::vector<Newborn>> newborns;
    const double dx = scene<float>(m.name, newborns).dx;
    double moved = 0;
    for (const auto& set : newborns)
      for (const Newborn& n : set) moved = std::max(moved, length(want[n.id] - n.position) / dx);
    EXPECT_GT(moved, 1) << m.name;
    for (const std::string_view isa : cpu_instruction_sets()) {
      const auto cpu = make_cpu_backend(isa);
      const auto got = positions_by_id(ran<float>(m.name, *cpu, 200));
      double sum = 0;
      for (std::size_t i = 0; i < want.size(); ++i) sum += length2(got[i] - want[i]) / (dx * dx);
      const double rms = std::sqrt(sum / static_cast<double>(want.size()));
      std::printf("%s on %s: %.2e cells rms\n", std::string(m.name).c_str(), std::string(isa).c_str(), rms);
      EXPECT_LE(rms, 1e-5) << m.name << " on " << isa;
    }
  }
}

TEST(Backend, ThreadsDoNotChangeABit) {
  for (const MaterialInfo& m : material_infos()) {
    std::vector<std::uint64_t> hashes;
    for (const int threads : {1, 2, 3, 8}) {
      const ThreadLimit limit(threads);
      const auto cpu = make_cpu_backend();
      hashes.push_back(state_hash(ran<float>(m.name, *cpu, 100)));
    }
    for (const auto h : hashes) EXPECT_EQ(h, hashes[0]) << m.name;
  }
}

TEST(Backend, LookingDoesNotChangeABit) {
  const auto a = make_cpu_backend(), b = make_cpu_backend();
  std::vector<std::vector<Newborn>> newborns;
  World<float> w = scene<float>("newtonian", newborns);
  w.settings.fps = 1000;
  World<float> v = w;
  begin(w, *a, newborns), begin(v, *b, newborns);
  Motion<float> motion;
  advance(w, *a, 100);
  advance(v, *b, 100, &motion);
  ASSERT_EQ(motion.sets.size(), 2u);
  EXPECT_EQ(motion.sets[0].velocity.size(), v.sets[0].size());
  EXPECT_EQ(state_hash(w), state_hash(v));
}

TEST(Backend, PlaceInSpaceDoesNotChangeABit) {
  const Vec3i far{4800, -4800, 4800};
  const auto a = make_cpu_backend(), b = make_cpu_backend();
  std::vector<std::vector<Newborn>> newborns;
  World<float> w = scene<float>("newtonian", newborns), v = w;
  v.low = v.low + far, v.high = v.high + far;
  begin(w, *a, newborns), begin(v, *b, newborns);
  advance(w, *a, 150), advance(v, *b, 150);
  EXPECT_EQ(state_hash(w), state_hash(v));
}

template <class R>
void check_copy(Backend<R>& first, Backend<R>& second) {
  World<R> w = ran<R>("newtonian", first, 70);
  EXPECT_GT(w.drift, 0);  // between sorts: the copy must not need one
  World<R> copy = w;
  second.adopt(copy);
  EXPECT_EQ(state_hash(copy), state_hash(w));
  advance(w, first, 80);
  advance(copy, second, 80);
  EXPECT_EQ(state_hash(copy), state_hash(w));
  EXPECT_EQ(copy.step, 150u);
}
TEST(Backend, ACopyWithAFreshBackendGoesTheSameWay) {
  check_copy<float>(*make_cpu_backend(), *make_cpu_backend());
  check_copy<double>(*make_reference_backend<double>(), *make_reference_backend<double>());
}

TEST(Backend, TheHashSeesOneBit) {
  const auto cpu = make_cpu_backend();
  World<float> w = ran<float>("newtonian", *cpu, 5);
  const auto before = state_hash(w);
  World<float> copy = w;
  copy.sets[0].u[1][17] = std::nextafter(copy.sets[0].u[1][17], 9.0f);
  EXPECT_NE(state_hash(copy), before);
  copy = w;
  copy.grid.nodes[copy.grid.nodes.size() / 2].m += 1e-3f;
  EXPECT_NE(state_hash(copy), before);
}

}  // namespace
}  // namespace dreampm

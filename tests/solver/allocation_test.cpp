// A step takes no memory, but for sorts and the step after one: everything it needs lies ready from the steps before.
// Counted by an operator new of this program alone.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <new>

#include "dreampm/base/parallel.h"
#include "worlds.h"

namespace {
std::atomic<long> allocations{0};

void* counted(std::size_t size, std::size_t alignment) {
  ++allocations;
  // aligned_alloc wants whole multiples.
  void* p = std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
  if (!p) throw std::bad_alloc();
  return p;
}
}  // namespace

void* operator new(std::size_t size) { return counted(size, alignof(std::max_align_t)); }
void* operator new(std::size_t size, std::align_val_t a) { return counted(size, static_cast<std::size_t>(a)); }
void operator delete(void* p) noexcept { std::free(p); }
void operator delete(void* p, std::size_t) noexcept { std::free(p); }
void operator delete(void* p, std::align_val_t) noexcept { std::free(p); }
void operator delete(void* p, std::size_t, std::align_val_t) noexcept { std::free(p); }

namespace dreampm {
namespace {
using namespace test;

TEST(Allocation, TheCounterSeesThreads) {
  const long before = allocations;
  parallel_for(2, 1, [](std::size_t) { delete new int(1); });
  EXPECT_GE(allocations - before, 2);
}

/// A block of `name` beside walls of both kinds that mirror, thrown; where `two` with an elastic one on top, in fields
/// of their own.
World<float> thrown(std::string_view name, bool two, std::vector<std::vector<Newborn>>& newborns) {
  const double dx = 0.02;
  World<float> w = empty_world<float>(dx, {20, 20, 10});
  w.walls[0] = {WallType::stick, 0};
  w.walls[1] = {WallType::slip, 0};
  w.gravity = {0, -9.81, 0};
  w.settings.fps = 50;
  const Field field = [](const Vec3d& p) { return Vec3d{1 - 3 * p.y, -1, -0.5}; };
  const auto add = [&](std::string_view material, const Box3d& box, std::uint32_t first) {
    Values v = values_of(material, {});
    if (find_material(material)->find("bulk_modulus") && !v.has("bulk_modulus")) v.set("bulk_modulus", 1e5);
    add_set<float>(w, material, v, dx / 2);
    newborns.push_back(lattice(box, dx / 2, field, first));
  };
  add(name, {{0, 0, 0}, {0.1, 0.2, 0.2}}, 0);
  if (two) add("elastic", {{0.02, 0.22, 0.02}, {0.1, 0.3, 0.18}}, static_cast<std::uint32_t>(newborns[0].size()));
  return w;
}

struct Found {
  long allocations = 0;
  int steps = 0, sorts = 0;
};

/// Steps after the first sort that are neither sorts nor follow one: there the grid has new blocks.
Found steps_between_sorts(std::string_view name, bool two) {
  std::vector<std::vector<Newborn>> newborns;
  World<float> w = thrown(name, two, newborns);
  const auto cpu = make_cpu_backend();
  begin(w, *cpu, newborns);
  Found found;
  bool after_sort = false;
  for (int i = 0; i < 160; ++i) {
    const double drift = w.drift;
    const long before = allocations;
    step<float>(w, *cpu, nullptr);
    const long now = allocations - before;
    const bool sorted = w.drift < drift;
    if (!sorted && !after_sort && found.sorts > 0) found.allocations += now, ++found.steps;
    found.sorts += sorted;
    after_sort = sorted;
  }
  return found;
}

TEST(Allocation, AStepTakesNoMemory) {
  const ThreadLimit limit(2);
  for (const MaterialInfo& m : material_infos())
    for (const bool two : {false, true}) {
      const Found found = steps_between_sorts(m.name, two);
      EXPECT_EQ(found.allocations, 0) << m.name << (two ? " and a solid" : "");
      EXPECT_GE(found.sorts, 2) << m.name;
      EXPECT_GE(found.steps, 50) << m.name;
    }
}

}  // namespace
}  // namespace dreampm

#include "dreampm/state/world_fields.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <limits>

#include "dreampm/pipeline/checkpoint.h"
#include "dreampm/setup/assemble.h"
#include "thrown.h"

namespace dreampm {
namespace {

using World64 = World<double>;

/// A member of a World, or of one of its sets, or of its grid, and how to change it.
struct Member {
  std::string name;
  FieldUse use;
  std::function<void(World64&)> change;
};

void change(double& v) { v = 0.5 * v + 0.3; }
void change(int& v) { v += 1; }
void change(std::uint64_t& v) { v += 1; }
void change(std::uint32_t& v) { v += 1; }
void change(bool& v) { v = !v; }
void change(std::string& v) { v += "x"; }
void change(Limiter& v) { v = v == Limiter::user ? Limiter::frame : Limiter::user; }
void change(SolverKind& v) { v = v == SolverKind::projection ? SolverKind::explicit_steps : SolverKind::projection; }
void change(Vec3d& v) { v.y += 0.125; }
void change(Vec3i& v) { v.y += 1; }
void change(Wall& v) { change(v.friction); }
void change(Key<Vec3d>& v) { change(v.t); }
void change(ForceField& v) { change(v.name); }
void change(Collider& v) { change(v.friction); }
void change(RigidBody& v) { change(v.mass); }
void change(CollisionShape& v) { change(v.shape.rotate_angle); }
void change(Emitter& v) { change(v.born); }
void change(Sink& v) { change(v.taken); }
void change(Arrival& v) { change(v.time); }
void change(Values& v) { v.set("viscosity", 0.5); }
void change(TransferRule<double>& v) { change(v.affine); }
void change(Node<double>& v) { v.m += 0.125; }
void change(BlockList& v) { v.assign({v[0] + Vec3i{0, 0, 1}}); }
void change(std::array<bool, 3>& v) { v[1] = !v[1]; }
template <class T, class Allocator>
void change(std::vector<T, Allocator>& v);
template <class T, std::size_t n>
void change(std::array<T, n>& v) {
  change(v[n - 1]);
}
template <class T, class Allocator>
void change(std::vector<T, Allocator>& v) {
  change(v.back());
}
/// Particles of the first block move to the second.
void move_to_second(std::vector<std::uint32_t>& block_start) { block_start[1] -= 1; }

/// Every member, from the lists.
std::vector<Member> members_of(World64& world) {
  std::vector<Member> all;
  const auto add = [&]<class F>(const F& field, const std::string& at, std::function<void(World64&)> change) {
    all.push_back({at + std::string(field.name), F::use, std::move(change)});
  };
  visit_fields(world, [&]<class F, class T>(const F& field, T&) {
    if constexpr (!std::is_same_v<T, std::vector<ParticleSet<double>>> && !std::is_same_v<T, GridFields<double>>)
      add(field, "", [name = field.name](World64& w) {
        visit_fields(w, [&]<class G, class U>(const G& its, U& value) {
          if constexpr (std::is_same_v<T, U>)
            if (its.name == name) change(value);
        });
      });
  });
  visit_fields(world.sets[0], [&]<class F, class T>(const F& field, T&) {
    add(field, "set/", [name = field.name](World64& w) {
      visit_fields(w.sets[0], [&]<class G, class U>(const G& its, U& value) {
        if constexpr (std::is_same_v<T, U>)
          if (its.name == name) its.name == "block_start" ? move_to_second(w.sets[0].block_start) : change(value);
      });
    });
  });
  visit_fields(world.grid, [&]<class F, class T>(const F& field, T&) {
    add(field, "grid/", [name = field.name](World64& w) {
      visit_fields(w.grid, [&]<class G, class U>(const G& its, U& value) {
        if constexpr (std::is_same_v<T, U>)
          if (its.name == name) change(value);
      });
    });
  });
  return all;
}

void fill_set(ParticleSet<double>& set, const std::string& name, const std::string& material, bool liquid,
              std::size_t columns, std::uint32_t first_id) {
  set.name = name, set.material = material, set.liquid = liquid;
  set.values.set("density", 1000);
  set.mass = 0.5, set.rest_volume = 0.25, set.transfer = {1, 0.9, 0};
  set.id = {first_id, first_id + 1, first_id + 2};
  set.block_start = {0, 2, 3};
  for (auto* part : {&set.u, &set.own_velocity})
    for (auto& axis : *part) axis = {0.5, 1.5, 2.5};
  for (auto& column : set.gradient) column = {0.25, 0.5, 0.75};
  set.carries_motion = true;
  set.state.assign(columns, {1, 1.25, 1.5});
}

/// Something in every member, and all arrays that a world may have.
World64 full_world() {
  World64 w;
  w.dx = 0.125;
  w.set_domain({8, 8, 8});
  w.gravity_keys = {{0.5, {0, -9, 0}}};
  w.fields = {{"breeze", {}, {}}};
  w.colliders = {{"post", nullptr, WallType::separate, 0, false}};
  w.rigid.resize(1), w.collision.resize(1);
  w.emitters.resize(1), w.emitters[0].name = "tap";
  w.arrivals = {{20, 3, 0, 0.25}, {23, 2, 0, 0.5}};
  w.sinks.resize(1), w.sinks[0].name = "drain";
  w.viscous_stages = 3, w.kept_kinetic_energy = 0.5, w.settings.sub_cycles = false;
  fill_set(w.sets.emplace_back(), "water", "newtonian", true, state_columns<Newtonian>, 0);
  fill_set(w.sets.emplace_back(), "jelly", "elastic", false, state_columns<Elastic>, 10);
  w.particle_blocks = {{0, 0, 0}, {0, 0, 1}};
  std::vector<Vec3i> blocks;  // all that these particles reach, and those of the changes below
  for (int n = 0; n < 18; ++n) blocks.push_back({n / 9, n / 3 % 3, n % 3});
  w.grid.blocks.assign(blocks);
  visit_nodes(w.grid, [&](const auto&, auto& nodes) { nodes.assign(blocks.size() * block_nodes, {1, 2, 3, 4}); });
  w.dt_before = 0.01, w.cell_pressure.assign(blocks.size() * block_nodes, 100);
  return w;
}

std::uint64_t hash_of_setup(const World64& world) { return state_hash(as_world<double>(world)); }

/// Calls check(member, world in which it has changed) for every member.
template <class Check>
void for_each_change(World64& world, const Check& check) {
  for (const Member& m : members_of(world)) {
    World64 changed = world;
    m.change(changed);
    check(m, changed);
  }
}

TEST(WorldFields, WhatIsHashedChangesTheHashAndNothingElseDoes) {
  World64 world = full_world();
  const auto before = state_hash(world);
  for_each_change(world, [&](const Member& m, const World64& changed) {
    // Places count from `low`: it is in the hash through them.
    EXPECT_EQ(state_hash(changed) != before, m.use.hashed || m.name == "low") << m.name;
  });
}

TEST(WorldFields, WhatASceneGivesIsCopied) {
  World64 world = full_world();
  const auto before = hash_of_setup(world);
  for_each_change(world, [&](const Member& m, const World64& changed) {
    if (!m.use.hashed) return;
    EXPECT_EQ(hash_of_setup(changed) != before, m.use.copied) << m.name;
  });
  World64 moved = world;
  moved.origin.y = 3, moved.low.y -= 4, moved.high.y -= 4, moved.sets[0].liquid = false;
  const World<float> copy = as_world<float>(moved);
  EXPECT_EQ(copy.origin, moved.origin);
  EXPECT_EQ(copy.low, moved.low);
  EXPECT_FALSE(copy.sets[0].liquid);
  EXPECT_EQ(copy.particles(), 0u);
}

class Saved : public testing::Test {
 protected:
  void SetUp() override {
    file_ = std::filesystem::temp_directory_path() /
            ("dreampm-world-fields-" + std::to_string(testing::UnitTest::GetInstance()->random_seed()) + "-" +
             std::to_string(::getpid()) + ".h5");
  }
  void TearDown() override { std::filesystem::remove(file_); }
  /// Returns the world as it comes back into one of the same scene.
  World64 there_and_back(const World64& world) {
    save_checkpoint(file_, world, {"scene", "reference", "scalar", {}, 0, {}});
    World64 back = as_world<double>(world);
    load_checkpoint(file_, "scene", back);
    return back;
  }
  std::filesystem::path file_;
};

TEST_F(Saved, EveryMemberOfTheStateSurvivesACheckpoint) {
  World64 world = full_world();
  EXPECT_EQ(state_hash(there_and_back(world)), state_hash(world));
  const std::vector<Arrival> arrivals = there_and_back(world).arrivals;
  ASSERT_EQ(arrivals.size(), 2u);
  EXPECT_EQ(arrivals[1].first_id, 23u);
  EXPECT_EQ(arrivals[1].count, 2u);
  for_each_change(world, [&](const Member& m, const World64& changed) {
    // Other blocks would need other arrays.
    if (m.name == "grid/blocks" || !m.use.saved) return;
    const World64 back = there_and_back(changed);
    EXPECT_EQ(state_hash(back), state_hash(changed)) << m.name;
    EXPECT_EQ(back.kept_kinetic_energy, changed.kept_kinetic_energy) << m.name;
    ASSERT_EQ(back.arrivals.size(), 2u) << m.name;
    EXPECT_EQ(back.arrivals[1].time, changed.arrivals[1].time) << m.name;
  });
}

TEST_F(Saved, ArraysThatAWorldDoesNotHaveAreNotThereAfterwards) {
  World64 world = full_world();
  world.viscous_stages = 0, world.kept_kinetic_energy = 0;
  world.sets.pop_back(), world.colliders.clear();
  world.sets[0].transfer = {};
  world.sets[0].carries_motion = false;
  for (auto& axis : world.sets[0].own_velocity) axis.clear();
  for (auto& column : world.sets[0].gradient) column.clear();
  visit_nodes(world.grid, [&](const auto& field, auto& nodes) {
    if (field.name != "nodes") nodes.clear();
  });
  const World64 back = there_and_back(world);
  EXPECT_EQ(state_hash(back), state_hash(world));
  visit_nodes(back.grid,
              [&](const auto& field, const auto& nodes) { EXPECT_EQ(nodes.empty(), field.name != "nodes"); });
  EXPECT_TRUE(back.sets[0].own_velocity[0].empty());
}

/// A file that is whole may still be of another version, or of a program.
TEST_F(Saved, WhatDoesNotFitTogetherIsRefusedByItsName) {
  const World64 world = full_world();
  EXPECT_NO_THROW(there_and_back(world));
  const std::pair<const char*, std::function<void(World64&)>> wrong[]{
      {"clock", [](World64& w) { w.time = std::nan(""); }},
      {"dt_limiter", [](World64& w) { w.dt_limiter = static_cast<Limiter>(9); }},
      {"set/water/block_start", [](World64& w) { w.sets[0].block_start = {0, 3, 2}; }},
      {"set/jelly/block_start", [](World64& w) { w.sets[1].block_start = {0, 3}; }},
      {"set/water/u1", [](World64& w) { w.sets[0].u[1][2] = 5; }},
      {"set/water/u2", [](World64& w) { w.sets[0].u[2][0] = std::nan(""); }},
      {"particle_blocks", [](World64& w) { std::swap(w.particle_blocks[0], w.particle_blocks[1]); }},
      {"particle_blocks", [](World64& w) { w.particle_blocks[1].x = std::numeric_limits<std::int32_t>::max(); }},
      {"grid/blocks", [](World64& w) { w.particle_blocks[1].z = 2; }}};
  for (const auto& [name, change] : wrong) {
    World64 changed = world;
    change(changed);
    EXPECT_NE(test::refusal([&] { there_and_back(changed); }).find(std::string(name) + " is damaged"),
              std::string::npos)
        << name;
  }
}

/// Bytes of `owner` that no member of its list covers, beyond what alignment takes between two.
template <class Owner>
void expect_covered(Owner& owner, std::vector<std::pair<const char*, std::size_t>> parts) {
  std::sort(parts.begin(), parts.end());
  const char* end = reinterpret_cast<const char*>(&owner);
  for (const auto& [at, size] : parts) {
    EXPECT_LT(at - end, 8) << "a member is not in the list, " << end - reinterpret_cast<const char*>(&owner)
                           << " bytes behind the beginning";
    end = std::max(end, at + size);
  }
  EXPECT_LT(reinterpret_cast<const char*>(&owner + 1) - end, 8) << "the last member is not in the list";
}
template <class Owner>
void expect_all_listed(Owner& owner) {
  std::vector<std::pair<const char*, std::size_t>> parts;
  visit_fields(owner, [&](const auto&, const auto& member) {
    parts.emplace_back(reinterpret_cast<const char*>(&member), sizeof member);
  });
  expect_covered(owner, std::move(parts));
}

TEST(WorldFields, WhatIsBoundIsListed) {
  World64 world = full_world();
  expect_all_listed(world);
  expect_all_listed(world.sets[0]);
  expect_all_listed(world.grid);
}

}  // namespace
}  // namespace dreampm

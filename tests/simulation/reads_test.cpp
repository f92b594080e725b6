// Values set in a simulation are read back: at once, after steps, from files, by both solvers.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "dreampm/base/error.h"
#include "dreampm/queries.h"
#include "dreampm/simulation.h"
#include "scenes.h"

namespace dreampm {
namespace {
using namespace test;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::ThrowsMessage;

/// Water below a plate, with a crate that floats and a tap.
Scene tank(const std::string& solver) {
  return parse_scene(
      "dreampm: 1\nname: tank\nspace: {max: [0.4, 0.4, 0.2], spacing: 0.02}\ntime: {fps: 50, solver: " + solver +
          "}\nmaterials: {water: {type: newtonian, preset: water}}\n"
          "bodies: {pool: {material: water, shape: {box: {min: [0, 0, 0], max: [0.4, 0.12, 0.2]}}, cut: [crate]}}\n"
          "colliders: {plate: {shape: {box: {min: [0, 0.3, 0], max: [0.1, 0.34, 0.2]}}, type: slip, friction: 0.2}}\n"
          "rigid: {crate: {shape: {box: {size: [0.08, 0.08, 0.08]}}, density: 400, position: [0.25, 0.12, 0.1]}}\n"
          "emitters: {tap: {material: water, shape: {box: {min: [0.3, 0.3, 0.06], max: [0.34, 0.34, 0.14]}}, "
          "velocity: [0, -1, 0], pool: 500}}\n"
          "sinks: {drain: {shape: {box: {min: [0, 0, 0], max: [0.04, 0.04, 0.04]}}}}\n"
          "probes: {level: {type: height, at: [0.1, 0.1]}}\n",
      "tank.yaml");
}

class Reads : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    folder = std::filesystem::path(testing::TempDir()) / fmt::format("reads-{}-{}", ::getpid(), GetParam());
    std::filesystem::remove_all(folder);
    simulation.emplace(tank(GetParam()), quiet(2));
  }
  void TearDown() override { std::filesystem::remove_all(folder); }
  /// Checks what `expect` does as it stands, after a step, and as a file has it.
  template <class Expect>
  void expect_kept(const Expect& expect) {
    expect(*simulation, "at once");
    simulation->step();
    expect(*simulation, "after a step");
    simulation->save(folder / "kept.yaml");
    Simulation other(tank(GetParam()), quiet());
    other.load(folder / "kept.yaml");
    EXPECT_EQ(other.hash(), simulation->hash());
    expect(other, "from a file");
  }
  std::filesystem::path folder;
  std::optional<Simulation> simulation;
};
INSTANTIATE_TEST_SUITE_P(BySolver, Reads, testing::Values("explicit", "projection"),
                         [](const auto& p) { return std::string(p.param); });

TEST_P(Reads, Gravity) {
  simulation->set_gravity({1, -9, 0.5});
  expect_kept([](const Simulation& s, const char* when) { EXPECT_EQ(s.gravity(), (Vec3d{1, -9, 0.5})) << when; });
}

TEST_P(Reads, Walls) {
  EXPECT_EQ(simulation->wall(Side::x_max).type, WallType::separate);
  simulation->set_wall(Side::x_max, {WallType::separate, 0.3}), simulation->set_wall(Side::y_max, {WallType::open});
  expect_kept([](const Simulation& s, const char* when) {
    EXPECT_EQ(s.wall(Side::x_max).friction, 0.3) << when;
    EXPECT_EQ(s.wall(Side::y_max).type, WallType::open) << when;
    EXPECT_EQ(s.wall(Side::x_min).friction, 0) << when;
  });
}

TEST_P(Reads, ParametersWithUnitsAndRanges) {
  // Liquids of a projection do not pull.
  const double tension = std::string(GetParam()) == "explicit" ? 1 : 0;
  simulation->set_parameter("water", "viscosity", 0.5);
  if (tension == 1) simulation->set_parameter("water", "tension", 1);
  expect_kept([&](const Simulation& s, const char* when) {
    EXPECT_EQ(s.parameter("water", "viscosity"), 0.5) << when;
    EXPECT_EQ(s.parameter("water", "tension"), tension) << when;
    std::map<std::string_view, Parameter> all;
    for (const Parameter& p : s.parameters("water")) all[p.key] = p;
    const Parameter& viscosity = all.at("viscosity");
    EXPECT_EQ(viscosity.value, 0.5) << when;
    EXPECT_EQ(viscosity.unit, "Pa s");
    EXPECT_TRUE(viscosity.min <= 0.5 && viscosity.max >= 1000 && !viscosity.about.empty());
    EXPECT_TRUE(all.at("tension").words_only);
    EXPECT_EQ(all.at("tension").words.at(1).first, "true");
  });
  // The range is that of `set_parameter`.
  for (const Parameter& p : simulation->parameters("water")) {
    if (p.key == "viscosity") {
      EXPECT_THROW(simulation->set_parameter("water", p.key, p.max * 1.01), InputError);
    }
  }
}

TEST_P(Reads, ColliderMotionAndSlack) {
  simulation->set_motion("plate", {{0.1, 0, 0}, {0, 0, 1}, {0.05, 0.32, 0.1}});
  simulation->set_surface_tolerance("plate", 0.1);
  expect_kept([](const Simulation& s, const char* when) {
    const ColliderState plate = s.collider("plate");
    EXPECT_EQ(plate.twist.velocity, (Vec3d{0.1, 0, 0})) << when;
    EXPECT_EQ(plate.twist.spin, (Vec3d{0, 0, 1})) << when;
    EXPECT_EQ(plate.surface_tolerance, 0.1) << when;
    EXPECT_EQ(plate.type, WallType::slip) << when;
    EXPECT_EQ(plate.friction, 0.2) << when;
    EXPECT_TRUE(plate.moves && !plate.is_rigid && !plate.deforms) << when;
    EXPECT_TRUE(s.collider("crate").is_rigid) << when;
    EXPECT_NEAR(s.collider("crate").mass, 400 * 0.08 * 0.08 * 0.08, 1e-12) << when;
  });
  EXPECT_THROW(simulation->set_surface_tolerance("plate", 0.3), InputError);
}

TEST_P(Reads, GripsUntilTheyAreLetGo) {
  EXPECT_FALSE(simulation->anchor("crate"));
  const SpringAnchor grip{{0.01, 0.02, 0}, {0.2, 0.3, 0.1}, 50, 2};
  for (const bool all : {false, true}) {
    simulation->attach("crate", grip);
    simulation->step();
    const std::optional<SpringAnchor> now = simulation->anchor("crate");
    ASSERT_TRUE(now);
    EXPECT_TRUE(now->at == grip.at && now->to == grip.to && now->stiffness == 50 && now->damping == 2);
    all ? simulation->detach() : simulation->detach("crate");
    EXPECT_FALSE(simulation->anchor("crate"));
  }
}

TEST_P(Reads, BrushesUntilTheyAreLifted) {
  EXPECT_FALSE(simulation->brush("hand"));
  simulation->set_brush("hand", {{0.1, 0.06, 0.1}, 0.05, {1, 0, 0}, 50});
  simulation->step();
  const std::optional<VelocityBrush> now = simulation->brush("hand");
  ASSERT_TRUE(now);
  EXPECT_TRUE(now->point == (Vec3d{0.1, 0.06, 0.1}) && now->radius == 0.05 && now->velocity.x == 1 && now->rate == 50);
  EXPECT_THAT(simulation->names().brushes, ElementsAre("hand"));
  simulation->remove_brush("hand");
  EXPECT_FALSE(simulation->brush("hand"));
  EXPECT_THAT(simulation->names().brushes, IsEmpty());
}

TEST_P(Reads, TheLengthOfSteps) {
  simulation->set_cfl(0.25);
  expect_kept([&](const Simulation& s, const char* when) {
    EXPECT_EQ(s.cfl(), 0.25) << when;
    EXPECT_EQ(s.stepping().cfl, 0.25) << when;
    EXPECT_EQ(s.stepping().solver, GetParam()) << when;
    EXPECT_NEAR(s.stepping().cell, 0.04, 1e-12) << when;
    EXPECT_EQ(s.stepping().fixed_dt, 0) << when;
  });
}

TEST_P(Reads, NamesOfWhatThereIsAndOfWhatIsAdded) {
  Names names = simulation->names();
  EXPECT_THAT(names.materials, ElementsAre("water"));
  EXPECT_THAT(names.bodies, ElementsAre("pool"));
  EXPECT_THAT(names.colliders, ElementsAre("plate", "crate"));
  EXPECT_THAT(names.rigid, ElementsAre("crate"));
  EXPECT_THAT(names.emitters, ElementsAre("tap"));
  EXPECT_THAT(names.sinks, ElementsAre("drain"));
  EXPECT_THAT(names.probes, ElementsAre("level"));
  simulation->add({"shelf", Shape::box({0, 0.36, 0}, {0.05, 0.38, 0.2})});
  simulation->add(model::Collider{.name = "ball",
                                  .shape = Shape::sphere({0.15, 0.25, 0.1}, 0.03),
                                  .friction = 0.7,
                                  .rigid = model::Rigid{.density = 1000, .restitution = 0.3}});
  EXPECT_EQ(simulation->collider("ball").friction, 0.7);
  EXPECT_EQ(simulation->collider("ball").restitution, 0.3);
  simulation->add({"drop", "water", Shape::sphere({0.1, 0.2, 0.1}, 0.03)});
  names = simulation->names();
  EXPECT_THAT(names.colliders, testing::UnorderedElementsAre("plate", "shelf", "crate", "ball"));
  EXPECT_THAT(names.rigid, ElementsAre("crate", "ball"));
  EXPECT_THAT(names.bodies, ElementsAre("pool", "drop"));
  for (const std::string& name : names.colliders) EXPECT_EQ(simulation->collider_shape(name).name(), name);
  // The ids of a body are those of the particles that it brought.
  const BodyState drop = simulation->body("drop");
  EXPECT_EQ(drop.material, "water");
  EXPECT_EQ(drop.count, simulation->counts().entered);
  EXPECT_EQ(drop.first_id + drop.count, simulation->next_id());
}

TEST_P(Reads, CountsAreThoseOfTheTotals) {
  simulation->remove(Shape::box({0.1, 0, 0}, {0.2, 0.4, 0.2}));
  simulation->advance_to(0.1);
  // They are taken out a box's width behind the wall.
  simulation->set_wall(Side::x_max, {WallType::open});
  simulation->set_gravity({40, -9.81, 0});
  simulation->advance_to(0.4);
  const ParticleCounts counts = simulation->counts();
  const Totals totals = simulation->totals();
  EXPECT_EQ(counts.particles, simulation->particle_count());
  EXPECT_EQ(counts.particles, totals.particles);
  EXPECT_GT(counts.removed, 0u);
  EXPECT_GT(counts.left, 0u);
  EXPECT_GT(counts.drained, 0u);
  EXPECT_EQ(counts.particles + counts.removed + counts.left + counts.drained, simulation->next_id())
      << "each that ever came is there, or went one way";
  EXPECT_EQ(std::tie(counts.entered, counts.removed, counts.left, counts.drained),
            std::tie(totals.entered, totals.removed, totals.left, totals.drained));
}

TEST_P(Reads, AVisitSeesEachParticleOnce) {
  simulation->advance_to(0.1);
  const ParticleView water = simulation->particles("water");
  std::map<std::uint32_t, std::size_t> place;
  for (std::size_t i = 0; i < water.size(); ++i) place[water.id[i]] = i;
  std::size_t seen = 0;
  simulation->visit("water", {.velocity = true, .id = true}, [&](const ParticleBatch& some) {
    EXPECT_EQ(some.first, seen);
    ASSERT_EQ(some.id.size(), some.size());
    ASSERT_EQ(some.velocity.size(), some.size());
    for (std::size_t i = 0; i < some.size(); ++i) {
      const auto at = place.find(some.id[i]);
      ASSERT_NE(at, place.end()) << "it was seen before, or is none";
      EXPECT_EQ(static_cast<Vec3f>(some.position[i]), water.position[at->second]);
      EXPECT_EQ(static_cast<Vec3f>(some.velocity[i]), water.velocity[at->second]);
      EXPECT_LT(some.id[i], simulation->next_id());
      place.erase(at);
    }
    seen += some.size();
  });
  EXPECT_TRUE(place.empty());
  std::size_t ids = 0;
  simulation->visit("water", {.position = false, .id = true}, [&](const ParticleBatch& some) {
    EXPECT_TRUE(some.position.empty());
    ids += some.id.size();
  });
  EXPECT_EQ(ids, water.size());
  simulation->visit("water", {},
                    [](const ParticleBatch& some) { EXPECT_TRUE(some.velocity.empty() && some.id.empty()); });
}

// Emitters give ids, too: whoever saw all particles below an id knows those that came in since.
TEST_P(Reads, WhatComesInHasNewIds) {
  const std::uint32_t before = simulation->next_id();
  const std::size_t count = simulation->particle_count();
  simulation->remove(Shape::box({0, 0, 0}, {0.1, 0.1, 0.1}));
  simulation->advance_to(0.1);
  std::size_t fresh = 0;
  for (const std::uint32_t id : simulation->particles("water").id) fresh += id >= before;
  EXPECT_GT(fresh, 0u);
  EXPECT_EQ(simulation->next_id() - before, fresh);
  EXPECT_LT(simulation->particle_count(), count + fresh);
}

TEST_P(Reads, AttributesAreThoseOfTheState) {
  simulation->advance_to(0.2);
  const ParticleView water = simulation->particles("water");
  const AttributeView j = simulation->attribute("water", "j"), density = simulation->attribute("water", "density"),
                      pressure = simulation->attribute("water", "pressure"), f = simulation->attribute("water", "f");
  const MaterialState material = simulation->material("water");
  ASSERT_EQ(j.size(), water.size());
  EXPECT_EQ(j.unit, "1");
  EXPECT_EQ(density.unit, "kg/m^3");
  EXPECT_EQ(pressure.unit, "Pa");
  double deep = 0, high = 0;
  std::size_t deep_ones = 0, high_ones = 0;
  for (std::size_t i = 0; i < water.size(); ++i) {
    EXPECT_EQ(j.values[i], water.J[i]);
    const double own = material.particle_mass / (material.particle_volume * static_cast<double>(water.J[i]));
    EXPECT_NEAR(static_cast<double>(density.values[i]), own, 1e-6 * own);
    if (water.position[i].y < 0.04f) deep += static_cast<double>(pressure.values[i]), ++deep_ones;
    if (water.position[i].y > 0.08f) high += static_cast<double>(pressure.values[i]), ++high_ones;
  }
  EXPECT_GT(deep / static_cast<double>(deep_ones), high / static_cast<double>(high_ones) + 200)
      << "rho g 0.05 m = 490 Pa";
  ASSERT_EQ(f.width, 9u);
  ASSERT_EQ(f.size(), water.size());
  EXPECT_EQ(f.values[0], 1) << "water keeps none: that of matter at rest";
  EXPECT_EQ(f.values[1], 0);
}

TEST_P(Reads, NamesThatAreNotThere) {
  Simulation& s = *simulation;
  const auto says = [](const auto& matcher) { return ThrowsMessage<InputError>(matcher); };
  EXPECT_THAT([&] { s.parameter("water", "viscosty"); },
              says(HasSubstr("material water (newtonian) has no parameter viscosty; did you mean 'viscosity'?")));
  EXPECT_THAT([&] { s.attribute("water", "presure"); },
              says(HasSubstr("material water have no attribute presure; did you mean 'pressure'?")));
  EXPECT_THAT([&] { s.material("water", std::vector<ParameterValue>{{"densty", 1}}); },
              says(HasSubstr("did you mean 'density'?")));
  EXPECT_THAT([&] { s.parameters("watr"); }, says(HasSubstr("material watr is not in the scene; it has water")));
  EXPECT_THAT([&] { s.visit("watr", {}, [](const ParticleBatch&) {}); }, says(HasSubstr("it has water")));
  EXPECT_THAT([&] { s.collider_shape("plat"); },
              says(HasSubstr("collider plat is not in the scene; it has plate, crate")));
  EXPECT_THAT([&] { s.collider_mesh("plat"); }, says(HasSubstr("it has plate, crate")));
  EXPECT_THAT([&] { s.anchor("plate"); }, says(HasSubstr("rigid body plate is not in the scene; it has crate")));
  EXPECT_THAT([&] { s.body("pol"); }, says(HasSubstr("body pol is not in the scene; it has pool")));
  EXPECT_THAT([&] { s.probe("lvel"); }, says(HasSubstr("probe lvel is not in the scene; it has level")));
  EXPECT_THAT([&] { s.set_surface_tolerance("plat", 0.1); }, says(HasSubstr("it has plate, crate")));
  EXPECT_THAT([&] { s.set_cfl(-1); }, says(HasSubstr("cfl")));
}

TEST_P(Reads, AMomentIsLoadedWithTheObserversOfBefore) {
  int steps = 0, frames = 0;
  simulation->on_step([&](const StepReport&) { ++steps; });
  simulation->on_frame([&](const FrameEvent&) { ++frames; });
  simulation->advance_to(0.05);
  simulation->save(folder / "then.yaml");
  const std::uint64_t then = simulation->hash();
  simulation->advance_to(0.1);
  const std::uint64_t later = simulation->hash();
  const int whole = steps;
  simulation->set_gravity({0, 0, 0});
  simulation->load(folder / "then.yaml");
  EXPECT_EQ(simulation->hash(), then);
  EXPECT_EQ(simulation->gravity().y, -9.81);
  EXPECT_EQ(simulation->threads(), 2);
  steps = frames = 0;
  simulation->advance_to(0.1);
  EXPECT_EQ(simulation->hash(), later);
  EXPECT_TRUE(steps > 0 && steps < whole && frames > 0) << steps << " " << whole << " " << frames;
  // A file that cannot be loaded leaves all as it is, and an observer may not load one.
  EXPECT_THROW(simulation->load(folder / "none.yaml"), InputError);
  EXPECT_EQ(simulation->hash(), later);
  simulation->on_step([&](const StepReport&) { simulation->load(folder / "then.yaml"); });
  EXPECT_THAT([&] { simulation->step(); }, ThrowsMessage<InputError>(HasSubstr("not inside of an observer")));
}

TEST_P(Reads, ShapesStandWhereTheirCollidersDo) {
  const ColliderShape before = simulation->collider_shape("plate");
  EXPECT_NEAR(before.distance({0.05, 0.36, 0.1}), 0.02, 1e-9);
  EXPECT_NEAR(before.distance({0.05, 0.32, 0.1}), -0.02, 1e-9);
  EXPECT_NEAR(before.normal({0.05, 0.36, 0.1}).y, 1, 1e-6);
  simulation->set_motion("plate", {{0, 0.5, 0}, {}, {}});
  simulation->advance_to(0.1);
  const ColliderShape after = simulation->collider_shape("plate");
  const double moved = simulation->collider("plate").pose.position.y, off = 0.02 * 0.04;
  EXPECT_NEAR(after.distance({0.05, 0.36 + moved, 0.1}), 0.02, off) << "up to the surface tolerance";
  EXPECT_NEAR(after.bounds().max.y, 0.34 + moved, off);
  EXPECT_NEAR(after.own_bounds().max.y, 0.34, 1e-12);
  EXPECT_EQ(after.velocity({0.05, 0.36, 0.1}).y, 0.5);
  EXPECT_NEAR(before.distance({0.05, 0.36, 0.1}), 0.02, 1e-9) << "it stays as it was";
  EXPECT_FALSE(after.is_rigid());
  EXPECT_GT(simulation->collider_shape("crate").mass(), 0);
  const TriMesh mesh = simulation->collider_mesh("crate");
  Box3f box;
  for (const Vec3f& v : mesh.vertices) box.add(v);
  EXPECT_NEAR(box.size().x, 0.08, 1e-5);
}

TEST_P(Reads, WhatIsNearAPoint) {
  EXPECT_THAT(colliders_near(*simulation, {0.2, 0.25, 0.1}, 0.05), IsEmpty());
  const std::vector<NearCollider> near = colliders_near(*simulation, {0.25, 0.18, 0.1}, 0.05);
  ASSERT_EQ(near.size(), 1u);
  EXPECT_EQ(near[0].name, "crate");
  EXPECT_NEAR(near[0].distance, 0.02, 1e-6);
  EXPECT_TRUE(near[0].is_rigid);
  EXPECT_EQ(colliders_near(*simulation, {0.25, 0.18, 0.1}, 1).size(), 2u);
}

TEST_P(Reads, WhatARayMeetsFirst) {
  const Vec3d down{0, -1, 0};
  // The plate, before the water below it.
  const auto plate = cast_ray(*simulation, {0.05, 0.39, 0.1}, down * 3.0);
  ASSERT_TRUE(plate);
  EXPECT_EQ(plate->name, "plate");
  EXPECT_FALSE(plate->id);
  EXPECT_NEAR(plate->distance, 0.05, 1e-4);
  EXPECT_NEAR(plate->point.y, 0.34, 1e-4);
  EXPECT_FALSE(cast_ray(*simulation, {0.05, 0.39, 0.1}, down, 0.04)) << "it is farther away";
  // Water: the particle that is met is there, and none stands in front of it.
  std::size_t met = 0;
  for (double x = 0.105; x < 0.19; x += 0.01) {
    const auto hit = cast_ray(*simulation, {x, 0.35, 0.1}, down);
    if (!hit) continue;
    ++met;
    ASSERT_TRUE(hit->id);
    EXPECT_EQ(hit->name, "water");
    const ParticleView water = simulation->particles("water");
    for (std::size_t i = 0; i < water.size(); ++i) {
      const double away = length(static_cast<Vec3d>(water.position[i]) - hit->point);
      if (water.id[i] == *hit->id)
        EXPECT_NEAR(away, 0.01, 1e-6);
      else
        EXPECT_GT(away, 0.01 - 1e-6);
    }
  }
  EXPECT_GT(met, 4u) << "balls of half a spacing leave gaps";
  // From outside of the box, past all, and from inside of a body.
  EXPECT_EQ(cast_ray(*simulation, {0.05, 2, 0.1}, down)->name, "plate");
  EXPECT_FALSE(cast_ray(*simulation, {0.2, 0.25, 0.1}, {0, 1, 0}));
  EXPECT_FALSE(cast_ray(*simulation, {0.2, 2, 0.1}, {0, 1, 0}));
  EXPECT_EQ(cast_ray(*simulation, {0.25, 0.12, 0.1}, down)->distance, 0);
  EXPECT_THROW(cast_ray(*simulation, {0, 0, 0}, {0, 0, 0}), InputError);
}

// The water within a spacing of the crate's sides and bottom, and none at the plate above.
TEST_P(Reads, WhatMatterTouches) {
  EXPECT_THAT(contacts(*simulation, "plate"), IsEmpty());
  const std::vector<Contact> wet = contacts(*simulation, "crate");
  ASSERT_EQ(wet.size(), 1u);
  EXPECT_EQ(wet[0].material, "water");
  // A layer of a spacing around the lower half: 0.08 x 0.08 below and 4 x 0.08 x 0.04 beside it.
  const double expected = (0.08 * 0.08 + 4 * 0.08 * 0.04) / (0.02 * 0.02);
  EXPECT_NEAR(static_cast<double>(wet[0].particles), expected, 0.5 * expected);
  EXPECT_LT(wet[0].middle.y, 0.12);
  EXPECT_NEAR(wet[0].middle.x, 0.25, 0.01);
  std::size_t all = 0;
  for (const Contact& c : contacts(*simulation, "crate", 10)) all += c.particles;
  EXPECT_EQ(all, simulation->particle_count());
  EXPECT_THROW(contacts(*simulation, "crat"), InputError);
}

}  // namespace
}  // namespace dreampm

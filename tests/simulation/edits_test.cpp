// Edits of a running simulation.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "dreampm/backend/registry.h"
#include "dreampm/base/parallel.h"
#include "dreampm/math/rng.h"
#include "dreampm/model/scene.h"
#include "scenes.h"

namespace dreampm {
namespace {
using namespace test;
using testing::HasSubstr;

TEST(Edits, GiveTheSameBitsForAnyNumberOfThreads) {
  for (const char* transfer : {"apic", "asflip"}) {
    std::uint64_t one = 0;
    const ThreadLimit eight(8);  // however many cores there are
    for (const int threads : {1, 2, 3, 8}) {
      Simulation s(dam_and_jelly(transfer), quiet(threads));
      script(s, [](int) {});
      if (threads == 1) one = s.hash();
      EXPECT_EQ(s.hash(), one) << threads << " threads, " << transfer;
    }
  }
}

TEST(Edits, GiveTheSameBitsAfterASnapshot) {
  for (const std::string& backend : backends_here()) {
    Simulation straight(dam_and_jelly(), quiet(2, backend)), restored(dam_and_jelly(), quiet(2, backend));
    script(straight, [](int) {});
    // At steps with an edit that has not acted yet, too.
    script(restored, [&](int step) {
      if (step % 5 != 0) return;
      const Snapshot here = restored.snapshot();
      restored.step();
      restored.restore(here);
    });
    EXPECT_EQ(restored.hash(), straight.hash()) << backend;
    EXPECT_EQ(restored.scene().yaml(), straight.scene().yaml());
  }
}

/// A cube of jelly without weight that was thrown at a wall, when it is pressed most.
Simulation pressed_cube(const std::string& backend, const std::string& transfer) {
  const Scene scene = parse_scene(
      "dreampm: 1\nname: cube\nspace: {min: [0, 0, 0], max: [0.16, 0.16, 0.16], spacing: 0.01}\n"
      "gravity: [0, 0, 0]\nmaterials:\n  jelly: {type: neo_hookean, youngs_modulus: 1.0e5, poissons_ratio: 0.3, "
      "transfer: " +
          transfer +
          "}\nbodies:\n  cube: {material: jelly, shape: {box: {min: [0.04, 0, 0.04], max: [0.12, 0.08, 0.12]}}, "
          "velocity: [0, -2, 0]}\n",
      "cube.yaml");
  Simulation s(scene, quiet(2, backend));
  double kinetic = s.totals().kinetic;
  while (true) {
    s.step();
    const double now = s.totals().kinetic;
    if (now > kinetic) return s;
    kinetic = now;
  }
}

TEST(Edits, NoForceOfTheOldLawIsLeft) {
  for (const std::string& backend : backends_here())
    for (const char* transfer : {"apic", "asflip"}) {
      Simulation s = pressed_cube(backend, transfer);
      const Snapshot pressed = s.snapshot();
      const double before = s.totals().kinetic, dt = s.dt(), elastic = s.totals().elastic;
      ASSERT_GT(elastic, 5 * before);
      // Its own stress accelerates it.
      s.step();
      const double driven = s.totals().kinetic - before;
      ASSERT_GT(driven, 0.02 * before);
      // Without one nothing does: transfers only take.
      s.restore(pressed);
      s.reset_state("jelly");
      s.set_parameter("jelly", "youngs_modulus", 1e4);
      EXPECT_GE(s.dt(), dt);
      s.step();
      EXPECT_LE(s.totals().kinetic, before * (1 + 1e-5)) << backend << " " << transfer;
      EXPECT_LT(s.totals().elastic, 0.01 * elastic);
      // Half as stiff, it is accelerated half as much.
      s.restore(pressed);
      s.set_parameter("jelly", "youngs_modulus", 0.5e5);
      const double longer = s.dt() / dt;
      s.step();
      const double half = s.totals().kinetic - before;
      EXPECT_GT(half / (driven * longer), 0.2) << backend << " " << transfer;
      EXPECT_LT(half / (driven * longer), 0.6) << backend << " " << transfer;
    }
}

TEST(Edits, AnEditThatChangesNothingHardlyChangesTheFuture) {
  Simulation a = pressed_cube("reference", "apic"), b = pressed_cube("reference", "apic");
  b.set_gravity({0, 0, 0});
  EXPECT_NEAR(b.dt(), a.dt(), 0.2 * a.dt());
  const double end = a.time() + 40 * a.dt();
  a.advance_to(end), b.advance_to(end);
  EXPECT_NEAR(a.totals().kinetic, b.totals().kinetic, 0.05 * a.totals().kinetic);
}

TEST(Edits, AStifferLawTakesShorterStepsAtOnce) {
  Simulation s(dam_and_jelly(), quiet());
  s.advance_to(0.01);
  const double dt = s.dt();
  s.set_parameter("jelly", "youngs_modulus", 2e7);
  EXPECT_LT(s.dt(), 0.2 * dt);
  s.advance_to(0.05);
  for (const float j : s.particles("jelly").J) EXPECT_NEAR(j, 1, 0.2);
}

// Velocities of their own come from the motion of the moment, and go with the transfer.
TEST(Edits, ATransferThatKeepsVelocitiesComesAndGoes) {
  const Scene scene = parse_scene(
      "dreampm: 1\nname: pool\nspace: {max: [0.24, 0.2, 0.16], spacing: 0.02, walls: {x_max: {type: open}}}\n"
      "time: {fps: 50, frames: 8}\nmaterials: {water: {type: newtonian, transfer: flip, flip_blend: 0}}\n"
      "bodies: {dam: {material: water, shape: {box: {min: [0, 0, 0], max: [0.12, 0.12, 0.16]}}}}\n",
      "pool.yaml", {});
  for (const std::string& backend : backends_here()) {
    Simulation s(scene, quiet(2, backend));
    s.advance_to(0.06);
    const auto kinetic = [&] {
      double sum = 0;
      for (const Vec3f& v : s.particles("water").velocity) sum += static_cast<double>(dot(v, v));
      return sum;
    };
    double time = 0.06;
    for (const double blend : {0.5, 0.0, 0.9}) {
      s.set_parameter("water", "flip_blend", blend);
      const double before = kinetic();
      s.step();
      EXPECT_NEAR(kinetic(), before, 0.1 * before) << backend << ' ' << blend;
      s.advance_to(time += 0.02);
    }
    for (const float j : s.particles("water").J) EXPECT_NEAR(j, 1, 0.1) << backend;
  }
}

TEST(Edits, MatterThatComesInIsCounted) {
  Simulation s(dam_and_jelly(), quiet());
  s.advance_to(0.02);
  const Totals before = s.totals();
  const std::size_t jelly = s.particles("jelly").size();
  s.add(ball("first", {0.05, 0.16, 0.08}));
  const Totals after = s.totals();
  const ParticleView now = s.particles("jelly");
  const std::size_t count = now.size() - jelly;
  EXPECT_NEAR(static_cast<double>(count), 4.0 / 3 * M_PI * 1.5 * 1.5 * 1.5, 4);
  EXPECT_EQ(after.entered, count);
  EXPECT_EQ(after.particles, before.particles + count);
  EXPECT_NEAR(after.mass, before.mass + after.entered_mass, 1e-9);
  EXPECT_NEAR(after.momentum.y, before.momentum.y + after.entered_momentum.y, 1e-6);
  EXPECT_NEAR(after.entered_momentum.y, -after.entered_mass, 1e-9);
  EXPECT_EQ(now.id.back(), before.particles + count - 1);
  EXPECT_NEAR(now.velocity.back().y, -1, 1e-6 + 5 * 0.03);
  EXPECT_EQ(now.J.back(), 1);
  EXPECT_THAT(s.scene().yaml(), Not(HasSubstr("first"))) << "what was added is state, not a start";
  s.advance_to(0.1);
  EXPECT_EQ(s.totals().particles, after.particles);
  // Ids are not used again.
  s.remove(Shape::box({0, 0, 0}, {0.24, 0.2, 0.16}));
  EXPECT_EQ(s.particle_count(), 0u);
  EXPECT_NEAR(s.totals().removed_mass, after.mass, 1e-9);
  s.add(ball("second", {0.05, 0.16, 0.08}));
  EXPECT_EQ(s.particles("jelly").id[0], after.particles);
  const std::size_t again = s.particle_count();
  EXPECT_NEAR(static_cast<double>(again), static_cast<double>(count), 4);
  s.advance_to(0.15);
  EXPECT_EQ(s.particle_count(), again);
}

TEST(Edits, RemoveTakesWhatLiesInside) {
  Simulation s(dam_and_jelly(), quiet());
  s.advance_to(0.04);
  std::size_t inside = 0;
  for (const char* material : {"water", "jelly"})
    for (const Vec3f& p : s.particles(material).position) inside += length(p - Vec3f{0.12f, 0.05f, 0.08f}) < 0.05f;
  ASSERT_GT(inside, 10u);
  const std::size_t all = s.particle_count();
  EXPECT_EQ(s.remove(Shape::sphere({0.12, 0.05, 0.08}, 0.05)), inside);
  EXPECT_EQ(s.particle_count(), all - inside);
  EXPECT_EQ(s.totals().removed, inside);
  EXPECT_EQ(s.remove(Shape::sphere({0.12, 0.05, 0.08}, 0.05)), 0u);
  s.advance_to(0.08);
  EXPECT_EQ(s.particle_count(), all - inside);
}

TEST(Edits, GoBesideCollidersAndProbes) {
  const Scene scene = dam_and_jelly().with(
      {"colliders.post={shape: {cylinder: {radius: 0.02, height: 0.1}, center: [0.22, 0.05, 0.03]}}",
       "probes.load={type: force, on: post}", "probes.tip={type: point, body: cube, at: [0.13, 0.05, 0.05]}"});
  Simulation s(scene, quiet());
  s.advance_to(0.01);
  EXPECT_THAT(refusal([&] { s.add(ball("within", {0.2, 0.06, 0.04})); }), HasSubstr("lie within collider post"));
  s.add(ball("beside", {0.05, 0.16, 0.08}));
  EXPECT_GT(s.remove(Shape::box({0, 0, 0}, {0.05, 0.05, 0.05})), 0u);
  s.set_parameter("jelly", "youngs_modulus", 3e4);
  s.advance_to(0.02);
}

TEST(Edits, TheLastColliderGoesAndComes) {
  const Scene scene = dam_and_jelly().with(
      {"colliders.post={shape: {cylinder: {radius: 0.02, height: 0.1}, center: [0.22, 0.05, 0.03]}}"});
  Simulation s(scene, quiet());
  s.advance_to(0.01);
  const auto with_post = s.snapshot();
  s.remove_collider("post");
  s.advance_to(0.02);
  const auto without = s.snapshot();
  const double bare = s.totals().kinetic;
  s.restore(with_post);
  s.advance_to(0.02);
  EXPECT_NE(s.totals().kinetic, bare);
  s.restore(without);
  EXPECT_EQ(s.totals().kinetic, bare);
  s.advance_to(0.03);
}

TEST(Edits, OfGravityLeaveTheGridOfExplicitStepsAsItIs) {
  for (const char* backend : {"cpu", "reference"}) {
    Simulation s = pressed_cube(backend, "apic"), other = pressed_cube(backend, "apic");
    s.set_gravity({0, 0, 30});
    EXPECT_EQ(s.dt(), other.dt());
    s.set_gravity({0, 0, 0});
    EXPECT_EQ(s.hash(), other.hash());
    s.set_gravity({0, 0, 30});
    const double gained = s.totals().mass * 30 * s.dt();
    s.step(), other.step();
    const Vec3d more = s.totals().momentum - other.totals().momentum;
    EXPECT_NEAR(more.z, gained, 1e-3 * gained) << backend;
    EXPECT_NEAR(more.y, 0, 1e-3 * gained) << backend;
  }
}

TEST(Edits, WallsOpen) {
  Simulation s(dam_and_jelly(), quiet());
  s.set_wall(Side::x_min, {WallType::open});
  s.set_gravity({-30, 0, 0});
  s.advance_to(0.4);
  EXPECT_GT(s.totals().left, 100u);
  EXPECT_EQ(s.totals().drained, 0u);
}

TEST(Edits, MayStandInObservers) {
  Simulation inside(dam_and_jelly(), quiet()), between(dam_and_jelly(), quiet());
  inside.on_step([&](const StepReport& r) {
    if (r.step == 4) inside.set_parameter("water", "viscosity", 3);
    if (r.step == 8) inside.add(ball("ball", {0.19, 0.16, 0.08}));
  });
  inside.advance_to(0.05);
  for (int i = 0; i < 4; ++i) between.step();
  between.set_parameter("water", "viscosity", 3);
  for (int i = 0; i < 4; ++i) between.step();
  between.add(ball("ball", {0.19, 0.16, 0.08}));
  between.advance_to(0.05);
  EXPECT_EQ(inside.hash(), between.hash());
}

class Dice {
 public:
  explicit Dice(std::uint64_t seed) : seed_(seed) {}
  double uniform() { return dreampm::uniform(seed_, count_++); }

 private:
  std::uint64_t seed_, count_ = 0;
};

/// Any value of the table's range, in decades where a slider moves in them.
double any_value(const Param& p, Dice& dice) {
  if (p.words_only) return dice.uniform() < 0.5 ? 0 : 1;
  if (!p.log || p.min <= 0) return p.min + (p.max - p.min) * dice.uniform();
  return p.min * std::pow(p.max / p.min, dice.uniform());
}

TEST(Edits, AWordsNumberIsTheWord) {
  Simulation s(dam_and_jelly(), quiet());
  const auto gamma = [&] { return s.scene().model().materials[0].values["gamma"]; };
  s.set_parameter("water", "gamma", -1);
  EXPECT_EQ(gamma(), -1) << "linear";
  s.set_parameter("water", "gamma", 7);
  EXPECT_EQ(gamma(), 7);
  EXPECT_THAT(refusal([&] { s.set_parameter("water", "gamma", -2); }), HasSubstr("between 1 and 15"));
}

TEST(Edits, AnyOfThemLeaveTheSimulationSound) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    Dice dice(seed);
    Simulation s(dam_and_jelly(seed == 2 ? "asflip" : "apic"), quiet(2));
    const Vec3d low = s.scene().min(), high = s.scene().max();
    std::uint64_t balls = 0;
    for (int edit = 0; edit < 60; ++edit) {
      const double kind = dice.uniform();
      const auto place = [&] {
        return Vec3d{0.05 + 0.14 * dice.uniform(), 0.05 + 0.1 * dice.uniform(), 0.05 + 0.06 * dice.uniform()};
      };
      if (kind < 0.5) {
        const char* const name = dice.uniform() < 0.5 ? "water" : "jelly";
        const auto& material = s.scene().model().materials[name[0] == 'w' ? 0 : 1];
        const Param& p = info_of(material).params[static_cast<std::size_t>(
            dice.uniform() * static_cast<double>(info_of(material).params.size()))];
        SCOPED_TRACE(fmt::format("seed {} edit {}: {}.{}", seed, edit, name, p.key));
        ASSERT_NO_THROW(s.set_parameter(name, p.key, any_value(p, dice)));
      } else if (kind < 0.6) {
        s.set_gravity((Vec3d{dice.uniform(), dice.uniform(), dice.uniform()} - Vec3d{0.5, 0.5, 0.5}) * 40);
      } else if (kind < 0.7) {
        const auto side = static_cast<Side>(dice.uniform() * 6);
        s.set_wall(side, {static_cast<WallType>(dice.uniform() * 3)});
      } else if (kind < 0.8) {
        s.add(ball(fmt::format("ball{}", ++balls), place()));
      } else if (kind < 0.9) {
        s.remove(Shape::sphere(place(), 0.03));
      } else {
        s.reset_state(dice.uniform() < 0.5 ? "water" : "jelly");
      }
      SCOPED_TRACE(fmt::format("seed {} edit {} kind {}", seed, edit, kind));
      for (int step = 0; step < 4; ++step) ASSERT_NO_THROW(s.step());
      const Totals t = s.totals();
      ASSERT_TRUE(std::isfinite(t.kinetic + t.mass));
      ASSERT_EQ(t.left, 0u);
      for (const char* material : {"water", "jelly"})
        for (const Vec3f& x : s.particles(material).position) {
          const auto at = static_cast<Vec3d>(x);
          ASSERT_TRUE(min(at, low) == low && max(at, high) == high);
        }
    }
    const Totals t = s.totals();
    EXPECT_EQ(t.particles + t.removed, Simulation(dam_and_jelly(), quiet()).particle_count() + t.entered);
  }
}

TEST(Edits, ABrushTakesAlongWhatItTouchesAlone) {
  Simulation s(dam_and_jelly().with({"gravity=[0, 0, 0]", "bodies.dam.velocity=[0, 0, 0]"}), quiet());
  const Vec3d point{0.16, 0.08, 0.08};
  const double radius = 0.06;
  const auto far = [&](const Vec3f& x) { return length(static_cast<Vec3d>(x) - point) > 0.12; };
  const Vec3d before = s.totals().momentum;
  s.set_brush("hand", {point, radius, {0, 0.5, 0}, 1e4});
  s.advance_to(0.004);
  double fastest = 0;
  for (const Vec3f& v : s.particles("jelly").velocity) fastest = std::max(fastest, static_cast<double>(v.y));
  EXPECT_GT(fastest, 0.3);
  EXPECT_LT(fastest, 0.6);
  const ParticleView water = s.particles("water");
  for (std::size_t p = 0; p < water.size(); ++p)
    if (far(water.position[p])) {
      EXPECT_LT(length(static_cast<Vec3d>(water.velocity[p])), 0.02);
    }
  EXPECT_GT(s.totals().momentum.y, before.y);
  s.remove_brush("hand");
  const Vec3d lifted = s.totals().momentum;
  s.step();
  EXPECT_NEAR(s.totals().momentum.y, lifted.y, 1e-3 * lifted.y);
  EXPECT_THAT(refusal([&] { s.set_brush("hand", {point, 0, {}}); }), HasSubstr("radius above 0"));
}

TEST(Edits, StepsInOneCallGiveWhatSingleStepsGive) {
  Simulation one(dam_and_jelly("asflip"), quiet()), many(dam_and_jelly("asflip"), quiet());
  for (int i = 0; i < 20; ++i) one.step();
  const StepReport last = many.advance_steps(20);
  EXPECT_EQ(last.step, 20u);
  EXPECT_EQ(last.time, one.time());
  EXPECT_EQ(one.hash(), many.hash());
  const ParticleView a = one.particles("water"), b = many.particles("water");
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t p = 0; p < a.size(); ++p) ASSERT_EQ(a.velocity[p], b.velocity[p]);
  EXPECT_THAT(refusal([&] { many.advance_steps(0); }), HasSubstr("1 or more"));
}

TEST(Edits, AMaterialMoreFillsBodiesAndGoesWithASnapshot) {
  for (const std::string& backend : backends_here()) {
    Simulation s(dam_and_jelly(), quiet(1, backend));
    s.advance_to(0.01);
    const Snapshot before = s.snapshot();
    s.add_material({"snow", "snow"});
    EXPECT_EQ(s.particles("snow").size(), 0u);
    s.add({"heap", "snow", Shape::box({0.02, 0.14, 0.02}, {0.1, 0.18, 0.1})});
    const std::size_t snow = s.particles("snow").size();
    EXPECT_GT(snow, 10u);
    s.advance_steps(5);
    EXPECT_EQ(s.particles("snow").size(), snow);
    EXPECT_THAT(refusal([&] { s.add_material({"snow", "snow"}); }), HasSubstr("already"));
    EXPECT_THAT(refusal([&] { s.add_material({"ice", "snwo"}); }), HasSubstr("did you mean 'snow'"));
    s.restore(before);
    EXPECT_EQ(s.scene().materials().size(), 2u);
    s.step();
  }
}

TEST(Edits, AFixedTimeStepHasToFitTheLawsAsTheyAre) {
  Simulation s(dam_and_jelly("asflip").with({"time.dt=5.0e-4"}), quiet());
  s.advance_to(0.02);
  const auto here = s.hash();
  const std::size_t particles = s.particle_count();
  s.set_parameter("jelly", "youngs_modulus", 2e7);
  EXPECT_THAT(refusal([&] { s.step(); }),
              HasSubstr("time.dt is 0.0005: after the edit at t = 0.02 s it must be at most"));
  EXPECT_THAT(refusal([&] { s.snapshot(); }), HasSubstr("time.dt"));
  // Another edit puts it right, and nothing was lost or mixed up.
  s.set_parameter("jelly", "youngs_modulus", 2e4);
  s.step();
  EXPECT_EQ(s.particle_count(), particles);
  Simulation untouched(dam_and_jelly("asflip").with({"time.dt=5.0e-4"}), quiet());
  untouched.advance_to(0.02);
  ASSERT_EQ(untouched.hash(), here);
  untouched.set_parameter("jelly", "youngs_modulus", 2e4);
  untouched.step();
  EXPECT_EQ(s.hash(), untouched.hash());
}

TEST(Edits, RefuseWhatASceneWouldRefuseAndChangeNothing) {
  Simulation s(dam_and_jelly(), quiet());
  s.advance_to(0.01);
  const auto hash = s.hash();
  const std::string yaml = s.scene().yaml();
  EXPECT_THAT(refusal([&] { s.set_parameter("water", "viscosity", -1); }),
              HasSubstr("materials.water.viscosity is -1: must be"));
  EXPECT_THAT(refusal([&] { s.set_parameter("water", "viscosty", 1); }), HasSubstr("did you mean 'viscosity'"));
  EXPECT_THAT(refusal([&] { s.set_parameter("milk", "viscosity", 1); }), HasSubstr("it has water, jelly"));
  EXPECT_THAT(refusal([&] { s.set_parameter("water", "viscosity", std::nan("")); }), HasSubstr("viscosity"));
  EXPECT_THAT(refusal([&] { s.set_gravity({0, INFINITY, 0}); }), HasSubstr("gravity"));
  EXPECT_THAT(refusal([&] { s.set_wall(Side::x_min, {WallType::stick, 0.5}); }),
              HasSubstr("space.walls.x_min.friction is only for type separate and slip"));
  EXPECT_THAT(refusal([&] { s.set_wall(Side::x_min, {WallType::slip, -0.5}); }), HasSubstr("friction"));
  EXPECT_THAT(refusal([&] { s.add(ball("cube", {0.19, 0.16, 0.08})); }), HasSubstr("cube"));
  EXPECT_THAT(refusal([&] { s.add(ball("out", {0.23, 0.16, 0.08})); }), HasSubstr("outside the wall x_max"));
  EXPECT_THAT(refusal([&] { s.add({"b", "jelly", Shape::sphere({0.1, 0.1, 0.1}, -1)}); }),
              HasSubstr("bodies.b.shape.sphere.radius is -1: must be above 0 m"));
  EXPECT_THAT(refusal([&] { s.remove(Shape::sphere({}, -1)); }), HasSubstr("radius"));
  EXPECT_THAT(refusal([&] { s.add_particles("water", std::vector<Vec3d>{{0.1, 0.1, 0.1}, {0.3, 0, 0}}, {}); }),
              HasSubstr("a particle at (0.3, 0, 0) m is outside of the walls"));
  EXPECT_THAT(refusal([&] { s.add_particles("oil", std::vector<Vec3d>{{0.1, 0.1, 0.1}}, {}); }), HasSubstr("oil"));
  EXPECT_EQ(s.hash(), hash);
  EXPECT_EQ(s.scene().yaml(), yaml);
}

}  // namespace
}  // namespace dreampm

// Colliders and rigid bodies that come and go while a simulation runs, and hands that hold them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "dreampm/backend/registry.h"
#include "dreampm/model/scene.h"
#include "scenes.h"

namespace dreampm {
namespace {
using namespace test;
using testing::HasSubstr;

/// A pool, with a collider where `more` has one.
Scene pool(const std::string& more = "") {
  return parse_scene(
      "dreampm: 1\nname: pool\nspace: {min: [0, 0, 0], max: [0.4, 0.4, 0.4], spacing: 0.02}\ntime: {fps: 50}\n"
      "materials:\n  water: {type: newtonian, preset: water, max_compression: 0.03}\n"
      "bodies:\n  pool: {material: water, shape: {box: {min: [0, 0, 0], max: [0.4, 0.12, 0.4]}}}\n" +
          more,
      "pool.yaml");
}

model::Collider crate(const std::string& name, double density, const Vec3d& at, const Vec3d& spin = {}) {
  model::Collider body{name, Shape{BoxShape{{0.12, 0.12, 0.12}}, {0, 1, 0}, 0, at}};
  body.friction = 0.4, body.rigid = {.density = density, .spin = spin};
  return body;
}

std::string refusal(const std::function<void()>& edit) {
  try {
    edit();
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

TEST(ColliderEdits, ARigidBodyThatComesInIsTheSameAsOneOfTheScene) {
  for (const std::string& backend : backends_here()) {
    Simulation from_scene(pool("rigid: {crate: {shape: {box: {size: [0.12, 0.12, 0.12]}}, density: 400, position: "
                               "[0.2, 0.3, 0.2], spin: [0, 1, 0]}}\n"),
                          quiet(1, backend)),
        added(pool(), quiet(1, backend));
    added.add(crate("crate", 400, {0.2, 0.3, 0.2}, {0, 1, 0}));
    EXPECT_EQ(added.scene().yaml(), from_scene.scene().yaml());
    const ColliderState a = from_scene.collider("crate"), b = added.collider("crate");
    EXPECT_NEAR(b.mass, 400 * 0.12 * 0.12 * 0.12, 1e-9);
    EXPECT_EQ(a.mass, b.mass);
    EXPECT_TRUE(a.twist == b.twist && a.pose == b.pose);
    from_scene.advance_to(0.3), added.advance_to(0.3);
    EXPECT_LT(length(from_scene.collider("crate").twist.center - added.collider("crate").twist.center), 2e-3)
        << backend;
  }
}

TEST(ColliderEdits, ACrateFloatsAndABrickSinks) {
  Simulation s(pool(), quiet(2));
  s.advance_to(0.1);
  s.add(crate("crate", 400, {0.1, 0.3, 0.2}));
  s.add(crate("brick", 1800, {0.3, 0.3, 0.2}));
  s.advance_to(1.5);
  // Two fifths of a crate are under water, which has risen by the volume that both displace.
  EXPECT_GT(s.collider("crate").twist.center.y, 0.11);
  EXPECT_LT(s.collider("brick").twist.center.y, 0.08);
  EXPECT_GT(s.collider("brick").twist.center.y, 0.055) << "on the floor";
  EXPECT_EQ(s.totals().particles, 20u * 20 * 6);
  // The force on it is the weight of the water that it displaces, less the part that the floor
  // carries.
  EXPECT_NEAR(s.collider("crate").force.y, 9.81 * s.collider("crate").mass, 4);
}

TEST(ColliderEdits, GiveTheSameBitsForAnyNumberOfThreadsAndAfterASnapshot) {
  for (const std::string& backend : backends_here()) {
    std::uint64_t one = 0;
    for (const int threads : {1, 3}) {
      Simulation s(
          pool("colliders: {post: {shape: {cylinder: {radius: 0.03, height: 0.2}, center: [0.04, 0.28, 0.04]}}}\n"),
          quiet(threads, backend));
      const auto step = [&](int count) {
        for (int n = 0; n < count; ++n) {
          s.step();
          if (n % 4 != 0) continue;
          const Snapshot here = s.snapshot();
          if (threads == 3) s.step(), s.restore(here);
        }
      };
      step(6);
      s.add(crate("low", 400, {0.2, 0.22, 0.2}));
      step(6);
      s.add(crate("high", 900, {0.2, 0.34, 0.21}, {0, 0, 1}));
      s.attach("low", {{0.26, 0.27, 0.2}, {0.3, 0.25, 0.2}, 300, 10});
      step(12);
      s.add({"wall", Shape::box({0.41, -1, -1}, {1, 1, 1})});
      s.set_motion("wall", {{-0.3, 0, 0}, {}, {}});
      step(12);
      s.detach("low");
      s.remove_collider("high");
      step(4);
      s.remove_collider("wall");
      step(4);
      if (threads == 1) one = s.hash();
      EXPECT_EQ(s.hash(), one) << backend;
    }
  }
}

// A wall whose surface is looked for seldom pushes the same water as far, within what it may be
// off.
TEST(ColliderEdits, AMovingColliderWithSlackPushesAlike) {
  double middle[2];
  for (int n = 0; n < 2; ++n) {
    Simulation s(pool(), quiet(2));
    const double slack = n == 0 ? 0.02 : 0.1;
    s.add({"wall", Shape::box({0.4, -1, -1}, {1, 1, 1})});
    s.set_surface_tolerance("wall", slack);
    s.set_motion("wall", {{-0.25, 0, 0}, {}, {}});
    s.advance_to(0.4);
    s.set_motion("wall", {});
    s.advance_to(0.6);
    double x = 0, most = 0;
    for (const Vec3f& p : s.particles("water").position)
      x += static_cast<double>(p.x), most = std::max(most, static_cast<double>(p.x));
    middle[n] = x / static_cast<double>(s.particle_count());
    EXPECT_LT(most, 0.3 + 0.1 * 0.04) << slack;
    EXPECT_EQ(s.particle_count(), 20u * 20 * 6);
  }
  EXPECT_NEAR(middle[0], middle[1], 0.01);
}

TEST(ColliderEdits, SayWhatIsWrong) {
  Simulation s(
      pool("rigid: {raft: {shape: {box: {size: [0.1, 0.04, 0.1]}}, density: 300, position: [0.3, 0.35, 0.3]}}\n"
           "probes: {track: {type: pose, on: raft}}\n"),
      quiet());
  s.advance_to(0.02);
  const std::uint64_t before = s.hash();
  EXPECT_THAT(refusal([&] { s.add(crate("raft", 400, {0.1, 0.3, 0.1})); }), HasSubstr("give another"));
  EXPECT_THAT(refusal([&] { s.add(crate("water", 400, {0.1, 0.3, 0.1})); }), HasSubstr("give another"));
  EXPECT_THAT(refusal([&] { s.add(crate("a", 400, {0.3, 0.33, 0.3})); }), HasSubstr("inside of raft"));
  EXPECT_THAT(refusal([&] { s.add(crate("a", 400, {0.1, 0.1, 0.1})); }), HasSubstr("particles lie inside of it"));
  EXPECT_THAT(refusal([&] { s.add(crate("a", 400, {0.02, 0.3, 0.1})); }), HasSubstr("outside the wall x_min"));
  EXPECT_THAT(refusal([&] { s.add(crate("a", 1e9, {0.1, 0.3, 0.1})); }), HasSubstr("density"));
  model::Collider nowhere = crate("a", 400, {});
  nowhere.shape.center.reset();
  EXPECT_THAT(refusal([&] { s.add(nowhere); }), HasSubstr("position"));
  model::Collider pinned = crate("a", 400, {0.1, 0.3, 0.1});
  pinned.motion.emplace();
  EXPECT_THAT(refusal([&] { s.add(pinned); }), HasSubstr("rigid.a.motion is only for colliders"));
  EXPECT_THAT(refusal([&] { s.remove_collider("boat"); }), HasSubstr("it has raft"));
  EXPECT_THAT(refusal([&] { s.remove_collider("raft"); }), HasSubstr("probes.track"));
  EXPECT_THAT(refusal([&] { s.attach("boat", {{}, {}, 1, 1}); }), HasSubstr("it has raft"));
  EXPECT_THAT(refusal([&] { s.attach("raft", {{}, {}, 0, 1}); }), HasSubstr("stiffness above 0"));
  EXPECT_THAT(refusal([&] { s.add({"a", Shape::box({0, 0, 0}, {0.1, 0.1, 0.1})}); }),
              HasSubstr("particles lie inside of it"));
  EXPECT_THAT(refusal([&] { s.add({"a", Shape::box({0.25, 0.3, 0.25}, {0.3, 0.4, 0.3})}); }),
              HasSubstr("rigid body raft starts"));
  model::Collider rough{"a", Shape::box({0, 0.3, 0}, {0.1, 0.4, 0.1})};
  rough.type = WallType::stick, rough.friction = 0.2;
  EXPECT_THAT(refusal([&] { s.add(rough); }), HasSubstr("colliders.a.friction is only for type separate and slip"));
  EXPECT_THAT(refusal([&] { s.set_surface_tolerance("raft", 0.5); }), HasSubstr("0.25 cells"));
  EXPECT_EQ(s.hash(), before) << "what is refused changes nothing";
}

// A hand draws the held point to where it is; with the whole weight of the body on it the spring
// gives way by m g / k.
TEST(ColliderEdits, MatterComesInWhereNothingStandsNow) {
  Simulation s(pool(), quiet(2));
  s.add(crate("crate", 400, {0.1, 0.3, 0.2}));
  s.add({"post", Shape::box({0.26, 0.2, 0.16}, {0.34, 0.4, 0.24})});
  s.advance_to(0.3);
  ASSERT_LT(s.collider("crate").twist.center.y, 0.2) << "it has fallen";
  s.add({"drop", "water", Shape::box({0.06, 0.3, 0.16}, {0.14, 0.36, 0.24})});
  EXPECT_THAT(refusal([&] { s.add({"in post", "water", Shape::box({0.28, 0.3, 0.18}, {0.32, 0.36, 0.22})}); }),
              HasSubstr("post"));
}

TEST(ColliderEdits, AHeldBodyHangsFromThePointThatIsHeld) {
  Simulation s(pool(), quiet());
  s.add(crate("crate", 400, {0.2, 0.22, 0.2}));
  const double k = 5e3, m = s.collider("crate").mass;
  const Vec3d corner{0.26, 0.28, 0.2}, to{0.22, 0.33, 0.2};
  s.attach("crate", {s.collider("crate").pose.inverse(corner), to, k, 60});
  s.advance_to(2);
  const ColliderState held = s.collider("crate");
  const Vec3d point = held.pose(corner);
  EXPECT_LT(length(point - (to - Vec3d{0, m * 9.81 / k, 0})), 0.01);
  EXPECT_LT(held.twist.center.y, point.y - 0.06) << "it hangs below";
  EXPECT_LT(std::abs(held.twist.center.x - point.x), 0.04);
  s.detach("crate");
  s.advance_to(2.06);
  EXPECT_LT(s.collider("crate").twist.velocity.y, -0.4) << "it falls";
}

// However stiff the spring and however long the step, nothing flies away.
TEST(ColliderEdits, AHoldIsStableHoweverStiffItIs) {
  for (const double k : {1e2, 1e5, 1e9}) {
    Simulation s(pool(), quiet());
    s.add(crate("crate", 400, {0.2, 0.3, 0.2}));
    s.attach("crate", {{0.26, 0.3, 0.26}, {0.3, 0.32, 0.2}, k, 0.02 * k});
    for (int n = 0; n < 150; ++n) {
      s.step();
      ASSERT_LT(length(s.collider("crate").twist.velocity), 8) << k;
    }
  }
}

TEST(ColliderEdits, OneMaterialBecomesAnotherWhereItIs) {
  Simulation s(pool("emitters: {tap: {material: water, shape: {sphere: {radius: 0.03}, center: [0.2, 0.35, 0.2]}, "
                    "velocity: [0, -1, 0], pool: 500}}\n"),
               quiet());
  s.advance_to(0.05);
  s.add_material(parse_material("{type: newtonian, preset: honey, bulk_modulus: 2.0e5}", "honey"));
  const ParticleView before = s.particles("water");
  const std::vector<std::uint32_t> ids(before.id.begin(), before.id.end());
  const std::vector<Vec3f> velocity(before.velocity.begin(), before.velocity.end());
  EXPECT_EQ(s.convert("water", "honey"), ids.size());
  const ParticleView after = s.particles("honey");
  EXPECT_TRUE(std::equal(ids.begin(), ids.end(), after.id.begin(), after.id.end()));
  EXPECT_TRUE(std::equal(velocity.begin(), velocity.end(), after.velocity.begin(), after.velocity.end()));
  EXPECT_EQ(s.particles("water").size(), 0u);
  for (const float j : after.J) EXPECT_EQ(j, 1);
  s.advance_to(0.1);
  EXPECT_EQ(s.particles("water").size(), 0u) << "the tap gives honey";
  EXPECT_GT(s.particles("honey").size(), ids.size());
  const Totals t = s.totals();
  EXPECT_EQ(t.entered, t.removed);
  EXPECT_THAT(refusal([&] { s.convert("water", "lava"); }), HasSubstr("lava"));
}

}  // namespace
}  // namespace dreampm

// Impacts of rigid bodies, without matter.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "dreampm/rigid/bullet_contacts.h"

namespace dreampm {
namespace {

/// Bodies in a box with walls all around, and the step that the solver gives them.
struct Bodies {
  std::vector<Collider> colliders;
  std::vector<CollisionShape> shapes;
  std::vector<RigidBody> bodies;
  BodyRoom room;
  Vec3d gravity{0, -9.81, 0};
  std::unique_ptr<BodyContacts> contacts;

  explicit Bodies(const Vec3d& corner = {}) {
    room.box = {corner, corner + Vec3d{2, 2, 2}}, room.cell = 0.04;
    for (int a = 0; a < 3; ++a)
      for (const double side : {1.0, -1.0}) {
        Vec3d normal{};
        normal[a] = side;
        room.walls.push_back({side > 0 ? room.box.min : room.box.max, normal});
      }
  }
  /// A ball, or a box of that size.
  std::size_t add(const Shape& shape, double mass, double restitution, const Twist& twist) {
    Collider c;
    c.name = "body" + std::to_string(colliders.size());
    c.shape = make_region(shape, 0.02, {});
    c.rigid = true, c.twist = twist, c.twist.center = *shape.center;
    RigidBody body{colliders.size(), mass, *shape.center, {}, restitution};
    if (const auto* ball = std::get_if<SphereShape>(&shape.form)) {
      body.inertia = Mat3d::identity() * (0.4 * mass * ball->radius * ball->radius);
    } else {
      const Vec3d d = std::get<BoxShape>(shape.form).size, d2 = d * d;
      body.inertia = Mat3d::diagonal(d2.y + d2.z, d2.x + d2.z, d2.x + d2.y) * (mass / 12);
    }
    colliders.push_back(std::move(c)), shapes.push_back({shape, nullptr}), bodies.push_back(body);
    return colliders.size() - 1;
  }
  void step(double dt) {
    if (!contacts) contacts = make_bullet_contacts(shapes, room);
    std::vector<Twist> before;
    for (const RigidBody& b : bodies) {
      Collider& c = colliders[b.collider];
      before.push_back(c.twist);
      c.twist.velocity += gravity * dt;
      const Mat3d inertia = inertia_now(b, c);
      c.twist.spin -= inverse(inertia) * cross(c.twist.spin, inertia * c.twist.spin) * dt;
    }
    contacts->resolve(colliders, bodies, before, dt);
    for (Collider& c : colliders) c.advance(dt), c.settle(0);
  }
};

Shape ball(const Vec3d& center, double radius) { return {SphereShape{radius}, {0, 1, 0}, 0, center}; }
Shape box(const Vec3d& center, const Vec3d& size) { return {BoxShape{size}, {0, 1, 0}, 0, center}; }

constexpr double fall = 0.7;

/// How high a body of half the height `half` comes back that fell by `fall` [m].
double rebound(const Shape& shape, double half, double restitution, double dt) {
  Bodies world;
  world.add(shape, 1, restitution, {});
  bool met = false;
  double highest = 0, lowest = 1;
  // Until the second impact would come.
  const double once = std::sqrt(2 * fall / 9.81);
  for (double time = 0; time < once * (1 + 1.5 * restitution) + 5 * dt; time += dt) {
    world.step(dt);
    const double height = world.colliders[0].twist.center.y - half;
    met = met || world.colliders[0].twist.velocity.y >= 0;
    lowest = std::min(lowest, height);
    if (met) highest = std::max(highest, height);
  }
  EXPECT_GT(lowest, -0.021) << "entered the floor";
  return highest;
}

// A body that falls comes back to the square of its restitution, however long the steps are.
TEST(RigidContacts, GiveBackWhatRestitutionSaysAtAnyStep) {
  double worst = 0;
  for (const double restitution : {0.0, 0.3, 0.6, 0.9, 1.0})
    for (const double dt : {0.0001, 0.0005, 0.0017, 0.003, 0.005})
      for (const bool is_ball : {true, false}) {
        const Vec3d at{1, fall + 0.1, 1};
        const double high = rebound(is_ball ? ball(at, 0.1) : box(at, {0.2, 0.2, 0.2}), 0.1, restitution, dt);
        const double off = std::abs(high - restitution * restitution * fall) / fall;
        worst = std::max(worst, off);
        EXPECT_LT(off, 0.03) << (is_ball ? "ball" : "cube") << " of " << restitution << " at steps of " << dt
                             << " s: " << high << " m";
      }
  std::printf("off by up to %.2f %% of the height\n", 100 * worst);
}

// Two equal balls of restitution 1 meet: one stops, and the other goes on.
TEST(RigidContacts, PassOnTheSpeedOfABall) {
  for (const double dt : {0.0005, 0.004}) {
    Bodies world;
    world.gravity = {};
    world.add(ball({0.5, 1, 1}, 0.1), 1, 1, {{1.5, 0, 0}, {}, {}});
    world.add(ball({1.1, 1, 1}, 0.1), 1, 1, {});
    for (double time = 0; time < 0.5; time += dt) world.step(dt);
    EXPECT_NEAR(world.colliders[0].twist.velocity.x, 0, 0.01) << dt;
    EXPECT_NEAR(world.colliders[1].twist.velocity.x, 1.5, 0.01) << dt;
  }
}

// A plate that tumbles far off moves the same, whether others touch or not.
TEST(RigidContacts, LeaveAloneWhatTouchesNothing) {
  const auto tumble = [](bool with_others) {
    Bodies world;
    world.gravity = {};
    world.add(box({1.2, 1.2, 1}, {0.3, 0.2, 0.05}), 3, 0, {{}, {0.05, 4, 0.05}, {}});
    if (with_others) {
      world.add(box({0.3, 0.3, 0.3}, {0.1, 0.1, 0.1}), 1, 0, {{0.05, 0, 0}, {}, {}});
      world.add(box({0.405, 0.3, 0.3}, {0.1, 0.1, 0.1}), 1, 0, {{-0.05, 0, 0}, {}, {}});
    }
    for (int n = 0; n < 300; ++n) world.step(0.002);
    if (with_others) {
      EXPECT_LT(world.colliders[1].twist.velocity.x, 0.04);
    }
    return world.colliders[0].twist;
  };
  EXPECT_EQ(tumble(true), tumble(false));
}

// A spinning plate that others touch turns as gyroscopic torque has it, once.
TEST(RigidContacts, TurnASpinningBodyOnce) {
  Bodies world;
  world.gravity = {};
  world.add(box({1.2, 1.2, 1}, {0.3, 0.2, 0.05}), 3, 0, {{}, {0.05, 4, 0.05}, {}});
  // Rides along on its middle, and weighs next to nothing.
  world.add(ball({1.2, 1.2, 1.03}, 0.005), 1e-9, 0, {});
  const auto angular = [&] { return inertia_now(world.bodies[0], world.colliders[0]) * world.colliders[0].twist.spin; };
  const Vec3d before = angular();
  for (int n = 0; n < 250; ++n) world.step(0.002);
  EXPECT_LT(length(angular() - before), 0.03 * length(before));
}

// Crates stack as well far from the origin.
TEST(RigidContacts, StackFarFromTheOrigin) {
  for (const double far : {0.0, 1e5, 1e7}) {
    const Vec3d corner{far, 0, -far};
    Bodies world(corner);
    world.add(box(corner + Vec3d{1, 0.12, 1}, {0.3, 0.2, 0.3}), 9, 0, {});
    world.add(box(corner + Vec3d{1, 0.34, 1}, {0.2, 0.2, 0.2}), 4, 0, {});
    for (int n = 0; n < 300; ++n) world.step(0.003);
    EXPECT_NEAR(world.colliders[0].twist.center.y, 0.1, 0.005) << far;
    EXPECT_NEAR(world.colliders[1].twist.center.y, 0.3, 0.01) << far;
    EXPECT_NEAR(world.colliders[1].twist.center.x - far, 1, 0.01) << far;
  }
}

}  // namespace
}  // namespace dreampm

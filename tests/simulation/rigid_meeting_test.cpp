// Rigid bodies meet hollows, periodic copies, sequences of meshes, calm water.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "scenes.h"

namespace dreampm {
namespace {
using namespace test;

/// A scene with a drop of water in a corner, for it needs some matter.
std::string with(const std::string& rest, const std::string& space = "{max: [1, 1, 1], spacing: 0.02}",
                 const std::string& drop = "{box: {min: [0.9, 0, 0.9], max: [0.96, 0.06, 0.96]}}") {
  return "dreampm: 1\nname: meeting\nspace: " + space +
         "\ntime: {fps: 50}\nmaterials: {water: {type: newtonian, preset: water, max_compression: 0.03}}\n"
         "bodies: {drop: {material: water, shape: " +
         drop + "}}\n" + rest + "\n";
}

// A ball let go in a cup stays there: the cup is not its convex hull.
TEST(RigidMeeting, ABallRestsInACup) {
  Simulation s(
      parse_scene(with("rigid:\n  cup: {shape: {container: {cylinder: {radius: 0.14, height: 0.2}, wall: 0.04, cut: "
                       "0}}, density: 700, position: [0.4, 0.13, 0.4]}\n  ball: {shape: {sphere: {radius: 0.05}}, "
                       "density: 700, position: [0.45, 0.2, 0.4]}"),
                  "cup.yaml"),
      quiet());
  double highest = 0;
  while (s.time() < 1) {
    s.step();
    highest = std::max(highest, s.collider("ball").twist.center.y);
  }
  const Vec3d ball = s.collider("ball").twist.center, cup = s.collider("cup").twist.center;
  std::printf("ball at %.4f m, %.4f m from the middle\n", ball.y, std::hypot(ball.x - 0.4, ball.z - 0.4));
  EXPECT_LT(highest, 0.21);
  EXPECT_NEAR(ball.y, 0.09, 0.01) << "on the bottom of the hollow";
  EXPECT_LT(std::hypot(ball.x - cup.x, ball.z - cup.z), 0.1) << "inside";
  EXPECT_LT(length(s.collider("cup").twist.velocity), 0.02);
}

// Upside down over a post a cup comes to hang on it; a hull would have been thrown off.
TEST(RigidMeeting, ACupHangsOnAPost) {
  Simulation s(
      parse_scene(with("colliders: {post: {shape: {box: {min: [0.35, 0, 0.35], max: [0.45, 0.4, 0.45]}}, type: slip}}\n"
                       "rigid:\n  cup: {shape: {container: {box: {size: [0.2, 0.2, 0.2]}, wall: 0.04, cut: 0}, rotate: "
                       "{axis: [1, 0, 0], angle: 180}}, density: 700, position: [0.4, 0.36, 0.4]}"),
                  "post.yaml"),
      quiet());
  s.advance_to(1);
  const ColliderState cup = s.collider("cup");
  std::printf("cup at %.4f m, %.2g m/s\n", cup.twist.center.y, length(cup.twist.velocity));
  EXPECT_GT(cup.twist.center.y, 0.33);
  EXPECT_LT(cup.twist.center.y, 0.45);
  EXPECT_LT(std::hypot(cup.twist.center.x - 0.4, cup.twist.center.z - 0.4), 0.06);
}

// On a periodic axis a ball goes out at one end and comes in at the other, where it meets another.
TEST(RigidMeeting, BallsMeetBeyondAPeriodicEnd) {
  Simulation s(parse_scene(with("gravity: [0, 0, 0]\nrigid:\n"
                                "  fast: {shape: {sphere: {radius: 0.06}}, density: 500, position: [0.7, 0.3, 0.24], "
                                "velocity: [0.8, 0, 0], restitution: 1, friction: 0}\n"
                                "  slow: {shape: {sphere: {radius: 0.06}}, density: 500, position: [0.03, 0.3, 0.24], "
                                "restitution: 1, friction: 0}",
                                "{max: [0.96, 0.48, 0.48], spacing: 0.02, periodic: [x]}",
                                "{box: {min: [0.4, 0, 0.4], max: [0.46, 0.06, 0.46]}}"),
                           "round.yaml"),
               quiet());
  s.advance_to(0.5);
  EXPECT_NEAR(s.collider("fast").twist.velocity.x, 0, 0.01);
  EXPECT_NEAR(s.collider("slow").twist.velocity.x, 0.8, 0.01);
  EXPECT_LT(length(s.collider("slow").twist.spin), 1e-3) << "it was hit in the middle";
  EXPECT_NEAR(s.collider("slow").twist.center.x, 0.03 + 0.8 * (s.time() - 0.17 / 0.8), 0.01);
  s.advance_to(1.5);
  EXPECT_LT(s.collider("slow").twist.center.x, 0.96) << "where all else is";
  EXPECT_GT(s.collider("slow").twist.center.x, 0);
}

// A floor that is a sequence of meshes and rises takes along what lies on it.
TEST(RigidMeeting, ASequenceOfMeshesLiftsACrate) {
  const auto folder = std::filesystem::temp_directory_path() / ("dreampm_lift_" + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  for (int file = 1; file < 5; ++file) {
    std::ofstream out(folder / ("floor." + std::to_string(file) + ".obj"));
    for (int n = 0; n < 8; ++n)
      out << "v " << (n & 1 ? 0.7 : 0.1) << ' ' << (n & 2 ? 0.1 + 0.04 * file : 0.04) << ' ' << (n & 4 ? 0.7 : 0.1)
          << '\n';
    out << "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
  }
  Simulation s(parse_scene(with("colliders: {floor: {shape: {meshes: " + folder.string() +
                                "/floor.#.obj, fps: 10}, type: slip}}\nrigid:\n  crate: {shape: {box: {size: [0.2, "
                                "0.2, 0.2]}}, density: 500, position: [0.4, 0.26, 0.4]}"),
                           "lift.yaml"),
               quiet());
  double off = 0;
  while (s.time() < 0.28) {
    s.step();
    off = std::max(off, std::abs(s.collider("crate").twist.center.y - (0.24 + 0.4 * s.time())));
  }
  EXPECT_LT(off, 0.021);
  EXPECT_NEAR(s.collider("crate").twist.center.y, 0.24 + 0.4 * s.time(), 0.008);
  EXPECT_NEAR(s.collider("crate").twist.velocity.y, 0.4, 0.1);
  std::filesystem::remove_all(folder);
}

// Pressure goes through the middle of a ball and cannot turn it.
TEST(RigidMeeting, BallsInCalmWaterDoNotSpin) {
  Simulation s(
      parse_scene(with("rigid:\n  a: {shape: {sphere: {radius: 0.04}}, density: 100, position: [0.15, 0.12, "
                       "0.2]}\n  b: {shape: {sphere: {radius: 0.04}}, density: 100, position: [0.25, 0.12, "
                       "0.2], friction: 0}",
                       "{max: [0.4, 0.3, 0.4], spacing: 0.02}", "{box: {min: [0, 0, 0], max: [0.4, 0.06, 0.4]}}"),
                  "calm.yaml"),
      quiet());
  double fastest = 0;
  while (s.time() < 2) {
    s.step();
    fastest = std::max({fastest, length(s.collider("a").twist.spin), length(s.collider("b").twist.spin)});
  }
  std::printf("spin up to %.2g rad/s\n", fastest);
  EXPECT_LT(fastest, 0.1);
}

}  // namespace
}  // namespace dreampm

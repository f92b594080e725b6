// Colliders of scenes: what they take of space, whether matter starts inside of them, and whether
// they are too thin.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>

#include "dreampm/backend/cpu/cpu.h"
#include "dreampm/base/error.h"
#include "dreampm/geometry/openness.h"
#include "dreampm/scene/parse.h"
#include "dreampm/setup/assemble.h"
#include "dreampm/setup/collider_mesh.h"
#include "dreampm/setup/colliders.h"
#include "dreampm/setup/in_time.h"
#include "dreampm/solver/step.h"
#include "dreampm/surface/attributes.h"

namespace dreampm {
namespace {

/// A cell is 0.02 m.
InitialState assembled(const std::string& colliders,
                       const std::string& body = "{box: {size: [0.04, 0.04, 0.04]}, center: [0.5, 0.5, 0.5]}",
                       const std::string& walls = "{}", const std::string& material = "{type: elastic, preset: jelly}",
                       const std::string& more = "") {
  const auto parsed = scene::parse_scene_text(
      fmt::format(
          "dreampm: 1\nname: walls\nspace: {{min: [0, 0, 0], max: [0.6, 0.6, 0.6], spacing: 0.01, walls: {}{}}}\n"
          "time: {{fps: 10, frames: 1}}\nmaterials: {{jelly: {}}}\n"
          "bodies:\n  cube: {{material: jelly, shape: {}, sample: {{pattern: lattice}}}}\ncolliders: {}\n",
          walls, more, material, body, colliders),
      "walls.yaml");
  EXPECT_TRUE(parsed.ok()) << parsed.text();
  return assemble(parsed.scene, "walls.yaml");
}
template <class... A>
std::string warned(const A&... arguments) {
  return fmt::format("{}", fmt::join(assembled(arguments...).warnings, "\n"));
}
template <class... A>
std::string refused(const A&... arguments) {
  try {
    assembled(arguments...);
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

TEST(ThinColliders, APlateOfLessThanHalfACellIsNamed) {
  const std::string said = warned("{plate: {shape: {box: {min: [0.1, 0.3, 0.1], max: [0.4, 0.309, 0.4]}}}}");
  EXPECT_NE(said.find("collider plate is 0.009 m thick at (0."), std::string::npos) << said;
  EXPECT_NE(said.find(", 0.3045, 0."), std::string::npos) << said;
  EXPECT_NE(said.find("less than half a cell of 0.02 m: matter may pass through; make it thicker, or space.spacing "
                      "0.009 m or less"),
            std::string::npos)
      << said;
  EXPECT_EQ(warned("{plate: {shape: {box: {min: [0.1, 0.3, 0.1], max: [0.4, 0.3101, 0.4]}}}}"), "");
}

TEST(ThinColliders, AlsoOneThatLiesAskewAndIsHardlyThere) {
  for (const char* turn :
       {"{axis: [1, 0, 0], angle: 45}", "{axis: [1, 0, -1], angle: 54.7356}", "{axis: z, angle: 20}"}) {
    EXPECT_NE(
        warned(
            fmt::format(
                "{{p: {{shape: {{box: {{size: [0.25, 0.004, 0.25]}}, center: [0.3, 0.25, 0.3], rotate: {}}}}}}}", turn))
            .find("collider p is 0.004 m thick"),
        std::string::npos)
        << turn;
    EXPECT_NE(
        warned(fmt::format(
                   "{{p: {{shape: {{box: {{size: [0.25, 0.0001, 0.25]}}, center: [0.3, 0.25, 0.3], rotate: {}}}}}}}",
                   turn))
            .find("collider p is 0.0001 m thick"),
        std::string::npos)
        << turn;
    EXPECT_EQ(
        warned(fmt::format(
            "{{p: {{shape: {{box: {{size: [0.25, 0.011, 0.25]}}, center: [0.3, 0.25, 0.3], rotate: {}}}}}}}", turn)),
        "")
        << turn;
  }
}

TEST(ThinColliders, EdgesCornersAndRoundThingsAreNone) {
  for (const char* shape :
       {"{box: {size: [0.1, 0.1, 0.1]}, center: [0.2, 0.2, 0.2], rotate: {axis: [1, 2, 3], angle: 33}}",
        "{sphere: {radius: 0.05}, center: [0.2, 0.2, 0.2]}",
        "{cylinder: {radius: 0.05, height: 0.1}, center: [0.2, 0.2, 0.2], rotate: {axis: x, angle: 40}}",
        "{difference: [{cylinder: {radius: 0.1, height: 0.2}, center: [0.2, 0.2, 0.2]}, {cylinder: {radius: 0.085, "
        "height: 0.2}, center: [0.2, 0.22, 0.2]}]}",
        "{plane: {point: [0, 0.02, 0], normal: [0.1, 1, 0]}}"})
    EXPECT_EQ(warned(fmt::format("{{p: {{shape: {}}}}}", shape)), "") << shape;
}

/// A wedge between two planes with an edge of that angle [degrees].
std::string wedge(double angle) {
  const double a = angle * std::numbers::pi / 180;
  return fmt::format(
      "{{w: {{shape: {{intersection: [{{box: {{min: [0.05, 0.1, 0.1], max: [0.4, 0.5, 0.4]}}}}, "
      "{{plane: {{point: [0.1, 0.3, 0], normal: [{}, 1, 0]}}}}, {{plane: {{point: [0.1, 0.3, 0], normal: [{}, -1, "
      "0]}}}}]}}}}}}",
      -std::tan(a / 2), -std::tan(a / 2));
}
TEST(ThinColliders, AWedgeIsThinWhereThatIsMoreThanACellWide) {
  EXPECT_EQ(warned(wedge(60)), "");
  EXPECT_EQ(warned(wedge(30)), "");
  EXPECT_NE(warned(wedge(8)).find("collider w is"), std::string::npos);
}

TEST(ThinColliders, WhatAWallOrAnotherColliderCoversIsNotThin) {
  EXPECT_EQ(warned("{mat: {shape: {box: {min: [0.1, -0.1, 0.1], max: [0.4, 0.005, 0.4]}}}}"), "");
  EXPECT_EQ(warned("{mat: {shape: {box: {min: [0.1, 0, 0.1], max: [0.4, 0.005, 0.4]}}}}"), "");
  EXPECT_NE(warned("{mat: {shape: {box: {min: [0.1, 0, 0.1], max: [0.4, 0.005, 0.4]}}}}",
                   "{box: {size: [0.04, 0.04, 0.04]}, center: [0.5, 0.5, 0.5]}", "{floor: {type: open}}")
                .find("collider mat is 0.005 m thick"),
            std::string::npos);
  EXPECT_EQ(warned("{mat: {shape: {box: {min: [0.1, 0.2, 0.1], max: [0.4, 0.205, 0.4]}}}, table: {shape: {box: {min: "
                   "[0.1, 0.1, 0.1], max: [0.4, 0.2, 0.4]}}}}"),
            "");
}

/// The lower half of a ball of 0.1 m about the origin, open at the top, as an OFF file of one layer
/// of faces.
class OpenBowl : public testing::Test {
 protected:
  void SetUp() override {
    path = std::filesystem::temp_directory_path() / fmt::format("dreampm-bowl-{}.off", ::getpid());
    constexpr int around = 48, rows = 16;
    std::ofstream out(path);
    out << "OFF\n" << around * rows + 1 << ' ' << around * (2 * rows - 1) << " 0\n0 -0.1 0\n";
    const auto at = [&](int row, int i) { return row == 0 ? 0 : 1 + (row - 1) * around + (i + around) % around; };
    for (int row = 1; row <= rows; ++row)
      for (int i = 0; i < around; ++i) {
        const double a = std::numbers::pi / 2 * row / rows, b = 2 * std::numbers::pi * i / around;
        out << 0.1 * std::sin(a) * std::cos(b) << ' ' << -0.1 * std::cos(a) << ' ' << 0.1 * std::sin(a) * std::sin(b)
            << '\n';
      }
    for (int row = 0; row < rows; ++row)
      for (int i = 0; i < around; ++i) {
        out << "3 " << at(row, i) << ' ' << at(row + 1, i) << ' ' << at(row + 1, i + 1) << '\n';
        if (row > 0) out << "3 " << at(row, i) << ' ' << at(row + 1, i + 1) << ' ' << at(row, i + 1) << '\n';
      }
  }
  void TearDown() override { std::filesystem::remove(path); }
  std::string bowl(double thickness) const {
    return fmt::format("{{bowl: {{shape: {{mesh: {}, center: [0.3, 0.25, 0.3]}}, thickness: {}}}}}", path.string(),
                       thickness);
  }
  std::filesystem::path path;
};

TEST_F(OpenBowl, IsAContainerOfItsThickness) {
  const InitialState all = assembled(bowl(0.012), "{sphere: {radius: 0.08}, center: [0.3, 0.3, 0.3]}");
  EXPECT_TRUE(all.warnings.empty()) << all.warnings[0];
  const Region& wall = *all.world.colliders.at(0).shape;
  // The middle of the ball is the middle of the mesh's bounds and half of its radius.
  const Vec3d middle{0.3, 0.3, 0.3};
  EXPECT_NEAR(wall.distance(middle - Vec3d{0, 0.104, 0}), -0.002, 0.0003);
  EXPECT_NEAR(wall.distance(middle - Vec3d{0, 0.096, 0}), -0.002, 0.0003);
  EXPECT_LT(wall.distance(middle - Vec3d{0, 0.1, 0}), -0.003);
  EXPECT_GT(wall.distance(middle - Vec3d{0, 0.09, 0}), 0);
  EXPECT_GT(wall.distance(middle - Vec3d{0, 0.11, 0}), 0);
  EXPECT_NEAR(wall.distance(middle - Vec3d{0.12, 0, 0}), 0.014, 0.001);
}

TEST_F(OpenBowl, HoldsWater) {
  const InitialState all = assembled(bowl(0.013), "{sphere: {radius: 0.05}, center: [0.3, 0.26, 0.3]}", "{}",
                                     "{type: newtonian, preset: water, max_compression: 0.1}");
  World<float> world = as_world<float>(all.world);
  const auto backend = make_cpu_backend();
  begin(world, *backend, all.seeds);
  while (world.time < 1) step<float>(world, *backend, nullptr);
  ASSERT_EQ(world.particles(), all.particles());
  const auto& set = world.sets[0];
  for (std::size_t b = 0; b < world.particle_blocks.size(); ++b)
    for (std::size_t p = set.block_start[b]; p < set.block_start[b + 1]; ++p) {
      const Vec3d at = world.position(world.particle_blocks[b], {set.u[0][p], set.u[1][p], set.u[2][p]});
      ASSERT_TRUE(at.y > 0.3 || length(at - Vec3d{0.3, 0.3, 0.3}) < 0.1 + 0.013 / 2)
          << at.x << ' ' << at.y << ' ' << at.z << ": lost";
    }
}

TEST_F(OpenBowl, IsDrawnWithBothSides) {
  Shape shape;
  shape.form = MeshShape{path.string(), {}, {}};
  shape.center = Vec3d{0.3, 0.25, 0.3};
  const TriMesh drawn = collider_mesh(shape, 0.01, {{0, 0, 0}, {0.6, 0.6, 0.6}}, {}, 0.012);
  EXPECT_EQ(openness(drawn).open_edges, 0u);
  const double half_a_ball = 2 * std::numbers::pi * 0.01,
               rim = std::numbers::pi / 4 * 0.012 * 2 * std::numbers::pi * 0.1;
  // Half of its rim is round, and stands over the edge of the mesh.
  EXPECT_NEAR(surface::enclosed_volume(drawn) / ((half_a_ball + rim / 2) * 0.012), 1, 0.03);
}

TEST_F(OpenBowl, ThinnerThanHalfACellIsNamed) {
  EXPECT_EQ(warned(bowl(0.01)), "");
  const std::string said = warned(bowl(0.007));  // where faces meet, the bowl is a little thinner
  EXPECT_NE(said.find("collider bowl is 0.0069 m thick"), std::string::npos) << said;
}

TEST(WithinColliders, MatterThatStartsThereIsAnError) {
  const std::string post = "{post: {shape: {box: {min: [0, 0, 0], max: [0.3, 0.6, 0.6]}}HOLDS}}";
  const auto with = [&](const std::string& holds) {
    std::string text = post;
    return text.replace(text.find("HOLDS"), 5, holds);
  };
  const auto box = [](double low) { return fmt::format("{{box: {{min: [{}, 0, 0], max: [0.5, 0.1, 0.6]}}}}", low); };
  EXPECT_EQ(refused(with(""), box(0.2)),
            "walls.yaml:7:3: error: 0.006 m^3 of body cube lie within collider post, up to 0.095 m deep: cut it out of "
            "the body with cut: [post], or say holds: true of the collider");
  EXPECT_EQ(refused(with(""), box(0.3)), "");
  EXPECT_EQ(warned(with(""), box(0.3)), "");
  EXPECT_EQ(refused(with(""),
                    fmt::format("{{difference: [{}, {{box: {{min: [0, 0, 0], max: [0.3, 0.6, 0.6]}}}}]}}", box(0.2))),
            "");
  // The first particles lie at 0.295.
  const auto to = [](double high) {
    return fmt::format("{{post: {{shape: {{box: {{min: [0, 0, 0], max: [{}, 0.6, 0.6]}}}}}}}}", high);
  };
  const std::string shallow = warned(to(0.2965), box(0.29));
  EXPECT_NE(shallow.find("0.0006 m^3 of body cube lie within collider post, up to 0.0015 m deep, and will be pressed"),
            std::string::npos)
      << shallow;
  EXPECT_NE(refused(to(0.2975), box(0.29)), "");
  EXPECT_EQ(warned(to(0.295), box(0.29)), "");

  // Across the seam of a periodic axis, where the space is made 0.64 m long, it stands a second
  // time.
  const std::string ball = "{ball: {shape: {sphere: {radius: 0.1}, center: [0.02, 0.3, 0.3]}}}";
  const std::string cube = "{box: {size: [0.03, 0.04, 0.04]}, center: [0.58, 0.3, 0.3]}";
  EXPECT_EQ(refused(ball, cube), "");
  EXPECT_NE(refused(ball, cube, "{}", "{type: elastic, preset: jelly}", ", periodic: [x]")
                .find("of body cube lie within collider ball"),
            std::string::npos);

  const InitialState held = assembled(with(", holds: true"), box(0.2));
  EXPECT_TRUE(held.warnings.empty()) << held.warnings[0];
  EXPECT_TRUE(held.world.colliders.at(0).holds);
  EXPECT_EQ(held.notes, std::vector<std::string>{"0.006 m^3 of body cube lie within collider post, which holds them"});
}

/// Messages about a shell around a bowl 10 m wide.
class WideBowl : public OpenBowl {
 protected:
  std::string said(double thickness, double spacing) const {
    model::Collider collider;
    collider.shape.form = MeshShape{path.string(), 10, std::nullopt};
    collider.thickness = thickness;
    model::Space space;
    space.spacing = spacing;
    try {
      collider_region(collider, space, Meshes(Meshes::Say::log));
    } catch (const InputError& e) {
      return e.what();
    }
    return "";
  }
  /// The number after these words; 0 without them.
  static double number(const std::string& text, const std::string& words) {
    const std::size_t at = text.find(words);
    return at == std::string::npos ? 0 : std::stod(text.substr(at + words.size()));
  }
};

TEST_F(WideBowl, IsRefusedWithWhatWouldDo) {
  // Voxels are a third of the thickness.
  const std::string thin = said(0.001, 0.05);
  const double thickness = number(thin, "a thickness of ");
  EXPECT_GT(thickness, 0.01) << thin;
  EXPECT_LT(thickness, 0.1) << thin;
  EXPECT_EQ(thin.find("space.spacing"), std::string::npos) << thin;
  EXPECT_NE(said(0.9 * thickness, 0.05), "") << "no less would do";
  // They are a third of a cell: a thicker shell takes no less.
  const std::string fine = said(0.05, 0.002);
  const double spacing = number(fine, "a space.spacing of ");
  EXPECT_GT(spacing, 0.004) << fine;
  EXPECT_LT(spacing, 0.05) << fine;
  EXPECT_EQ(fine.find("a thickness of"), std::string::npos) << fine;
  EXPECT_NE(said(0.05, 0.9 * spacing), "") << "no less would do";
  // Both are too small.
  const std::string both = said(0.001, 0.002);
  EXPECT_GT(number(both, "a space.spacing of "), 0.004) << both;
  EXPECT_GT(number(both, "a thickness of "), 0.01) << both;
}

TEST(Containers, OneThatIsNoneIsToldWithItsPlace) {
  EXPECT_EQ(
      refused("{mold: {shape: {container: {sphere: {radius: 0.1}, wall: 0.02, cut: 0}, center: [0.2, 0.2, 0.2]}}}"),
      "walls.yaml:8:13: error: collider mold: its opening is closed: 0 m below its highest point the section of "
      "the hollow is 0 m^2, less than a thousandth of the floor of 0.058 m^2; give a larger `cut` (of 0.2 m "
      "in all), or another `up`");
  EXPECT_EQ(
      refused("{mold: {shape: {container: {sphere: {radius: 0.1}, wall: 0.02, cut: 0.3}, center: [0.2, 0.2, 0.2]}}}"),
      "walls.yaml:8:13: error: collider mold: a cut of 0.3 m leaves nothing of a hollow that is 0.2 m high: give "
      "less");
  EXPECT_EQ(refused("{mold: {shape: {container: {intersection: [{sphere: {radius: 0.1}, center: [0, 0, 0]}, {sphere: "
                    "{radius: 0.1}, center: [1, 0, 0]}], wall: 0.02}}}}"),
            "walls.yaml:8:13: error: collider mold: the hollow of a container encloses nothing");
}

TEST(Colliders, StandInAFrameAsTheRunSaysElseAsTheyMove) {
  model::Collider paddle;
  paddle.name = "paddle", paddle.shape = Shape::box({0, 0, 0}, {0.1, 0.1, 0.1});
  paddle.motion = model::Motion{};
  paddle.motion->velocity = {1, 0, 0};
  const SolidInTime solid(paddle, model::Space{}, Meshes(Meshes::Say::keep));
  FrameRecord frame;
  frame.time = 0.5;
  frame.poses["crate"] = Pose{{0, 2, 0}};
  EXPECT_EQ(solid.pose_in(frame), (Pose{{0.5, 0, 0}}));
  frame.poses["paddle"] = Pose{{0, 0, 3}};
  EXPECT_EQ(solid.pose_in(frame), (Pose{{0, 0, 3}}));
  EXPECT_EQ(solid.pose_at(frame.time), (Pose{{0.5, 0, 0}}));
  EXPECT_NEAR(solid.region_at(frame.time)->distance({0.05, 0.05, 0.02}), -0.02, 1e-9) << "before its pose";
}

TEST(Containers, MatterMayStartInTheHollow) {
  const std::string mold =
      "{mold: {shape: {container: {box: {size: [0.2, 0.2, 0.2]}, wall: 0.04}, center: [0.3, 0.15, 0.3]}}}";
  const std::string body = "{box: {min: [0.2, 0.075, 0.2], max: [0.4, 0.2, 0.4]}}";
  EXPECT_EQ(refused(mold, body), "");
  EXPECT_NE(refused(mold, "{box: {min: [0.2, 0.035, 0.2], max: [0.4, 0.2, 0.4]}}"), "") << "its bottom is solid";
}

TEST(Containers, ABodyMayBeOne) {
  const InitialState start =
      assembled("{}", "{container: {cylinder: {radius: 0.08, height: 0.2}, wall: 0.04}, center: [0.3, 0.3, 0.3]}");
  const double block = 0.24 * 0.24 * (0.19 + 0.04), hollow = std::numbers::pi * 0.0064 * 0.19;
  EXPECT_NEAR(static_cast<double>(start.particles()) * 1e-6 / (block - hollow), 1, 0.02);
}

}  // namespace
}  // namespace dreampm

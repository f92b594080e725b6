// The world made from a scene, before its first step.
#include "dreampm/setup/assemble.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "dreampm/base/error.h"
#include "dreampm/scene/parse.h"

namespace dreampm {
namespace {
using testing::HasSubstr;
using testing::ThrowsMessage;

/// The strength of the volume relaxation of a liquid whose sound is `ratio` times as fast as its
/// fall of 0.2 m, of a given 3.
double relaxation(double ratio, double gravity) {
  const double speed = std::sqrt(2 * 10 * 0.2);
  const std::string text = fmt::format(
      "dreampm: 1\nname: drop\nspace: {{min: [0, 0, 0], max: [0.2, 0.2, 0.2], spacing: 0.02, walls: {{all: {{type: "
      "slip}}}}}}\n"
      "time: {{fps: 10, frames: 1}}\ngravity: [0, {}, 0]\n"
      "materials: {{water: {{type: newtonian, density: 1000, bulk_modulus: {:.17g}, relaxation: 3}}}}\n"
      "bodies: {{drop: {{material: water, shape: {{box: {{min: [0, 0, 0], max: [0.2, 0.2, 0.2]}}}},\n"
      "  sample: {{pattern: lattice}}}}}}\n",
      -gravity, 1000 * ratio * ratio * speed * speed);
  const auto parsed = scene::parse_scene_text(text, "drop.yaml");
  EXPECT_TRUE(parsed.ok()) << parsed.text();
  return assemble(parsed.scene, "drop.yaml").world.sets[0].values["relaxation"];
}

/// Its pace is that of its sound up to 20 times the fall, and stays there. The highest particle is
/// half a spacing below the top, so that its fall is that much slower.
TEST(Assemble, LiquidsAreRelaxedAtThePaceOfTheirFlow) {
  const double slower = std::sqrt(0.19 / 0.2);
  EXPECT_EQ(relaxation(10, 10), 3);
  EXPECT_EQ(relaxation(19, 10), 3);
  EXPECT_NEAR(relaxation(40, 10), 3 * 20 * slower / 40, 1e-6);
  EXPECT_NEAR(relaxation(4000, 10), 3 * 20 * slower / 4000, 1e-8);
  EXPECT_EQ(relaxation(4000, 0), 3) << "nothing is known of its speed";
}

InitialState made(const std::string& text) {
  const auto parsed =
      scene::parse_scene_text("dreampm: 1\nname: post\ntime: {fps: 10, frames: 1}\n" + text, "post.yaml");
  EXPECT_TRUE(parsed.ok()) << parsed.text();
  return assemble(parsed.scene, "post.yaml");
}

// Liquids feel no friction. It is said where the scene sets one and has nothing that does; a rigid
// body's own is for its contacts with other solids.
TEST(Assemble, FrictionThatNothingFeelsIsNoted) {
  const auto noted = [](const std::string& material, const std::string& walls, const std::string& more = "") {
    const InitialState all =
        made("space: {min: [0, 0, 0], max: [0.2, 0.2, 0.2], spacing: 0.02" + walls +
             "}\nmaterials: {matter: {type: " + material +
             "}}\nbodies: {pool: {material: matter, shape: {box: {min: [0, 0, 0], max: [0.2, 0.1, 0.2]}}}}\n" + more);
    EXPECT_TRUE(all.warnings.empty()) << all.warnings[0];
    std::string note;
    for (const std::string& n : all.notes)
      if (n.find("friction of") != n.npos) note += n;
    return note;
  };
  const std::string floor = ", walls: {floor: {friction: 0.3}}",
                    cork =
                        "rigid: {cork: {shape: {sphere: {radius: 0.03}}, density: 240, position: [0.1, 0.15, 0.1]}}\n",
                    post =
                        "colliders: {post: {shape: {box: {min: [0.08, 0.12, 0.08], max: [0.12, 0.2, 0.12]}}, friction: "
                        "0.2}}\n";
  EXPECT_THAT(noted("newtonian", floor), HasSubstr("the friction of wall y_min is for solids and grains"));
  EXPECT_THAT(noted("newtonian", "", post), HasSubstr("post.yaml:7:"));
  EXPECT_EQ(noted("elastic", floor), "");
  EXPECT_EQ(noted("newtonian", "", cork), "") << "nobody set it";
  EXPECT_EQ(noted("newtonian", floor, cork), "") << "the body feels it";
}

// APIC takes a share of the motion of a small cork in each step.
TEST(Assemble, ALightBodyThatIsHeldBackIsNoted) {
  const auto noted = [](const std::string& transfer, double radius, double density) {
    const InitialState all =
        made(fmt::format("space: {{min: [0, 0, 0], max: [0.8, 0.8, 0.8], spacing: 0.02}}\nmaterials: {{water: {{type: "
                         "newtonian, preset: water, transfer: {}}}}}\nbodies: {{pool: {{material: water, shape: {{box: "
                         "{{min: [0, 0, 0], max: [0.8, 0.02, 0.8]}}}}}}}}\nrigid: {{cork: {{shape: {{sphere: {{radius: "
                         "{}}}}}, density: {}, position: [0.4, 0.4, 0.4]}}}}\n",
                         transfer, radius, density));
    std::string note;
    for (const std::string& n : all.notes)
      if (n.find("rises too slowly") != n.npos) note += n;
    return note;
  };
  EXPECT_THAT(noted("apic", 0.1, 240),
              HasSubstr("rigid body cork is lighter than water and 5.0 cells across: it rises too slowly by transfer: "
                        "apic; asflip lets it rise"));
  EXPECT_EQ(noted("asflip", 0.1, 240), "");
  EXPECT_EQ(noted("apic", 0.1, 1200), "") << "it sinks";
  EXPECT_EQ(noted("apic", 0.33, 240), "") << "16 cells are enough";
}

// Beyond an open side matter is taken out: what lies there at the start would vanish without a
// word.
TEST(Assemble, ABodyBeyondAnOpenSideIsRefusedOrToldOf) {
  const auto with = [](double from, double to, const std::string& ceiling = "open") {
    return made(
        fmt::format("space: {{min: [0, 0, 0], max: [0.2, 0.2, 0.2], spacing: 0.02, walls: {{ceiling: {{type: {}}}}}}}\n"
                    "materials: {{matter: {{type: newtonian}}}}\n"
                    "bodies: {{w: {{material: matter, shape: {{box: {{min: [0, {}, 0], max: [0.2, {}, 0.2]}}}}}}}}\n",
                    ceiling, from, to));
  };
  EXPECT_THAT([&] { with(0.3, 0.4); },
              ThrowsMessage<InputError>(HasSubstr("body w lies wholly beyond the open side y_max, where")));
  const InitialState part = with(0.1, 0.26);
  ASSERT_EQ(part.warnings.size(), 1u);
  EXPECT_THAT(part.warnings[0], HasSubstr("0.0024 of 0.0064 m^3 of body w lie beyond the open side y_max"));
  EXPECT_TRUE(with(0.1, 0.2).warnings.empty());
}

// The box is rounded up to whole cells: a body that is drawn to the size that was asked for leaves
// a gap, which is said, with both places.
TEST(Assemble, ABodyThatEndsBeforeAWallThatWasRoundedUpIsNoted) {
  const auto notes = [](double end, const std::string& more = "") {
    std::string all;
    for (const std::string& n :
         made(fmt::format(
                  "space: {{min: [0, 0, 0], max: [0.3, 0.2, 0.2], spacing: 0.02{}}}\n"
                  "materials: {{matter: {{type: newtonian}}}}\n"
                  "bodies: {{w: {{material: matter, shape: {{box: {{min: [0, 0, 0], max: [{}, 0.1, 0.2]}}}}}}}}\n",
                  more, end))
             .notes)
      if (n.find("short of") != n.npos) all += n;
    return all;
  };
  EXPECT_EQ(
      notes(0.3),
      "body w ends 0.02 m short of the wall x_max: space.max asks for 0.3 along x, and the wall stands at 0.32, at "
      "whole cells of 0.04 m");
  EXPECT_EQ(notes(0.28), "") << "it was not drawn to the wall";
  EXPECT_EQ(notes(0.32), "");
  EXPECT_EQ(notes(0.3, ", periodic: [x]"), "");
}

}  // namespace
}  // namespace dreampm

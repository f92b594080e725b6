// What a scene becomes before its first step.
#include "dreampm/simulation/assemble.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "dreampm/scene/parse.h"

namespace dreampm {
namespace {

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

TEST(Assemble, FrictionForLiquidsIsNoted) {
  const auto noted = [](const std::string& material) {
    const auto parsed = scene::parse_scene_text(
        "dreampm: 1\nname: post\n"
        "space: {min: [0, 0, 0], max: [0.2, 0.2, 0.2], spacing: 0.02, walls: {floor: {friction: 0.3}}}\n"
        "time: {fps: 10, frames: 1}\nmaterials: {matter: {type: " +
            material +
            "}}\n"
            "bodies: {pool: {material: matter, shape: {box: {min: [0, 0, 0], max: [0.2, 0.1, 0.2]}}}}\n",
        "post.yaml");
    EXPECT_TRUE(parsed.ok()) << parsed.text();
    const InitialState all = assemble(parsed.scene, "post.yaml");
    EXPECT_TRUE(all.warnings.empty()) << all.warnings[0];
    return std::any_of(all.notes.begin(), all.notes.end(),
                       [](const std::string& note) { return note.find("friction of walls") != note.npos; });
  };
  EXPECT_TRUE(noted("newtonian"));
  EXPECT_FALSE(noted("elastic"));
}

}  // namespace
}  // namespace dreampm

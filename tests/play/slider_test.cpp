// Elastic matter comes back from the ends of its sliders, but from the soft end of its stiffness;
// and where an end would stop time, the slider holds.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "dreampm/math/mat3.h"
#include "dreampm/play/live_range.h"
#include "dreampm/play/matter.h"
#include "hand.h"
#include "small_stage.h"

namespace dreampm::play {
namespace {
using namespace test;

std::string scene_of(std::string_view name) {
  const auto matter = std::find_if(matters().begin(), matters().end(), [&](const Matter& m) { return m.name == name; });
  return std::string(matter->scene);
}

/// A block of 216 particles of that matter under a stone half as high.
Stage loaded_stage(const std::string& matter) {
  return {
      "load",
      parse_scene(fmt::format("dreampm: 1\nname: load\nspace: {{min: [0, 0, 0], max: [0.24, 0.4, 0.24], spacing: "
                              "0.02}}\ntime: {{fps: 60}}\nmaterials:\n  soft: {}\n  load: {}\nbodies:\n  block: "
                              "{{material: soft, shape: {{box: {{min: [0.06, 0, 0.06], max: [0.18, 0.12, 0.18]}}}}}}"
                              "\n  top: {{material: load, shape: {{box: {{min: [0.06, 0.14, 0.06], max: [0.18, "
                              "0.2, 0.18]}}}}}}\n",
                              matter, scene_of("stone")),
                  "load.yaml")};
}

struct Shape {
  double volume;  ///< m^3, of the sum of J
  double extent;  ///< m^3: the root of the determinant of the second moments of all places
  double least;   ///< J
};
Shape shape_of(const Playground& p) {
  const ParticleView all = p.simulation().particles("soft");
  const auto n = static_cast<double>(all.size());
  Shape shape{0, 0, 1e30};
  Vec3d middle{};
  for (std::size_t i = 0; i < all.size(); ++i) {
    middle = middle + static_cast<Vec3d>(all.position[i]) * (1 / n);
    shape.volume += static_cast<double>(all.J[i]) * 8e-6;
    shape.least = std::min(shape.least, static_cast<double>(all.J[i]));
  }
  Mat3d moments{};
  for (const Vec3f& x : all.position) {
    const Vec3d d = static_cast<Vec3d>(x) - middle;
    moments = moments + outer(d, d) * (1 / n);
  }
  shape.extent = std::sqrt(determinant(moments));
  return shape;
}

/// A second at one end of a slider, and back; then two seconds more.
void to_an_end_and_back(const std::string& matter, const std::string& key, bool high) {
  SCOPED_TRACE(fmt::format("{}, {} at its {} end", matter, key, high ? "upper" : "lower"));
  Playground p(loaded_stage(matter), quiet_options());
  play(p, {"frames 30"});
  const std::string id = "material.soft." + key;
  const std::shared_ptr<const Frame> frame = p.frame();
  const auto control =
      std::find_if(frame->controls->begin(), frame->controls->end(), [&](const ControlInfo& c) { return c.id == id; });
  ASSERT_NE(control, frame->controls->end());
  const double end = high ? control->max : control->min;
  const Shape before = shape_of(p);
  play(p,
       {fmt::format("set {} {}", id, end), "frames 60", fmt::format("set {} {}", id, control->fallback), "frames 120"});
  const Shape after = shape_of(p);
  EXPECT_NEAR(after.volume / before.volume, 1, 0.05);
  EXPECT_NEAR(after.extent / before.extent, 1, 0.05);
  EXPECT_GT(after.least, 0.3) << "nothing is inverted or crushed for good";
}

class ElasticSliders : public testing::TestWithParam<const char*> {};

TEST_P(ElasticSliders, HeavyMatterUnderALoadComesBack) { to_an_end_and_back(scene_of(GetParam()), "density", true); }
TEST_P(ElasticSliders, IncompressibleMatterUnderALoadComesBack) {
  to_an_end_and_back(scene_of(GetParam()), "poissons_ratio", true);
}
TEST_P(ElasticSliders, CompressibleMatterUnderALoadComesBack) {
  to_an_end_and_back(scene_of(GetParam()), "poissons_ratio", false);
}
INSTANTIATE_TEST_SUITE_P(Of, ElasticSliders, testing::Values("jelly", "rubber", "stone"),
                         [](const auto& of) { return std::string(of.param); });

/// Of the small tank where a step takes so long, at that pace of the clock.
LiveRange live_range(Playground& p, const std::string& id, double step_seconds, double asked = 1) {
  const std::shared_ptr<const Frame> frame = p.frame();
  const std::vector<LiveRange> all = live_ranges(p.simulation(), *frame->controls, frame->values, step_seconds, asked);
  for (std::size_t i = 0; i < all.size(); ++i)
    if ((*frame->controls)[i].id == id) return all[i];
  throw std::out_of_range(id);
}

const std::string modulus = "material.jelly.youngs_modulus", density = "material.jelly.density";

TEST(Sliders, AreSaidOfParametersThatThereAre) { EXPECT_THAT(mistyped_parameters(), testing::IsEmpty()); }

TEST(LiveRange, EndsWhereTimeWouldRunAtAQuarterOfItsPace) {
  Playground p(small_stage(), quiet_options());
  play(p, {"frames 2"});
  const double cost = 1e-3;
  const double held = live_range(p, modulus, cost).max, light = live_range(p, density, cost).min;
  EXPECT_LT(held, 1e7);
  EXPECT_GT(held, 1e4);
  EXPECT_EQ(live_range(p, modulus, cost).min, 10) << "soft matter stops nothing";
  EXPECT_GT(light, 1.02);
  EXPECT_LT(light, 1020);
  EXPECT_EQ(live_range(p, "material.water.viscosity", cost).min, 1e-4);
  EXPECT_EQ(live_range(p, "gravity.y", cost).min, -10);
  // Steps there last about a quarter of what they take. The other matter alone does not limit them.
  play(p, {fmt::format("set {} {}", modulus, held), "frames 30"});
  EXPECT_NEAR(p.simulation().dt() / cost, least_pace, 0.25 * least_pace);
  // Slow motion has room for more, and a slower machine for less.
  EXPECT_GT(live_range(p, modulus, cost, 0.5).max, 2 * held);
  EXPECT_LT(live_range(p, modulus, 1.2 * cost).max, 1.001 * held);
  // What is set, and what another matter costs anyway, is never cut off.
  EXPECT_NEAR(live_range(p, modulus, 10 * cost).max, held, 1e-3 * held);
  EXPECT_EQ(live_range(p, modulus, 0).max, 1e7) << "nothing is known yet";
}

class HeldSlider : public Hand {
 protected:
  void SetUp() override {
    Hand::SetUp();
    PlayOptions slow = quiet_options();
    slow.step_seconds = 1e-3;
    playground.emplace(small_stage(), slow);
    play(*playground, {"frames 2"});
    start();
  }
  /// From the middle of the slider to its right end; the last value that was set.
  double drag() {
    point_at(modulus, 0.25);
    posted.clear();
    input.left = true;
    draw(2);
    point_at(modulus, 0.98);
    input.left = false;
    draw(2);
    EXPECT_FALSE(posted.empty());
    return Action::parse(posted.back()).number(1);
  }
};

TEST_F(HeldSlider, HoldsWhereItIsAsStiffAsIsLiveUnlessShiftIsHeld) {
  const double held = live_range(*playground, modulus, 1e-3).max;
  EXPECT_NEAR(drag(), held, 1e-9 * held);
  draw(60);  // later than the second click of a double one
  input.shift = true;
  EXPECT_GT(drag(), 1.5 * held);
  input.shift = false;
}

TEST_F(HeldSlider, IsRedWhereItHolds) {
  rest();
  const RgbImage image = picture();
  const Place at = place(modulus);
  const int y = static_cast<int>(at.top) + 3;
  int red = 0;
  for (int x = static_cast<int>(at.left); x < static_cast<int>(at.right); ++x) {
    const std::uint8_t* pixel = image.at(x, y);
    red += pixel[0] > pixel[1] + 40 && pixel[0] > pixel[2] + 40;
  }
  EXPECT_GT(red, 10);
}

}  // namespace
}  // namespace dreampm::play

// Elastic matter comes back from the ends of its sliders, which hold where it would not, and where
// time would stop.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "dreampm/math/mat3.h"
#include "dreampm/play/model/firmness.h"
#include "dreampm/play/model/live_range.h"
#include "dreampm/play/model/matter.h"
#include "play/app_fixture.h"
#include "play/small_scene.h"

namespace dreampm::play::slider_test {
namespace {
using namespace test;

std::string scene_of(std::string_view name) {
  if (name == "report") return "{type: seed, density: 1000, youngs_modulus: 1.0e5, elastic: true, h: 1}";
  const auto matter = std::find_if(matters().begin(), matters().end(), [&](const Matter& m) { return m.name == name; });
  return std::string(matter->scene);
}

/// A block of 216 particles of that matter under a stone half as high.
PlayScene loaded_scene(const std::string& matter) {
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

/// A ball of that matter, that high over the floor.
PlayScene falling_scene(const std::string& matter, double height) {
  return {"fall",
          parse_scene(fmt::format("dreampm: 1\nname: fall\nspace: {{min: [0, 0, 0], max: [0.4, 1.2, 0.4], spacing: "
                                  "0.02}}\ntime: {{fps: 60}}\nmaterials:\n  soft: {}\nbodies:\n  ball: {{material: "
                                  "soft, shape: {{sphere: {{radius: 0.07}}, center: [0.2, {}, 0.2]}}}}\n",
                                  matter, height + 0.07),
                      "fall.yaml")};
}

/// Steps of 0.05 ms are the shortest that are live on such a machine.
PlayOptions steady_options() {
  PlayOptions o = quiet_options();
  o.step_seconds = 2e-4;
  return o;
}

std::size_t index_of(const Frame& frame, const std::string& id) {
  for (std::size_t i = 0; i < frame.controls->size(); ++i)
    if ((*frame.controls)[i].id == id) return i;
  throw std::out_of_range(id);
}

/// A second at one end of a slider, as far as it goes without Shift, and back; then two seconds
/// more.
void to_an_end_and_back(Playground& p, const std::string& key, bool high) {
  const std::string id = "material.soft." + key;
  const std::shared_ptr<const Frame> frame = p.frame();
  const std::size_t i = index_of(*frame, id);
  const double end = high ? frame->live[i].max : frame->live[i].min;
  SCOPED_TRACE(fmt::format("{}, its {} end at {}", key, high ? "upper" : "lower", end));
  const Shape before = shape_of(p);
  play(p, {fmt::format("set {} {}", id, end), "frames 60", fmt::format("set {} {}", id, (*frame->controls)[i].fallback),
           "frames 120"});
  EXPECT_EQ(p.frame()->message, "");
  const Shape after = shape_of(p);
  EXPECT_NEAR(after.volume / before.volume, 1, 0.05);
  EXPECT_NEAR(after.extent / before.extent, 1, 0.05);
  EXPECT_GT(after.least, 0.3) << "nothing is inverted or crushed for good";
}

class ElasticSliders : public testing::TestWithParam<const char*> {
 protected:
  void under_a_load(const std::string& key) {
    for (const bool high : {false, true}) {
      Playground p(loaded_scene(scene_of(GetParam())), steady_options());
      play(p, {"frames 30"});
      to_an_end_and_back(p, key, high);
    }
  }
};

TEST_P(ElasticSliders, SoftAndStiffMatterUnderALoadComesBack) { under_a_load("youngs_modulus"); }
TEST_P(ElasticSliders, LightAndHeavyMatterUnderALoadComesBack) { under_a_load("density"); }
TEST_P(ElasticSliders, MatterUnderALoadComesBackWhateverItsPoissonsRatio) { under_a_load("poissons_ratio"); }
TEST_P(ElasticSliders, MatterThatIsMadeSoftAsItFallsComesBack) {
  Playground p(falling_scene(scene_of(GetParam()), 0.5), steady_options());
  play(p, {"frames 10"});
  to_an_end_and_back(p, "youngs_modulus", false);
}
INSTANTIATE_TEST_SUITE_P(Of, ElasticSliders, testing::Values("jelly", "rubber", "stone", "report"),
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

TEST(LiveRange, EndsWhereTimeWouldRunAtAQuarterOfItsPace) {
  Playground p(small_scene(), quiet_options());
  play(p, {"frames 2"});
  const double cost = 1e-3;
  const double held = live_range(p, modulus, cost).max, light = live_range(p, density, cost).min;
  EXPECT_LT(held, 1e7);
  EXPECT_GT(held, 1e4);
  EXPECT_TRUE(live_range(p, modulus, cost).min_is_soft) << "soft matter stops nothing";
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

// It is not of the machine: it is there where no time of a step is known, and for scripts.
TEST(LiveRange, EndsWhereSoftMatterWouldBeCrushed) {
  Playground p(loaded_scene(scene_of("jelly")), quiet_options());
  play(p, {"frames 30"});
  const std::string id = "material.soft.youngs_modulus";
  const LiveRange rest = live_range(p, id, 0);
  EXPECT_TRUE(rest.min_is_soft);
  // 270 kg/m^2 lie on its foot; nu is 0.45.
  EXPECT_NEAR(rest.min * 3.79, least_firmness * 9.81 * 270, 0.25 * least_firmness * 9.81 * 270);
  EXPECT_FALSE(rest.max_is_soft);
  EXPECT_FALSE(live_range(p, "gravity.x", 0).max_is_soft);
  play(p, {fmt::format("set {} {}", id, rest.min), "frames 1"});
  EXPECT_EQ(p.frame()->message, "");
  // At its end there is no room for more weight.
  EXPECT_LT(live_range(p, "gravity.x", 0).max, 1);
  EXPECT_TRUE(live_range(p, "gravity.x", 0).max_is_soft);
  EXPECT_NEAR(live_range(p, "gravity.y", 0).max, 9.9, 0.2);
  EXPECT_NEAR(live_range(p, "material.soft.density", 0).max, 1020, 10);
  EXPECT_EQ(live_range(p, "material.load.youngs_modulus", 0).max, 1e9);
  // What is typed goes on, and says what may come of it, once.
  play(p, {fmt::format("set {} {}", id, 0.5 * rest.min)});
  EXPECT_THAT(p.frame()->message, testing::StartsWith("soft is so soft"));
  const std::uint64_t said = p.frame()->message_number;
  play(p, {fmt::format("set {} {}", id, 0.4 * rest.min), "set gravity.y -9.9"});
  EXPECT_EQ(p.frame()->message_number, said);
  EXPECT_NEAR(live_range(p, id, 0).min, 0.4 * rest.min, 1e-6 * rest.min) << "what is set is never cut off";
}

class HeldSlider : public AppFixture {
 protected:
  void SetUp() override {
    AppFixture::SetUp();
    PlayOptions slow = quiet_options();
    slow.step_seconds = 1e-3;
    playground.emplace(small_scene(), slow);
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

// Where it stands at its limit, its knob is as well to be seen as anywhere.
TEST_F(HeldSlider, TheKnobIsBesideTheRed) {
  rest();
  const auto blue = [&] {
    const RgbImage image = picture();
    const Place at = place(modulus);
    const int y = static_cast<int>(0.5 * (at.top + at.bottom));
    int count = 0;
    for (int x = static_cast<int>(at.left); x < static_cast<int>(at.right); ++x)
      count += image.at(x, y)[2] > image.at(x, y)[0] + 100;
    return count;
  };
  const int free = blue();
  ASSERT_GT(free, 6);
  play(*playground, {fmt::format("set {} {}", modulus, live_range(*playground, modulus, 1e-3).max), "frames 20"});
  draw(2);
  EXPECT_NEAR(blue(), free, 1);
}

// A logarithmic scale begins at its least value, however small.
TEST_F(HeldSlider, TheScaleIsLogarithmicFromEndToEnd) {
  const std::string viscosity = "material.water.viscosity";
  const ControlInfo& c = (*playground->frame()->controls)[index_of(*playground->frame(), viscosity)];
  ASSERT_LT(c.min, 2e-4);
  for (const double share : {0.1, 0.25, 0.5}) {
    rest();
    posted.clear();
    point_at(viscosity, share);
    input.left = true;
    draw(2);
    rest();
    input.left = false;
    draw(2);
    ASSERT_FALSE(posted.empty());
    const double set = Action::parse(posted.back()).number(1);
    EXPECT_NEAR(std::log(set / c.min) / std::log(c.max / c.min), share, 0.04);
  }
}

}  // namespace
}  // namespace dreampm::play::slider_test

// The elastic matter of the stories is firm enough for the falls that it takes in them, and sand
// runs through its neck at each size.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>

#include "dreampm/model/scene.h"
#include "dreampm/play/model/firmness.h"
#include "dreampm/play/model/live_range.h"
#include "dreampm/play/model/stories.h"
#include "play/small_scene.h"

namespace dreampm::play::firm_stories_test {
namespace {
using namespace test;

class FirmStory : public testing::TestWithParam<const char*> {};

// All its falls are ahead at the start, as heights or as speed.
TEST_P(FirmStory, HasRoomForSofterMatterWhileItFalls) {
  Playground p(load_play_scene(GetParam()), quiet_options(2));
  for (int look = 0; look < 3; ++look) {
    p.tick({20, {}});
    const std::shared_ptr<const Frame> frame = p.frame();
    EXPECT_EQ(too_soft(p.simulation(), *frame->controls, frame->values), "");
    // On a machine of any pace.
    for (const double step_seconds : {0.0, 1e-3, 0.05}) {
      const std::vector<LiveRange> live = live_ranges(p.simulation(), *frame->controls, frame->values, step_seconds, 1);
      for (std::size_t i = 0; i < live.size(); ++i) {
        const ControlInfo& c = (*frame->controls)[i];
        SCOPED_TRACE(c.id);
        EXPECT_LE(live[i].min, frame->values[i]);
        EXPECT_GE(live[i].max, frame->values[i]);
        if (c.id.ends_with("youngs_modulus")) {
          EXPECT_LT(live[i].min, 0.97 * frame->values[i]);
        }
        if (c.id == "gravity.x") {
          EXPECT_GT(live[i].max, 1);
        }
      }
    }
  }
}

// At half of these moduli a seventh of a jelly's volume is lost, and particles of it are pressed
// flat for good.
TEST_P(FirmStory, HasItsVolumeAfterTheFalls) {
  Playground p(load_play_scene(GetParam()), quiet_options(2));
  play(p, {"size small", "frames 100"});
  for (const model::Material& m : p.simulation().scene().model().materials) {
    if (!is_elastic(m)) continue;
    const ParticleView all = p.simulation().particles(m.name);
    double sum = 0;
    for (const float J : all.J) sum += static_cast<double>(J) / static_cast<double>(all.size());
    EXPECT_NEAR(sum, 1, 0.05) << m.name;
  }
}
INSTANTIATE_TEST_SUITE_P(Of, FirmStory, testing::Values("jelly-stair", "dragon-rain"), [](const auto& of) {
  return std::string(of.param).starts_with("jelly") ? "JellyStair" : "DragonRain";
});

// A neck with a radius of 1.7 cells holds sand up.
TEST(Hourglass, RunsWithFewParticles) {
  Playground p(load_play_scene("hourglass"), quiet_options(2));
  play(p, {"size small", "frames 90"});
  const ParticleView sand = p.simulation().particles("sand");
  std::size_t below = 0;
  for (const Vec3f& x : sand.position) below += x.y < 0.45f;
  EXPECT_GT(static_cast<double>(below), 0.05 * static_cast<double>(sand.size()));
}

}  // namespace
}  // namespace dreampm::play::firm_stories_test

// Liquids under force fields: their sound is fast beside what the fields give, so that they keep
// their volume.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "dreampm/base/error.h"
#include "dreampm/io/ledger.h"
#include "dreampm/pipeline/simulate.h"
#include "dreampm/scene/parse.h"
#include "dreampm/setup/assemble.h"

namespace dreampm {
namespace {
namespace fs = std::filesystem;

model::Scene scene_of(const std::string& rest) {
  const auto parsed = scene::parse_scene_text("dreampm: 1\nname: blown\n" + rest, "blown.yaml");
  if (!parsed.ok()) throw InputError(parsed.text());
  return parsed.scene;
}

/// Water in the far half of a channel, blown onto its end.
std::string channel(const std::string& fields, const std::string& space = "",
                    const std::string& gravity = "[0, 0, 0]") {
  return fmt::format(
      "space: {{min: [0, 0, 0], max: [0.32, 0.16, 0.16], spacing: 0.01{}}}\n"
      "time: {{fps: 500, frames: 75}}\ngravity: {}\n"
      "materials: {{water: {{type: newtonian, density: 1000, max_compression: 0.01}}}}\n"
      "bodies: {{slug: {{material: water, shape: {{box: {{min: [0.16, 0, 0], max: [0.32, 0.16, 0.16]}}}},\n"
      "  sample: {{pattern: lattice}}}}}}\n{}",
      space, gravity, fields);
}

struct Sound {
  double speed = 0;  ///< the expected [m/s]
  std::string notes;
};
Sound sound_of(const std::string& text) {
  const InitialState all = assemble(scene_of(text), "blown.yaml");
  return {std::sqrt(0.01 * all.world.sets[0].values["bulk_modulus"] / 1000),
          fmt::format("{}", fmt::join(all.notes, "\n"))};
}

TEST(LiquidsUnderFields, AreExpectedAsFastAsFallAndFieldsMakeThem) {
  const std::string gust = "fields: {gust: {type: wind, velocity: [10, 0, 0], coefficient: 2}}\n";
  // From the first particles, half a spacing inside the slug, to the end of the channel.
  const double way = 2 * 100 * (0.16 - 0.005), fall = 9.81 * (0.16 - 0.005);
  EXPECT_NEAR(sound_of(channel(gust)).speed, std::sqrt(2 * way), 1e-6);
  const Sound both = sound_of(channel(gust, "", "[0, -9.81, 0]"));
  EXPECT_NEAR(both.speed, std::sqrt(2 * (way + fall)), 1e-6);
  EXPECT_NE(both.notes.find("from the largest expected speed 8.06 m/s: fall 1.74 m/s, field gust 7.87 m/s"),
            std::string::npos)
      << both.notes;
  // Into a box that reaches beyond the channel's end it may come from any side; beside the channel
  // it is nothing.
  const auto boxed = [](const char* box) {
    return fmt::format("fields: {{gust: {{type: wind, velocity: [10, 0, 0], coefficient: 2, box: {}}}}}\n", box);
  };
  EXPECT_NEAR(sound_of(channel(boxed("{min: [0.1, 0, 0], max: [9, 1, 1]}"))).speed, std::sqrt(2 * 200 * 0.22), 1e-6);
  EXPECT_NEAR(sound_of(channel(boxed("{min: [0.4, 0, 0], max: [9, 1, 1]}"))).speed, 0.1, 1e-9) << "the least";
  // Round and round it comes to the speed of the wind.
  EXPECT_NEAR(sound_of(channel(gust, ", periodic: [x]")).speed, std::sqrt(2 * (200 * 0.32 + 50)), 1e-6);
  // A field that gives nothing is not reported.
  const Sound still = sound_of(channel("fields: {air: {type: drag, rate: 5}}\n", "", "[0, -9.81, 0]"));
  EXPECT_EQ(still.notes, sound_of(channel("", "", "[0, -9.81, 0]")).notes);
}

/// The lowest J of a run, over all frames and in the last one.
struct Squeezed {
  double most = 0, last = 0;  ///< 1 - J
};
Squeezed run(const std::string& text) {
  SimulateOptions options;
  options.folder = fs::path(DM_BINARY_DIR) / "test-files" /
                   (std::string("fields.") + testing::UnitTest::GetInstance()->current_test_info()->name());
  fs::remove_all(options.folder);
  options.strict = true;  // what the field gives is reported rightly, too
  simulate(scene_of(text), {"blown.yaml", std::nullopt}, options);
  Squeezed s;
  for (const LedgerRow& row : read_ledger(options.folder / "ledger.csv").rows)
    s.last = 1 - row.j_min, s.most = std::max(s.most, s.last);
  std::printf("squeezed by %.4f, in the end by %.4f\n", s.most, s.last);
  return s;
}

// Held by a field, a liquid presses with density * head at most, which squeezes it by
// max_compression / 2: K = density v_ref^2 / max_compression, v_ref^2 = 2 head. Put in a field at
// once, it swings to twice that and back. `noise`: what single particles are off by, a third of
// that.
constexpr double max_compression = 0.01, noise = max_compression / 6;

TEST(LiquidsUnderFields, WaterBlownOntoAWallKeepsItsVolume) {
  const Squeezed s = run(channel("fields: {gust: {type: wind, velocity: [10, 0, 0], coefficient: 2}}\n"));
  EXPECT_LT(s.most, max_compression + noise);
  EXPECT_NEAR(s.last, max_compression / 2, noise);
}

TEST(LiquidsUnderFields, WaterAroundAnAttractorKeepsItsVolume) {
  const std::string moon = R"(space: {min: [0, 0, 0], max: [0.4, 0.4, 0.4], spacing: 0.0125}
time: {fps: 500, frames: 75}
gravity: [0, 0, 0]
materials: {water: {type: newtonian, density: 1000, max_compression: 0.01}}
bodies: {moon: {material: water, shape: {sphere: {radius: 0.1}, center: [0.2, 0.2, 0.2]}, sample: {pattern: lattice}}}
fields: {core: {type: attractor, point: [0.2, 0.2, 0.2], strength: 0.5, radius: 0.05}}
)";
  // The head reaches to the corners of the matter's box; the ball ends before.
  const double head = 0.5 * (1 / 0.05 - 1 / std::hypot(0.1, 0.05)), v = sound_of(moon).speed;
  EXPECT_LT(2 * head, v * v);
  const Squeezed s = run(moon);
  EXPECT_LT(s.most, max_compression + noise);
  EXPECT_NEAR(s.last, max_compression * head / (v * v), noise);
}

}  // namespace
}  // namespace dreampm

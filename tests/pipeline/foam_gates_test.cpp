// Where foam and dust of whole runs are born.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "dreampm/base/host.h"
#include "dreampm/pipeline/foam_stage.h"
#include "dreampm/pipeline/simulate.h"
#include "dreampm/scene/parse.h"

namespace dreampm {
namespace {
namespace fs = std::filesystem;

/// What a frame has, and which of its grains were born since the frame before.
struct FoamingFrame {
  ParticleFrame matter;
  std::vector<Vec3f> born;
};

/// The frames of a scene with its foam.
std::vector<FoamingFrame> frames_of(const std::string& text) {
  const fs::path folder = fs::path(DM_BINARY_DIR) / "test-files" / "foam-gates" /
                          testing::UnitTest::GetInstance()->current_test_info()->name();
  fs::remove_all(folder);
  const scene::ParseResult parsed = scene::parse_scene_text(text, "scene.yaml", {});
  EXPECT_TRUE(parsed.ok()) << parsed.text();
  SilentHost silent;
  const HostScope scope(&silent);
  SimulateOptions options;
  options.folder = folder;
  simulate(parsed.scene, {"scene.yaml", std::nullopt}, options);
  RunFolder run = open_run(folder, Access::write);
  foam_stage(run, {});
  std::vector<FoamingFrame> all;
  std::uint32_t next = 0;
  for (const int f : run.frames()) {
    FoamingFrame frame{read_particles(run.particles(f)), {}};
    const FoamParticles foam = read_foam(foam_file(run, f)).particles;
    for (std::size_t i = 0; i < foam.size(); ++i)
      if (static_cast<std::uint32_t>(foam.id[i]) >= next) frame.born.push_back(foam.position[i]);
    next = foam.next_id;
    all.push_back(std::move(frame));
  }
  return all;
}

std::size_t born_in(const std::vector<FoamingFrame>& frames, std::size_t first, std::size_t last) {
  std::size_t sum = 0;
  for (std::size_t f = first; f < std::min(last, frames.size()); ++f) sum += frames[f].born.size();
  return sum;
}

// ---- a dam that breaks

constexpr float dam_spacing = 0.0125f, far_wall = 0.8f;

/// A column 0.3 m long and 0.4 m high runs 0.5 m to the far wall, which it reaches after 0.25 s.
std::string dam(const std::string& foam) {
  return "dreampm: 1\nname: dam\nspace: {max: [0.8, 0.6, 0.1], spacing: 0.0125, walls: {ceiling: {type: open}}}\n"
         "time: {fps: 50, frames: 20, solver: projection}\nmaterials: {water: {type: newtonian}}\n"
         "bodies: {column: {material: water, shape: {box: {min: [0, 0, 0], max: [0.3, 0.4, 0.1]}}}}\nfoam: {" +
         foam + "}\n";
}

/// The surface: the highest water above places two spacings apart.
class Heights {
 public:
  explicit Heights(const ParticleFrame& water) {
    for (const Vec3f& p : water.position) {
      float& top = top_.try_emplace(cell(p), p.y).first->second;
      top = std::max(top, p.y);
    }
  }
  /// m; below 0 above the water.
  float depth(const Vec3f& p) const {
    const auto found = top_.find(cell(p));
    return found == top_.end() ? -1 : found->second - p.y;
  }

 private:
  static std::pair<int, int> cell(const Vec3f& p) {
    return {static_cast<int>(p.x / (2 * dam_spacing)), static_cast<int>(p.z / (2 * dam_spacing))};
  }
  std::map<std::pair<int, int>, float> top_;
};

struct Places {
  std::size_t all = 0, behind_front = 0, deep = 0;
};

/// Grains that were born before the far wall is hit: how many more than 0.1 m behind the tip of the
/// front, and how many of these more than 3 spacings below the surface.
Places of_front(const std::vector<FoamingFrame>& frames) {
  Places sum;
  for (const FoamingFrame& f : frames) {
    float tip = 0;
    for (const Vec3f& p : f.matter.position) tip = std::max(tip, p.x);
    if (tip > far_wall - 4 * dam_spacing) break;
    const Heights surface(f.matter);
    for (const Vec3f& p : f.born) {
      ++sum.all;
      if (p.x > tip - 0.1f) continue;
      ++sum.behind_front;
      sum.deep += surface.depth(p) > 3 * dam_spacing;
    }
  }
  return sum;
}

TEST(FoamGates, ADamBreakFoamsAtItsFrontAndThenAtTheWallThatItHits) {
  const std::vector<FoamingFrame> frames = frames_of(dam("amount: 1"));
  const Places run = of_front(frames);
  ASSERT_GT(run.all, 1000u);
  EXPECT_LT(run.behind_front, 0.01 * static_cast<double>(run.all));
  EXPECT_EQ(run.deep, 0u);
  EXPECT_EQ(born_in(frames, 0, 2), 0u) << "a column that begins to fall is whole";
  // A plunge of half the water's speed against a wall gives several times what the front gave.
  std::size_t at_wall = 0, hit = 0;
  for (std::size_t f = 14; f < frames.size(); ++f)
    for (const Vec3f& p : frames[f].born) ++hit, at_wall += p.x > far_wall - 0.15f;
  EXPECT_GT(hit, 3 * run.all);
  EXPECT_GT(static_cast<double>(at_wall), 0.98 * static_cast<double>(hit));
}

// The gate sees limits that let slow and smooth water foam.
TEST(FoamGates, ADamBreakWithoutLimitsFoamsAllOver) {
  const std::string all = "{from: 0, to: 0.01}";
  const Places run = of_front(frames_of(
      dam("amount: 0.1, speed: " + all + ", trapped_air: " + all + ", vorticity: " + all + ", crest: " + all)));
  ASSERT_GT(run.all, 1000u);
  EXPECT_GT(run.behind_front, 0.3 * static_cast<double>(run.all));
  EXPECT_GT(run.deep, 0u);
}

// ---- grains

TEST(FoamGates, ASmallHeapThatSettlesGivesNoDust) {
  const auto frames = frames_of(
      "dreampm: 1\nname: heap\nspace: {max: [0.4, 0.2, 0.4], spacing: 0.01, walls: {ceiling: {type: open}}}\n"
      "time: {fps: 50, frames: 20}\nmaterials: {sand: {type: sand}}\n"
      "bodies: {column: {material: sand, shape: {cylinder: {radius: 0.05, height: 0.1}, center: [0.2, 0.05, 0.2]}}}\n"
      "foam: {amount: 100}\n");
  EXPECT_EQ(born_in(frames, 0, frames.size()), 0u);
  float top = 0;
  for (const Vec3f& p : frames.back().matter.position) top = std::max(top, p.y);
  EXPECT_LT(top, 0.05f) << "it fell";
}

TEST(FoamGates, ABallThatFallsIntoSandRaisesDustWhereItHitsAndThenNoMore) {
  const auto frames = frames_of(
      "dreampm: 1\nname: ball\nspace: {max: [0.4, 0.4, 0.4], spacing: 0.0125, walls: {ceiling: {type: open}}}\n"
      "time: {fps: 50, frames: 16}\nmaterials: {sand: {type: sand}}\n"
      "bodies: {bed: {material: sand, shape: {box: {min: [0, 0, 0], max: [0.4, 0.1, 0.4]}}}}\n"
      "rigid: {ball: {shape: {sphere: {radius: 0.06}}, density: 2500, position: [0.2, 0.36, 0.2], velocity: [0, -4, "
      "0]}}\n"
      "foam: {amount: 10}\n");
  // It comes down by 0.2 m at 4 m/s: between the frames 3 and 4, at 0.04 and 0.06 s.
  EXPECT_EQ(born_in(frames, 0, 3), 0u);
  const std::size_t hit = born_in(frames, 3, 5);
  EXPECT_GT(hit, 100u);
  EXPECT_EQ(born_in(frames, 5, frames.size()), 0u);
  for (std::size_t f = 3; f < 5; ++f)
    for (const Vec3f& p : frames[f].born) {
      EXPECT_LT(std::hypot(p.x - 0.2f, p.z - 0.2f), 0.12f);
      EXPECT_GT(p.y, 0.05f);
    }
}

TEST(FoamGates, ASnowballRaisesDustAtTheWallAndNoneOnItsWay) {
  const auto frames = frames_of(
      "dreampm: 1\nname: snowball\nspace: {max: [0.8, 0.6, 0.5], spacing: 0.014, walls: {ceiling: {type: open}}}\n"
      "time: {fps: 50, frames: 12}\nmaterials: {snow: {type: snow, preset: packed}}\n"
      "bodies: {ball: {material: snow, shape: {sphere: {radius: 0.08}, center: [0.3, 0.4, 0.25]}, velocity: [5, 0, "
      "0]}}\n"
      "foam: {amount: 1}\n");
  // 0.42 m at 5 m/s: its front is at the wall after 0.084 s, between the frames 5 and 6.
  EXPECT_EQ(born_in(frames, 0, 5), 0u);
  std::size_t all = 0, at_wall = 0;
  for (std::size_t f = 5; f < 8; ++f)
    for (const Vec3f& p : frames[f].born) ++all, at_wall += p.x > far_wall - 0.1f;
  EXPECT_GT(all, 300u);
  EXPECT_GT(at_wall, all * 9 / 10);
  EXPECT_LT(born_in(frames, 8, frames.size()), all / 20);
}

}  // namespace
}  // namespace dreampm

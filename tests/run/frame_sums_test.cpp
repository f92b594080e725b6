// Sums over the steps of a frame, and the part of them that a checkpoint carries.
#include "dreampm/run/frame_sums.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "dreampm/backend/cpu/cpu.h"
#include "dreampm/run/scene_engine.h"
#include "dreampm/scene/parse.h"

namespace dreampm {
namespace {

model::Scene drop() {
  auto parsed = scene::parse_scene_text(
      "dreampm: 1\nname: drop\nspace: {max: [0.2, 0.2, 0.2], spacing: 0.02}\ntime: {fps: 50, frames: 9}\n"
      "materials: {water: {type: newtonian, preset: water}}\n"
      "bodies: {drop: {material: water, shape: {sphere: {radius: 0.06}, center: [0.1, 0.1, 0.1]}}}\n",
      "drop.yaml", {});
  if (!parsed.ok()) throw std::runtime_error(parsed.text());
  return std::move(parsed.scene);
}

TEST(FrameTotals, StayUntilTheNextStepAndAreCarriedWithinAFrameAlone) {
  SceneEngine<float> scene(drop(), "drop.yaml", make_cpu_backend());
  FrameTotals<float> totals(scene.engine());
  scene.engine().add(totals);
  scene.begin();
  const double mass = scene.engine().balance().mass;
  std::uint64_t steps = 0, particle_steps = 0;
  for (int frame = 1; frame <= 2; ++frame) {
    std::uint64_t own = 0;
    StepSums step;
    do {
      step = scene.engine().step();
      ++own, particle_steps += scene.engine().world().particles();
      EXPECT_EQ(totals.sums().substeps, own);
      EXPECT_EQ(totals.carried().substeps, step.frame_done ? 0 : own) << "nothing is left over at the end of a frame";
    } while (!step.frame_done);
    steps += own;
    // It falls freely: gravity gives m g T in a frame.
    EXPECT_NEAR(totals.sums().body.impulse.y, -9.81 * mass / 50, 1e-4 * mass);
  }
  EXPECT_GT(steps, 4u);
  EXPECT_EQ(totals.particle_steps(), particle_steps);
}

TEST(FrameTotals, GoOnFromWhatWasCarried) {
  SceneEngine<float> whole(drop(), "drop.yaml", make_cpu_backend()), cut(drop(), "drop.yaml", make_cpu_backend());
  FrameTotals<float> first(whole.engine()), before(cut.engine()), after(cut.engine());
  whole.engine().add(first), cut.engine().add(before);
  whole.begin(), cut.begin();
  for (int n = 0; n < 2; ++n) whole.engine().step(), cut.engine().step();
  after.go_on(before.carried(), before.particle_steps());
  cut.engine().add(after);
  for (int n = 0; n < 2; ++n) whole.engine().step(), cut.engine().step();
  EXPECT_EQ(after.sums().substeps, first.sums().substeps);
  EXPECT_EQ(after.sums().body.impulse.y, first.sums().body.impulse.y);
  EXPECT_EQ(after.sums().rounding, first.sums().rounding);
  EXPECT_EQ(after.particle_steps(), first.particle_steps());
}

}  // namespace
}  // namespace dreampm

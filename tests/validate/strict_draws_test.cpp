// Scenes by chance in strict runs: the ledger of a sound run closes, in float and in double.
#include <gtest/gtest.h>

#include <filesystem>

#include "dreampm/pipeline/simulate.h"
#include "dreampm/pipeline/strict.h"
#include "validate/random_scene.h"

namespace dreampm::validate {
namespace {
namespace fs = std::filesystem;

/// Returns the reason that stops the strict run of a draw; empty if there is none.
std::string stopped_by(int draw, const std::string& backend, int frames) {
  model::Scene scene = random_scene(1, draw).scene;
  scene.output.checkpoint_every = 0;
  SimulateOptions options;
  options.folder = fs::path(DM_BINARY_DIR) / "test-files" / ("strict-draw-" + backend + std::to_string(draw));
  fs::remove_all(options.folder);
  options.frames = std::min(frames, scene.time.frames);
  options.backend = backend;
  options.strict = true;
  try {
    simulate(scene, {"draw.yaml", std::nullopt}, options);
  } catch (const LedgerBreach& e) {
    return e.what();
  }
  return {};
}

// Blows of stiff matter (25, 33), snow that yields in every step (39), all of it gone (115).
TEST(StrictDraws, CloseInFloat) {
  for (const int draw : {25, 33, 39, 115}) EXPECT_EQ(stopped_by(draw, "cpu", 1000), "") << draw;
}

// Equal terms, many of them: sums of the ledger itself are rounded as much as what they measure.
TEST(StrictDraws, CloseInDouble) {
  for (const int draw : {0, 32, 39}) EXPECT_EQ(stopped_by(draw, "reference", 2), "") << draw;
}

}  // namespace
}  // namespace dreampm::validate

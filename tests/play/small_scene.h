// A small tank of water beside a block of jelly, for tests of the playground.
#pragma once
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

#include "dreampm/error.h"
#include "dreampm/play/model/playground.h"

namespace dreampm::play::test {

inline PlayScene small_scene() {
  return {"tank",
          parse_scene("dreampm: 1\nname: tank\nspace: {min: [0, 0, 0], max: [0.4, 0.4, 0.24], spacing: 0.02}\n"
                      "time: {fps: 60}\nmaterials:\n  water: {type: newtonian, preset: water, max_compression: "
                      "0.03}\n  jelly: {type: elastic, preset: jelly}\nbodies:\n  dam: {material: water, shape: "
                      "{box: {min: [0, 0, 0], max: [0.12, 0.16, 0.24]}}}\n  cube: {material: jelly, shape: "
                      "{box: {min: [0.24, 0.04, 0.08], max: [0.32, 0.12, 0.16]}}}\n",
                      "tank.yaml")};
}

/// Water alone in the same tank, by large steps.
inline PlayScene large_step_scene(const std::string& more = "") {
  return {"tank",
          parse_scene("dreampm: 1\nname: tank\nspace: {min: [0, 0, 0], max: [0.4, 0.4, 0.24], spacing: 0.02}\n"
                      "time: {fps: 60, seconds: 5, solver: projection}\nmaterials:\n  water: {type: newtonian, preset: "
                      "water}\nbodies:\n  dam: {material: water, shape: {box: {min: [0, 0, 0], max: [0.12, 0.2, "
                      "0.24]}}, sample: {pattern: jitter}}\n" +
                          more,
                      "tank.yaml")};
}

/// DREAMPM_TEST_BACKEND=cuda runs the tests by another backend than cpu.
inline PlayOptions quiet_options(int threads = 1) {
  static SilentHost silent;
  PlayOptions o;
  if (const char* const backend = std::getenv("DREAMPM_TEST_BACKEND")) o.simulation.backend = backend;
  o.simulation.threads = threads, o.simulation.host = &silent, o.step_seconds = 0;
  return o;
}

/// Plays lines of a script.
inline void play(Playground& p, const std::vector<std::string>& lines) {
  for (const std::string& line : lines) {
    if (line.starts_with("#") || line.starts_with("plays ")) continue;
    const Action a = Action::parse(line);
    if (a.verb == "refused") {
      EXPECT_THROW(p.act(Action::parse(line.substr(line.find(' ')))), InputError) << line;
      continue;
    }
    if (a.verb == "frames")
      for (int n = 0; n < a.number(0); ++n) p.tick({});
    else if (a.verb == "steps")
      p.tick({static_cast<int>(a.number(0)), {}});
    else
      p.act(a);
  }
}

/// An erasing is undone and done again to the very bits.
inline void expect_exact_undo_of_erasing(Playground& p) {
  const std::uint64_t before = p.hash();
  play(p, {"erase 0.05 0.05 0.1 0.05"});
  const std::uint64_t after = p.hash();
  ASSERT_NE(before, after);
  play(p, {"undo"});
  EXPECT_EQ(p.hash(), before);
  play(p, {"redo"});
  EXPECT_EQ(p.hash(), after);
}

/// Whether every particle is a number, and within the tank.
inline bool finite(const Frame& frame) {
  for (const MatterFrame& m : frame.matter)
    for (const Vec3f& x : m.position)
      if (!std::isfinite(x.x + x.y + x.z) || x.x < -1e-4f || x.x > 0.4001f || x.y < -1e-4f || x.y > 0.4001f)
        return false;
  return true;
}

/// What a line of a script is refused with; empty: it is taken.
inline std::string refusal(Playground& p, const std::string& line) {
  try {
    p.act(Action::parse(line));
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

inline double value_of(Playground& p, const std::string& id) {
  const std::shared_ptr<const Frame> frame = p.frame();
  for (std::size_t i = 0; i < frame->controls->size(); ++i)
    if ((*frame->controls)[i].id == id) return frame->values[i];
  throw std::out_of_range(id);
}

}  // namespace dreampm::play::test

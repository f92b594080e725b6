// Case 8 of the validation set: two presets of the program that asked for this project, against a
// scalar double port of its algorithm (scenes/validation/data/seed_*; each header names its
// source).
#include <gtest/gtest.h>

#include "dreampm/base/file.h"
#include "validate/measure/seed.h"
#include "worlds.h"

namespace dreampm::seed_test {
namespace {
using namespace test;

validate::Table read_table(const std::string& name) {
  const std::string file = DM_SOURCE_DIR "/scenes/validation/data/" + name;
  return {read_file(file), file};
}

constexpr double cell = 1.0 / 32;
constexpr int per_side = 16, count = per_side * per_side * per_side;

/// A cube of 16^3 particles at rest, 0.35 m to 0.6 m, above a floor at 2/32 m.
template <class R>
World<R> preset(bool elastic, std::vector<std::vector<ParticleSeed>>& seeds) {
  World<R> w = empty_world<R>(cell, {28, 28, 28});
  w.origin = Vec3d{2, 2, 2} * cell;
  w.gravity = {0, -9.8, 0};
  w.settings.fps = 5000;
  w.settings.fixed_dt = 2e-4;
  w.settings.keep_inside = false;
  add_set(w, "seed",
          values_of("seed", {{"legacy", 1}, {"elastic", elastic ? 1.0 : 0.0}, {"youngs_modulus", 1000}, {"h", 0.3}}),
          cell / 2);
  // The program's own habit: volumes of two dimensions. It cancels in the motion.
  w.sets[0].rest_volume = cell * cell / 4;
  w.sets[0].mass = w.sets[0].rest_volume;
  seeds = {lattice({{0.35, 0.35, 0.35}, {0.6, 0.6, 0.6}}, 0.25 / per_side, still())};
  return w;
}

template <class R>
validate::SeedErrors run(Backend<R>& backend, bool elastic, int steps) {
  const std::string stem = elastic ? "seed_dreampm_1_elastic_" : "seed_dreampm_0_snow_";
  std::vector<std::vector<ParticleSeed>> seeds;
  World<R> w = preset<R>(elastic, seeds);
  begin(w, backend, seeds);
  validate::SeedErrors e =
      validate::seed_errors(w, read_table(stem + "timeseries.csv"), read_table(stem + "state_step1500.csv"), steps,
                            [&] { step<R>(w, backend, nullptr); });
  EXPECT_TRUE(e.contact);
  EXPECT_EQ(e.state_count, 256u);
  std::printf("%s %s: before contact %.2e, after %.2e, Jp %.2e, state at 1500 rms %.2e max %.2e (%zu samples)\n",
              stem.c_str(), std::string(backend.isa()).c_str(), e.before, e.after, e.jp, e.state_rms, e.state_max,
              e.time.size());
  return e;
}

void check(bool elastic, int steps) {
  const auto reference = make_reference_backend<double>();
  const validate::SeedErrors exact = run(*reference, elastic, steps);
  EXPECT_LE(exact.before, 1e-9);
  EXPECT_LE(exact.after, 1e-6);
  EXPECT_LE(exact.state_max, 1e-6);
  EXPECT_LE(exact.jp, 1e-6);
  const auto cpu = make_cpu_backend();
  const validate::SeedErrors fast = run(*cpu, elastic, steps);
  EXPECT_LE(fast.state_rms, 1e-4);
  const double rms = validate::rms_distance(fast.last, exact.last);
  std::printf("float against double at step %d: rms %.2e\n", steps, rms);
  EXPECT_LE(rms, 1e-4);
}

TEST(Seed, SnowFollowsTheReference) { check(false, 2000); }
TEST(Seed, ElasticFollowsTheReference) { check(true, 1500); }

TEST(Seed, WithoutItsHabitsSnowGoesAnotherWay) {
  // The comparison must be able to fail: hardening by this step's Jp alone moves the impact by more
  // than the gate.
  std::vector<std::vector<ParticleSeed>> seeds;
  World<float> legacy = preset<float>(false, seeds), own = legacy;
  own.sets[0].values.set("legacy", 0);
  const auto a = make_cpu_backend(), b = make_cpu_backend();
  begin(legacy, *a, seeds), begin(own, *b, seeds);
  for (int n = 0; n < 1400; ++n) step<float>(legacy, *a, nullptr), step<float>(own, *b, nullptr);
  const auto x = positions_by_id(legacy), y = positions_by_id(own);
  double worst = 0;
  for (std::size_t i = 0; i < count; ++i) worst = std::max(worst, length(x[i] - y[i]));
  EXPECT_GT(worst, 1e-4);
}

}  // namespace
}  // namespace dreampm::seed_test

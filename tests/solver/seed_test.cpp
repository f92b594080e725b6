// Case 8 of the validation set: two presets of the program that asked for this project, against a scalar double port of
// its algorithm (tests/data/seed_*; each header names its source).
#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <sstream>

#include "worlds.h"

namespace dreampm {
namespace {
using namespace test;

/// Rows of a CSV by their first column; lines of # are comments, then come the names of the columns.
struct Table {
  std::map<std::string, std::size_t> column;
  std::map<int, std::vector<double>> rows;
  double at(int row, const std::string& name) const { return rows.at(row).at(column.at(name)); }
  Vec3d vec(int row, const std::string& x, const std::string& y, const std::string& z) const {
    return {at(row, x), at(row, y), at(row, z)};
  }
};

Table read_table(const std::string& name) {
  std::ifstream in(std::string(DM_SOURCE_DIR) + "/tests/data/" + name);
  if (!in) throw std::runtime_error("cannot read " + name);
  Table t;
  for (std::string line; std::getline(in, line);) {
    if (line.empty() || line[0] == '#') continue;
    std::istringstream cells(line);
    std::vector<std::string> words;
    for (std::string w; std::getline(cells, w, ',');) words.push_back(w);
    if (t.column.empty()) {
      for (std::size_t i = 0; i < words.size(); ++i) t.column[words[i]] = i;
      continue;
    }
    std::vector<double> values;
    for (const auto& w : words) values.push_back(std::stod(w));
    const int key = static_cast<int>(values[0]);
    t.rows[key] = std::move(values);
  }
  return t;
}

constexpr double cell = 1.0 / 32;
constexpr int per_side = 16, count = per_side * per_side * per_side;

/// A cube of 16^3 particles at rest, 0.35 m to 0.6 m, above a floor at 2/32 m.
template <class R>
World<R> preset(bool elastic, std::vector<std::vector<Newborn>>& newborns) {
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
  newborns = {lattice({{0.35, 0.35, 0.35}, {0.6, 0.6, 0.6}}, 0.25 / per_side, still())};
  return w;
}

struct Errors {
  double before = 0, after = 0, jp = 0, state_rms = 0, state_max = 0;
  int samples = 0;
  std::vector<Vec3d> last;
};

template <class R>
Errors run(Backend<R>& backend, bool elastic, int steps) {
  const std::string stem = elastic ? "seed_dreampm_1_elastic_" : "seed_dreampm_0_snow_";
  const Table series = read_table(stem + "timeseries.csv"), state = read_table(stem + "state_step1500.csv");
  std::vector<std::vector<Newborn>> newborns;
  World<R> w = preset<R>(elastic, newborns);
  begin(w, backend, newborns);
  // Contact begins when a kernel first holds a node of the floor: within 1.5 cells.
  bool contact = false;
  Errors e;
  for (int n = 1; n <= steps; ++n) {
    // The port advances F and Jp at the start of a step, with the C of the step before: one behind.
    double jp = 0;
    for (const R j : w.sets[0].state[9]) jp += static_cast<double>(j) / count;
    step<R>(w, backend, nullptr);
    if (series.rows.contains(n)) {
      const auto x = positions_by_id(w);
      Vec3d centre{};
      double low = 1e30;
      for (const Vec3d& p : x) centre += p * (1.0 / count), low = std::min(low, p.y);
      contact = contact || low < (2 + 1.5) * cell;
      double worst = length(centre - series.vec(n, "cx", "cy", "cz"));
      worst = std::max(worst, length(x[0] - series.vec(n, "p0x", "p0y", "p0z")));
      worst = std::max(worst, length(x[count / 2] - series.vec(n, "pMx", "pMy", "pMz")));
      worst = std::max(worst, length(x[count - 1] - series.vec(n, "pLx", "pLy", "pLz")));
      double& slot = contact ? e.after : e.before;
      slot = std::max(slot, worst);
      e.jp = std::max(e.jp, std::abs(jp - series.at(n, "meanJp")));
      ++e.samples;
    }
    if (n == 1500) {
      const auto x = positions_by_id(w);
      double sum = 0;
      for (const auto& [id, row] : state.rows) {
        const double d = length(x.at(static_cast<std::size_t>(id)) - state.vec(id, "x", "y", "z"));
        sum += d * d;
        e.state_max = std::max(e.state_max, d);
      }
      EXPECT_EQ(state.rows.size(), 256u);
      e.state_rms = std::sqrt(sum / static_cast<double>(state.rows.size()));
    }
  }
  e.last = positions_by_id(w);
  EXPECT_TRUE(contact);
  std::printf("%s %s: before contact %.2e, after %.2e, Jp %.2e, state at 1500 rms %.2e max %.2e (%d samples)\n",
              stem.c_str(), std::string(backend.isa()).c_str(), e.before, e.after, e.jp, e.state_rms, e.state_max,
              e.samples);
  return e;
}

void check(bool elastic, int steps) {
  const auto reference = make_reference_backend<double>();
  const Errors exact = run(*reference, elastic, steps);
  EXPECT_LE(exact.before, 1e-9);
  EXPECT_LE(exact.after, 1e-6);
  EXPECT_LE(exact.state_max, 1e-6);
  EXPECT_LE(exact.jp, 1e-6);
  const auto cpu = make_cpu_backend();
  const Errors fast = run(*cpu, elastic, steps);
  EXPECT_LE(fast.state_rms, 1e-4);
  double sum = 0;
  for (std::size_t i = 0; i < count; ++i) sum += length2(fast.last[i] - exact.last[i]);
  const double rms = std::sqrt(sum / count);
  std::printf("float against double at step %d: rms %.2e\n", steps, rms);
  EXPECT_LE(rms, 1e-4);
}

TEST(Seed, SnowFollowsTheReference) { check(false, 2000); }
TEST(Seed, ElasticFollowsTheReference) { check(true, 1500); }

TEST(Seed, WithoutItsHabitsSnowGoesAnotherWay) {
  // The comparison must be able to fail: hardening by this step's Jp alone moves the impact by more than the gate.
  std::vector<std::vector<Newborn>> newborns;
  World<float> legacy = preset<float>(false, newborns), own = legacy;
  own.sets[0].values.set("legacy", 0);
  const auto a = make_cpu_backend(), b = make_cpu_backend();
  begin(legacy, *a, newborns), begin(own, *b, newborns);
  for (int n = 0; n < 1400; ++n) step<float>(legacy, *a, nullptr), step<float>(own, *b, nullptr);
  const auto x = positions_by_id(legacy), y = positions_by_id(own);
  double worst = 0;
  for (std::size_t i = 0; i < count; ++i) worst = std::max(worst, length(x[i] - y[i]));
  EXPECT_GT(worst, 1e-4);
}

}  // namespace
}  // namespace dreampm

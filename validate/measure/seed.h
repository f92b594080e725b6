// The presets of the program that asked for this project, against a scalar double port of its
// algorithm: 16^3 particles of a cube that falls on a floor at 2/32 m, in cells of 1/32 m and steps
// of 2e-4 s. Ids are (i 16 + j) 16 + k.
#pragma once
#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "validate/measure/particles.h"
#include "validate/measure/table.h"

namespace dreampm::validate {

struct SeedErrors {
  double before = 0, after = 0;         ///< largest distance [m] of the tracked points before and after contact
  double jp = 0;                        ///< largest difference of the mean Jp
  double state_rms = 0, state_max = 0;  ///< distances [m] of the particles of the state file, after 1500 steps
  std::size_t state_count = 0;          ///< how many those are; 0 if the run was shorter
  bool contact = false;                 ///< the cube reached the floor
  std::vector<double> time, distance;   ///< s, m: every sample
  std::vector<Vec3d> last;              ///< positions by id at the end
};

/// Steps `steps` times. `series`, `state`: the reference's files.
template <class R, class Step>
SeedErrors seed_errors(const World<R>& w, const Table& series, const Table& state, int steps, const Step& step) {
  constexpr double cell = 1.0 / 32;
  std::map<int, std::size_t> row_of;
  for (std::size_t r = 0; r < series.size(); ++r) row_of[static_cast<int>(series.number(r, "step"))] = r;
  const std::size_t count = w.particles();
  SeedErrors e;
  for (int n = 1; n <= steps; ++n) {
    // The port advances F and Jp at the start of a step, with the C of the step before: one behind.
    double jp = 0;
    for (const R j : ParticleSetView(w, 0).column("jp")) jp += static_cast<double>(j) / static_cast<double>(count);
    step();
    if (const auto row = row_of.find(n); row != row_of.end()) {
      const auto vec = [&](const char* x, const char* y, const char* z) {
        return Vec3d{series.number(row->second, x), series.number(row->second, y), series.number(row->second, z)};
      };
      const auto x = positions_by_id(w);
      Vec3d center{};
      double low = 1e30;
      for (const Vec3d& p : x) center += p * (1.0 / static_cast<double>(count)), low = std::min(low, p.y);
      // Contact begins when a kernel first holds a node of the floor: within 1.5 cells.
      e.contact = e.contact || low < (2 + 1.5) * cell;
      double worst = length(center - vec("cx", "cy", "cz"));
      worst = std::max(worst, length(x[0] - vec("p0x", "p0y", "p0z")));
      worst = std::max(worst, length(x[count / 2] - vec("pMx", "pMy", "pMz")));
      worst = std::max(worst, length(x[count - 1] - vec("pLx", "pLy", "pLz")));
      double& slot = e.contact ? e.after : e.before;
      slot = std::max(slot, worst);
      e.jp = std::max(e.jp, std::abs(jp - series.number(row->second, "meanJp")));
      e.time.push_back(w.time), e.distance.push_back(worst);
    }
    if (n == 1500) {
      const auto x = positions_by_id(w);
      double sum = 0;
      for (std::size_t r = 0; r < state.size(); ++r) {
        const Vec3d want{state.number(r, "x"), state.number(r, "y"), state.number(r, "z")};
        const double d = length(x.at(static_cast<std::size_t>(state.number(r, "index"))) - want);
        sum += d * d;
        e.state_max = std::max(e.state_max, d);
      }
      e.state_count = state.size();
      e.state_rms = std::sqrt(sum / static_cast<double>(state.size()));
    }
  }
  e.last = positions_by_id(w);
  return e;
}

/// Root mean square distance [m] of two sets of points.
inline double rms_distance(const std::vector<Vec3d>& a, const std::vector<Vec3d>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += length2(a[i] - b.at(i));
  return std::sqrt(sum / static_cast<double>(a.size()));
}

}  // namespace dreampm::validate

// How far a free body's conserved quantities drift.
#pragma once
#include <algorithm>
#include <vector>

#include "dreampm/backend/reductions.h"

namespace dreampm::validate {

struct Drift {
  double mass = 0;                  ///< largest relative change
  double momentum = 0;              ///< largest relative change
  double angular = 0;               ///< largest relative change, about the origin, with the affine part
  double energy = 0;                ///< largest kinetic + elastic energy over that of the start
  std::vector<double> time, ratio;  ///< s; energy over that of the start, frame by frame
};

/// Steps `steps` times; step(Motion*) must return the step's report. The body as a whole has to
/// move and to turn: what drifts is measured against that.
template <class R, class Step>
Drift drift_of(World<R>& w, const Balance& start, int steps, const Step& step) {
  Drift d;
  Motion<R> motion;
  for (int i = 0; i < steps; ++i) {
    if (!step(&motion).frame_done) continue;
    const Balance b = balance(w, motion);
    d.mass = std::max(d.mass, std::abs(b.mass / start.mass - 1));
    d.momentum = std::max(d.momentum, length(b.momentum - start.momentum) / length(start.momentum));
    d.angular = std::max(d.angular, length(b.angular - start.angular) / length(start.angular));
    d.time.push_back(w.time);
    d.ratio.push_back((b.kinetic + b.elastic) / (start.kinetic + start.elastic));
    d.energy = std::max(d.energy, d.ratio.back());
  }
  return d;
}

}  // namespace dreampm::validate

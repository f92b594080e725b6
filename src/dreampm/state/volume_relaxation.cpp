#include "dreampm/state/volume_relaxation.h"

#include <algorithm>
#include <cmath>

#include "dreampm/physics/materials.h"
#include "dreampm/physics/shift.h"

namespace dreampm {
namespace {

/// The fastest sound [m/s] of all volume-relaxed liquids, or pace of the volume relaxation where
/// that is faster.
template <class R>
double fastest_relaxation(const World<R>& world) {
  double fastest = 0;
  for (const auto& set : world.sets)
    Materials::with(set.material, [&]<class M>() {
      if constexpr (VolumeRelaxed<M>) {
        const auto law = M::template Law<R>::from(set.values);
        if (law.volume_relaxation() > 0)
          fastest = std::max(fastest, static_cast<double>(std::max(law.volume_relaxation(), law.sound)));
      }
    });
  return fastest;
}

}  // namespace

template <class R>
double volume_relaxation_time(const World<R>& world, double dt) {
  const double period = VolumeCorrection::relaxation_stride * world.dx / fastest_relaxation(world);
  // Half a period off, so that no end of a frame, where times are rounded, is likely to be one of
  // these.
  const auto periods = [&](double time) { return std::floor(time / period + 0.5); };
  return std::isfinite(period) ? period * (periods(world.time + dt) - periods(world.time)) : 0;
}

template double volume_relaxation_time(const World<float>&, double);
template double volume_relaxation_time(const World<double>&, double);

}  // namespace dreampm

// The front of liquid on a floor, and how deep it is somewhere.
#pragma once
#include <cmath>
#include <vector>

#include "validate/measure/fit.h"
#include "validate/measure/particles.h"

namespace dreampm::validate {

/// The front along +x is the farthest one-cell slab that holds at least half of a full layer, one
/// cell high, of the whole depth in z. A front of that height fills half a slab when it is at its
/// middle: so the moments at which slabs first hold that much, with their middles, are its motion.
class Front {
 public:
  /// Makes the front of the liquid set 0, which begins at `x` [m].
  explicit Front(double x) : times{0}, places{x} {}

  template <class R>
  void add(const World<R>& w) {
    const auto volume = slab_volumes(w, 0);
    const double half = 0.5 * w.dx * w.dx * w.dx * (w.high.z - w.low.z);
    if (volume_.size() != volume.size()) volume_.assign(volume.size(), 0);
    for (std::size_t i = volume.size(); i-- > 0;) {
      const double middle = w.origin.x + (static_cast<double>(i) + 0.5) * w.dx;
      if (middle <= places.back()) break;
      if (volume[i] < half) continue;
      // Between the two samples the slab filled evenly.
      const double part = (half - volume_[i]) / (volume[i] - volume_[i]);
      times.push_back(time_ + (w.time - time_) * part), places.push_back(middle);
      break;
    }
    volume_ = volume, time_ = w.time;
  }
  std::vector<double> times, places;  ///< s, m

 private:
  std::vector<double> volume_;
  double time_ = 0;
};

/// Returns the height [m] over the floor of the liquid of set 0 over the cells [from, to) of x: the
/// mean over those cells and all of z of the highest particle's height and half the spacing above
/// it. Counts of particles would step, as a slow flow moves them out of a cell row by row. Empty
/// cells count as 0.
template <class R>
double surface_height(const World<R>& w, int from, int to) {
  const int depth = w.high.z - w.low.z;
  std::vector<double> top(static_cast<std::size_t>((to - from) * depth), 0);
  const double half = 0.5 * std::cbrt(w.sets.at(0).rest_volume);
  each_particle(w, [&](std::size_t s, std::size_t, const Vec3d& at) {
    const int i = static_cast<int>(std::floor((at.x - w.origin.x) / w.dx)) - from;
    const int k = static_cast<int>(std::floor((at.z - w.origin.z) / w.dx));
    if (s != 0 || i < 0 || i >= to - from || k < 0 || k >= depth) return;
    double& highest = top[static_cast<std::size_t>(i * depth + k)];
    highest = std::max(highest, at.y - w.origin.y + half);
  });
  double sum = 0;
  for (const double y : top) sum += y;
  return sum / static_cast<double>(top.size());
}

}  // namespace dreampm::validate

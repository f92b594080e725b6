// Water has no numerical glue: two halves of a column that fly apart part, and keep their speed.
#include <cmath>

#include "dreampm/validate/measure/fit.h"
#include "dreampm/validate/measure/particles.h"
#include "dreampm/validate/run.h"

namespace dreampm::validate::cases {
namespace {

constexpr double speed = 1;  // m/s, of each half
constexpr double length = 0.16;

struct Halves {
  std::vector<double> time, distance;  ///< of their middles, less that at the start
  double kept = 0;                     ///< of their speed, over the last quarter
  double between = 0;                  ///< of all matter, at the end: nearer to the middle than half of the gap's half
};

Halves fly(Trial& t, const std::vector<std::string>& overrides = {}) {
  Run<float> run(t, "tearing", overrides);
  run.begin();
  Halves h;
  const auto sample = [&] {
    const std::vector<Vec3d> at = positions_by_id(run.world);  // the low half has the lower ids
    const std::size_t half = at.size() / 2;
    double sum = 0;
    h.between = 0;
    for (std::size_t p = 0; p < at.size(); ++p) {
      sum += (p < half ? -at[p].z : at[p].z) / static_cast<double>(half);
      if (std::abs(at[p].z) < 0.5 * speed * run.world.time) h.between += 1 / static_cast<double>(at.size());
    }
    h.time.push_back(run.world.time), h.distance.push_back(sum - length);
  };
  sample();
  run.until(0.3, [&](const StepReport& s) {
    if (s.frame_done) sample();
  });
  const std::size_t from = h.time.size() * 3 / 4;
  h.kept = (h.distance.back() - h.distance[from]) / (2 * speed * (h.time.back() - h.time[from]));
  return h;
}

void run(Trial& t) {
  t.chose(
      "Particles on both sides of the plane of tearing share nodes within 1.5 cells of it. If these layers lost all of "
      "their speed, halves of 16 cells would keep 1 - 1.5/16: that is the gate. Water here has no surface tension.");
  const Halves ours = fly(t);
  t.at_least("part of its speed that a half keeps", ours.kept, 1 - 1.5 / 16);
  t.at_most("matter left in the middle half of the gap", ours.between, 0.5 * 1.5 / 16, "%");
  t.tell("the same of flip, blend 0.95",
         fly(t, {"materials.water.transfer=flip", "materials.water.flip_blend=0.95"}).kept);
  t.control("a liquid that can pull", "part of its speed that a half keeps",
            fly(t, {"materials.water.tension=true"}).kept);
  std::vector<double> exact;
  for (const double time : ours.time) exact.push_back(2 * speed * time);
  t.plot({"tearing",
          "A column of water whose halves fly apart at 2 m/s",
          "time  [s]",
          "distance gained  [m]",
          {{"ours", ours.time, ours.distance}, {"free flight", ours.time, exact, true}}});
}

}  // namespace

extern const Case tearing;
const Case tearing{"tearing",
                   "the speed of two halves of a column of water that fly apart, and what is left between them",
                   "free flight, exact",
                   true,
                   run,
                   3};

}  // namespace dreampm::validate::cases

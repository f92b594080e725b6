// Water has no numerical glue: two halves of a column that fly apart part, and keep their speed;
// eight parts of a cube fall as eight fragments, each along its parabola.
#include <cmath>

#include "validate/measure/fit.h"
#include "validate/measure/pairs.h"
#include "validate/measure/particles.h"
#include "validate/validation_run.h"

namespace dreampm::validate::cases {
namespace tearing_case {
namespace {

constexpr double speed = 1;      // m/s, of each half
constexpr double column = 0.16;  // m

struct Halves {
  std::vector<double> time, distance;  ///< of their middles, less that at the start
  double kept = 0;                     ///< of their speed, over the last quarter
  double between = 0;                  ///< of all matter, at the end: nearer to the middle than half of the gap's half
};

Halves fly(Trial& t, const std::vector<std::string>& overrides = {}) {
  ValidationRun<float> run(t, "tearing", overrides);
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
    h.time.push_back(run.world.time), h.distance.push_back(sum - column);
  };
  sample();
  run.until(0.3, [&](const StepSums& s) {
    if (s.frame_done) sample();
  });
  const std::size_t from = h.time.size() * 3 / 4;
  h.kept = (h.distance.back() - h.distance[from]) / (2 * speed * (h.time.back() - h.time[from]));
  return h;
}

struct Splash {
  double fragments = 0;  ///< with an eighth of a part's matter or more
  double astray = 0;     ///< the worst part's center from its parabola, of its way without gravity
};

/// The eight parts of a cube after 0.2 s.
Splash splash(Trial& t, const std::vector<std::string>& overrides = {}) {
  ValidationRun<float> run(t, "splash", overrides);
  for (ParticleSeed& n : run.seeds[0])
    for (int a = 0; a < 3; ++a) n.velocity[a] = std::copysign(speed, n.position[a]);
  const std::vector<ParticleSeed> all = run.all_seeds();
  run.begin();
  run.until(0.2);
  const double time = run.world.time, part = static_cast<double>(all.size()) / 8;
  const std::vector<Vec3d> at = positions_by_id(run.world);
  Splash s;
  for (const std::size_t size : pieces(at, run.world.dx)) s.fragments += 8 * static_cast<double>(size) >= part;
  Vec3d off[8]{};
  for (std::size_t p = 0; p < all.size(); ++p) {
    const Vec3d& v = all[p].velocity;
    off[4 * (v.x > 0) + 2 * (v.y > 0) + (v.z > 0)] +=
        (at[p] - all[p].position - v * time - run.world.gravity * (time * time / 2)) / part;
  }
  for (const Vec3d& o : off) s.astray = std::max(s.astray, length(o) / (std::sqrt(3.0) * speed * time));
  return s;
}

void run(Trial& t) {
  t.note_choice(
      "Particles on both sides of the plane of tearing share nodes within 1.5 cells of it. If these layers lost all of "
      "their speed, halves of 16 cells would keep 1 - 1.5/16: that is the gate. Water here has no surface tension.");
  t.note_choice(
      "The cube's parts have 8 cells an edge, and so may lag by 1.5/8 of their way along every axis. A fragment is "
      "what hangs together by distances below a cell and has an eighth of a part's matter: a core of 4 cells an edge, "
      "one more than a particle's spline spans.");
  const Halves ours = fly(t);
  const char* const kept = "part of its speed that a half keeps";
  const char* const left = "matter left in the middle half of the gap";
  t.at_least(kept, ours.kept, 1 - 1.5 / 16);
  t.at_most(left, ours.between, 0.5 * 1.5 / 16, "%");
  const Splash drops = splash(t);
  const char *const fragments = "fragments of a cube whose eight parts fly apart",
                    *const astray = "its worst part off its parabola, of the way flown";
  t.at_least(fragments, drops.fragments, 8);
  t.at_most(astray, drops.astray, 1.5 / 8, "%");
  t.report("the same of flip, blend 0.95",
           fly(t, {"materials.water.transfer=flip", "materials.water.flip_blend=0.95"}).kept);
  const char* const pulls = "a liquid that can pull";
  const Halves glued = fly(t, {"materials.water.tension=true"});
  t.control(pulls, kept, glued.kept);
  t.control(pulls, left, glued.between);
  const Splash whole = splash(t, {"materials.water.tension=true"});
  t.control(pulls, fragments, whole.fragments);
  t.control(pulls, astray, whole.astray);
  std::vector<double> exact;
  for (const double time : ours.time) exact.push_back(2 * speed * time);
  t.plot({"tearing",
          "A column of water whose halves fly apart at 2 m/s",
          "time  [s]",
          "distance gained  [m]",
          {{"ours", ours.time, ours.distance}, {"free flight", ours.time, exact, true}}});
}

}  // namespace
}  // namespace tearing_case

extern const Case tearing;
const Case tearing{
    "tearing",
    "water that flies apart: the speed of two halves, what is left between them, and eight fragments that fall",
    "free flight, exact",
    true,
    tearing_case::run,
    3};

}  // namespace dreampm::validate::cases

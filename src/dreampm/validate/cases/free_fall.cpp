// Free fall: a body without contact follows the time integrator's own parabola, to rounding.
#include "dreampm/validate/measure/motion.h"
#include "dreampm/validate/run.h"

namespace dreampm::validate::cases {
namespace {

constexpr int steps = 800;
const Vec3d g{0, -9.81, 0};

template <class R>
double error(Trial& t, const std::vector<std::string>& overrides = {}) {
  Run<R> run(t, "free-fall", overrides);
  run.begin();
  return fall_error(run.world, run.all_newborns(), steps, g, [&] { run.step(); });
}

void run(Trial& t) {
  t.at_most("reference (double): farthest from x0 + n dt v0 + n(n+1)/2 dt^2 g", error<double>(t), 1e-12, "m");
  // Positions in float carry about 1e-7 of 2 cells, 800 times, at random: 1e-7.
  t.at_most("cpu (float): farthest from it", error<float>(t), 5e-6, "m");
  t.control("gravity 9.80", "cpu (float): farthest from it", error<float>(t, {"gravity=[0,-9.80,0]"}));
}

}  // namespace

extern const Case free_fall;
const Case free_fall{"free-fall",
                     "a thrown elastic block against the exact motion of symplectic Euler",
                     "the integrator's own sum, exact",
                     true,
                     run,
                     1};

}  // namespace dreampm::validate::cases

// Free fall: a body without contact follows the time integrator's own parabola, to rounding.
#include "validate/measure/motion.h"
#include "validate/validation_run.h"

namespace dreampm::validate::cases {
namespace free_fall_case {
namespace {

constexpr int steps = 800;
const Vec3d g{0, -9.81, 0};

template <class R>
double error(Trial& t, Curve& course, const std::vector<std::string>& overrides = {}) {
  ValidationRun<R> run(t, "free-fall", overrides);
  run.begin();
  const std::vector<ParticleSeed> seeds = run.all_seeds();
  int n = 0;
  return fall_error(run.world, seeds, steps, g, [&] {
    run.step();
    if (++n % 10) return;
    course.x.push_back(run.world.time);
    course.y.push_back(std::log10(fallen_astray(run.world, seeds, n, g)));
  });
}

void run(Trial& t) {
  const std::string who = t.options().in_float();
  Curve exact{"reference (double)", {}, {}}, fast{who, {}, {}}, wrong{"control: gravity 9.80, " + who, {}, {}};
  const std::string in_double = "reference (double): farthest from x0 + n dt v0 + n(n+1)/2 dt^2 g",
                    in_float = who + ": farthest from it";
  t.at_most(in_double, error<double>(t, exact), 1e-12, "m");
  // Positions in float carry about 1e-7 of 2 cells, 800 times, at random: 1e-7.
  t.at_most(in_float, error<float>(t, fast), 5e-6, "m");
  const std::vector<std::string> lighter{"gravity=[0,-9.80,0]"};
  t.control("gravity 9.80", in_float, error<float>(t, wrong, lighter));
  Curve untold;
  t.control("gravity 9.80", in_double, error<double>(t, untold, lighter));
  const double end = exact.x.back();
  t.plot({"free-fall",
          "Farthest of a thrown block's particles from their parabolas",
          "time  [s]",
          "log10 of the distance [m]",
          {std::move(exact), std::move(fast), std::move(wrong), level("gate, float", 0, end, std::log10(5e-6)),
           level("gate, double", 0, end, -12)}});
}

}  // namespace
}  // namespace free_fall_case

extern const Case free_fall;
const Case free_fall{"free-fall",
                     "a thrown elastic block against the exact motion of symplectic Euler",
                     "the integrator's own sum, exact",
                     true,
                     free_fall_case::run,
                     1};

}  // namespace dreampm::validate::cases

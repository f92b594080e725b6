// A standing wave of finite amplitude in a bar: u = A sin(pi X/L) cos(pi c t/L) is exact for the fixed corotated solid
// in uniaxial strain (c^2 = (lambda + 2 mu)/rho0) and for p = K(1 - J) (c^2 = K/rho0).
#include "dreampm/validate/bar.h"

namespace dreampm::validate::cases {
namespace {

void run(Trial& t) {
  t.chose("The liquid has p = K (1 - J) (gamma: linear), may pull and is not anchored: for it the wave is exact.");
  const BarWave solid = ring_bar(t, "bar-wave-elastic", 64), liquid = ring_bar(t, "bar-wave-liquid", 64);
  t.at_most("elastic solid: error of the period", std::abs(solid.period - 1), 0.01, "%");
  t.at_most("elastic solid: error of the amplitude after two periods", std::abs(solid.amplitude - 1), 0.01, "%");
  t.at_most("liquid: error of the period", std::abs(liquid.period - 1), 0.01, "%");
  t.at_most("liquid: error of the amplitude after two periods", std::abs(liquid.amplitude - 1), 0.01, "%");
  // The reference keeps E and nu of the scene: the wave of another nu is 3 % faster.
  t.control("Poisson's ratio 0.32 for 0.3", "elastic solid: error of the period",
            std::abs(ring_bar(t, "bar-wave-elastic", 64, {"materials.bar.poissons_ratio=0.32"}).period - 1));
  t.plot({"bar-wave",
          "Standing wave in a bar, 64 cells",
          "time / period",
          "displacement / amplitude",
          {solid.curve("elastic solid"), liquid.curve("liquid"), solid.exact()}});
}

}  // namespace

extern const Case bar_wave;
const Case bar_wave{"bar-wave",
                    "the first longitudinal wave of a bar: period and amplitude",
                    "exact solution of uniaxial strain",
                    true,
                    run,
                    6};

}  // namespace dreampm::validate::cases

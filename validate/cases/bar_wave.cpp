// A standing wave of finite amplitude in a bar: u = A sin(pi X/L) cos(pi c t/L) is exact for the
// fixed corotated solid in uniaxial strain (c^2 = (lambda + 2 mu)/rho0) and for p = K(1 - J) (c^2 =
// K/rho0).
#include "validate/bar.h"

namespace dreampm::validate::cases {
namespace bar_wave_case {
namespace {

void run(Trial& t) {
  t.note_choice("The liquid has p = K (1 - J) (gamma: linear), may pull and is not relaxed: for it the wave is exact.");
  const BarWave solid = ring_bar(t, "bar-wave-elastic", 64), liquid = ring_bar(t, "bar-wave-liquid", 64);
  const auto judge = [&](const std::string& name, const BarWave& wave, const char* scene, const char* what,
                         const std::string& stiffer) {
    const std::string period = name + ": error of the period",
                      amplitude = name + ": error of the amplitude after two periods";
    t.at_most(period, std::abs(wave.period - 1), 0.01, "%");
    t.at_most(amplitude, std::abs(wave.amplitude - 1), 0.01, "%");
    // The reference keeps the stiffness of the scene.
    t.control(what, period, std::abs(ring_bar(t, scene, 32, {stiffer}).period - 1));
    t.control("damping of 0.2/s", amplitude, std::abs(ring_bar(t, scene, 32, {"time.damping=0.2"}).amplitude - 1));
  };
  judge("elastic solid", solid, "bar-wave-elastic", "Poisson's ratio 0.32 for 0.3",
        "materials.bar.poissons_ratio=0.32");
  judge("liquid", liquid, "bar-wave-liquid", "K a twentieth too large", "materials.bar.bulk_modulus=1.05e5");
  t.plot({"bar-wave",
          "Standing wave in a bar, 64 cells",
          "time / period",
          "displacement / amplitude",
          {solid.curve("elastic solid"), liquid.curve("liquid"), solid.exact()}});
}

}  // namespace
}  // namespace bar_wave_case

extern const Case bar_wave;
const Case bar_wave{"bar-wave",
                    "the first longitudinal wave of a bar: period and amplitude",
                    "exact solution of uniaxial strain",
                    true,
                    bar_wave_case::run,
                    6};

}  // namespace dreampm::validate::cases

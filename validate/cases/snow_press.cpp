// Snow pressed along one axis between walls: how it packs and hardens. Every node gets the velocity
// of an even compression before each step, so that the stretch is known exactly.
#include <cmath>

#include "dreampm/state/node_view.h"
#include "validate/measure/fit.h"
#include "validate/measure/particles.h"
#include "validate/validation_run.h"

namespace dreampm::validate::cases {
namespace snow_press_case {
namespace {

/// The packing by stretch, falling: the mean Jp, the distance of the farthest particle's Jp from
/// it, and the hardening.
struct Packing {
  std::vector<double> pressed, jp, spread, hardening;  ///< pressed: 1 - stretch
};

/// `odd`: how much denser one particle is packed at the start, for a control.
Packing press(Trial& t, double to, const std::vector<std::string>& overrides = {}, float odd = 0) {
  constexpr double part = 1e-3, yields = 0.975;  // of the stretch in a step; where the snow's own stretch stops
  ValidationRun<float> run(t, "snow-press", overrides);
  run.begin();
  World<float>& w = run.world;
  state_column(w.sets[0], "jp")[0] -= odd;
  Packing r;
  Motion<float> motion;
  double unhardened = 0;
  for (int n = 0; 1 - n * part > to + part / 2; ++n) {
    const double stretch = 1 - n * part, rate = -part / stretch / w.dt_next;
    for_each_node(w, [&](const Vec3i& at, Node<float>& node) {
      // A node behind a wall stands for an image in it, which the even motion fits too.
      const double y = w.node_position(at).y;
      node.x = node.z = 0;
      node.y = static_cast<float>(static_cast<double>(node.m) * rate * y);
    });
    run.step(&motion);
    const double now = stretch - part;
    const auto jp = ParticleSetView<float>(w, 0).column("jp");
    double sum = 0, farthest = 0;
    for (const float j : jp) sum += static_cast<double>(j);
    const double mean = sum / static_cast<double>(jp.size());
    for (const float j : jp) farthest = std::max(farthest, std::abs(static_cast<double>(j) - mean));
    // Its energy at the stretch that it keeps grows as the hardening does.
    const double energy = balance(w, motion).elastic;
    if (std::abs(now - yields) < part / 2) unhardened = energy;
    r.pressed.push_back(1 - now), r.jp.push_back(mean), r.spread.push_back(farthest);
    r.hardening.push_back(unhardened > 0 ? energy / unhardened : 1);
  }
  return r;
}

double jp_error(const Packing& p, const Table& exact) {
  double worst = 0;
  for (std::size_t r = 0; r < exact.size(); ++r)
    worst =
        std::max(worst, std::abs(interpolate(p.pressed, p.jp, 1 - exact.number(r, "stretch")) - exact.number(r, "jp")));
  return worst;
}

double hardening_error(const Packing& p, const Table& exact) {
  double worst = 0;
  for (std::size_t r = 0; r < exact.size(); ++r)
    worst = std::max(
        worst,
        std::abs(interpolate(p.pressed, p.hardening, 1 - exact.number(r, "stretch")) / exact.number(r, "h") - 1));
  return worst;
}

void run(Trial& t) {
  const Table exact = reference_table("snow_confined_uniaxial.csv");
  const double end = exact.numbers("stretch").back();
  const Packing snow = press(t, end);
  const char *const jp = "Jp at stretches 0.95, 0.9, 0.8: worst error",
                    *const hardening = "hardening there, by the elastic energy: worst error",
                    *const spread = "farthest particle from the mean Jp";
  const auto farthest = [](const Packing& p) { return *std::max_element(p.spread.begin(), p.spread.end()); };
  t.at_most(jp, jp_error(snow, exact), 1e-4);
  t.at_most(hardening, hardening_error(snow, exact), 1e-3, "%");
  t.at_most(spread, farthest(snow), 1e-4);
  t.control("a critical compression of 0.03", jp,
            jp_error(press(t, end, {"materials.snow.critical_compression=0.03"}), exact));
  t.control("a hardening of 9.9 for 10", hardening,
            hardening_error(press(t, end, {"materials.snow.hardening=9.9"}), exact));
  t.control("one particle packed by 0.001 at the start", spread, farthest(press(t, end, {}, 0.001f)));
  std::vector<double> pressed;
  for (const double s : exact.numbers("stretch")) pressed.push_back(1 - s);
  t.plot({"snow-press",
          "Snow pressed between walls",
          "1 - stretch",
          "Jp",
          {{"Jp", snow.pressed, snow.jp}, {"Jp, exact", pressed, exact.numbers("jp"), true}}});
}

}  // namespace
}  // namespace snow_press_case

extern const Case snow_press;
const Case snow_press{"snow-press",
                      "how snow packs and hardens, pressed along one axis between walls",
                      "Stomakhin et al. 2013, derived: snow_confined_uniaxial.csv",
                      true,
                      snow_press_case::run,
                      1};

}  // namespace dreampm::validate::cases

// A rigid mass on a compressible column: kH tan(kH) = m_fluid/m_piston, omega = (kH) c/H. The mass
// is a stiff elastic box, whose own sound takes a hundredth of a period to cross it. A liquid
// cannot pull a solid: a little gravity keeps them together. They come to rest under it, then a
// part of it is taken away. p = K (1 - J) is linear in the initial heights, so the period is that
// without gravity.
#include <algorithm>
#include <numbers>

#include "validate/measure/fit.h"
#include "validate/measure/hydrostatic.h"
#include "validate/measure/motion.h"
#include "validate/validation_run.h"

namespace dreampm::validate::cases {
namespace piston_case {
namespace {

constexpr double height = 0.5, c = 10, area_density = 500 * height, thickness = 0.125;

constexpr double g = 1.5;  // m/s^2

/// The column under its own weight and a load on it [Pa].
class Loaded {
 public:
  Loaded(const Values& values, double load) : law_(values, g, height), weight_(values["density"] * g), load_(load) {}
  double strain(double Y) const { return law_.strain(weight_ * (height - Y) + load_); }
  /// Returns the place of the matter from Y: the integral of J, by the trapezium.
  double pressed(double Y) const {
    constexpr int parts = 200;
    double y = 0;
    for (int i = 0; i < parts; ++i) y += Y / parts * (1 + 0.5 * (strain(Y * i / parts) + strain(Y * (i + 1) / parts)));
    return y;
  }

 private:
  Hydrostatic law_;
  double weight_, load_;
};

/// The motion of the piston, times in exact periods of the mass ratio m_fluid/m_piston. Set 1 is
/// the piston.
Swing ride(Trial& t, double ratio, double kh, double calm = 2, double swings = 2.1, double density_factor = 1) {
  const double density = area_density / ratio / thickness * density_factor, sound = 60;
  ValidationRun<float> run(t, "piston",
                           {fmt::format("materials.box.density={:.17g}", density),
                            fmt::format("materials.box.youngs_modulus={:.17g}", density * sound * sound)});
  const double omega = kh * c / height, period = 2 * std::numbers::pi / omega;
  const Loaded rest(run.world.sets[0].values, density * thickness * g);
  const double sunk = height - rest.pressed(height);
  std::vector<float> strains;  // by id
  for (auto& set : run.seeds)
    for (ParticleSeed& n : set) {
      const double Y = n.position.y;
      n.position.y = Y < height ? rest.pressed(Y) : Y - sunk;
      if (strains.size() <= n.id) strains.resize(n.id + 1);
      strains[n.id] = static_cast<float>(rest.strain(Y));
    }
  run.begin();
  auto& e = state_column(run.world.sets[0], "e");
  for (std::size_t p = 0; p < e.size(); ++p) e[p] = strains[ParticleSetView<float>(run.world, 0).id(p)];
  const std::vector<ParticleSeed> piston = run.seeds[1];
  // To rest: what meets at the interface settles by a part of a cell.
  run.world.settings.damping = omega;
  run.until(calm * period);
  run.world.settings.damping = 0;
  run.world.gravity.y = -0.7 * g;
  const double start = run.world.time;
  std::vector<double> time, height_of_piston;
  run.until(start + swings * period, [&](const StepSums&) {
    if (run.world.step % 8) return;
    const auto x = positions_by_id(run.world);
    double q = 0;
    for (const ParticleSeed& n : piston) q += (x[n.id].y - n.position.y) / static_cast<double>(piston.size());
    time.push_back((run.world.time - start) / period), height_of_piston.push_back(q);
  });
  // About the middle of its swing, in units of half of it.
  const auto [low, high] = std::minmax_element(height_of_piston.begin(), height_of_piston.end());
  Swing swing;
  for (std::size_t i = 0; i < time.size(); ++i)
    swing.add(time[i], (height_of_piston[i] - (*low + *high) / 2) / ((*high - *low) / 2));
  return swing;
}

/// The highest place between two times.
double crest(const Swing& swing, double from, double to) {
  double highest = -1e30;
  for (std::size_t i = 0; i < swing.times.size(); ++i)
    if (swing.times[i] >= from && swing.times[i] < to) highest = std::max(highest, swing.values[i]);
  return highest;
}

void run(Trial& t) {
  t.note_choice(
      "The liquid has p = K (1 - J) (gamma: linear), may pull and is not relaxed, as the reference says. The rigid "
      "mass is a stiff elastic box; 1.5 m/s^2 of gravity keep both together, and 30 % less of it starts the motion.");
  const Table exact = reference_table("piston_on_compressible_column.csv");
  Plot plot{
      "piston", "A piston on a compressible column", "time / exact period", "displacement / half of its range", {}};
  for (std::size_t row = 0; row < exact.size(); ++row) {
    const double ratio = exact.number(row, "mfluid_over_mpiston"), kh = exact.number(row, "kH");
    if (ratio != 1 && !t.full()) continue;
    const Swing swing = ride(t, ratio, kh);
    const std::string name = fmt::format("mass ratio {:.4g}: error of the period", ratio);
    t.at_most(name, std::abs(swing.period() - 1), 0.01, "%");
    plot.curves.push_back({fmt::format("m_fluid/m_piston = {:.4g}", ratio), swing.times, swing.values});
    // It sinks into the liquid on the whole while it swings, as what meets at the interface goes on
    // settling.
    t.report(fmt::format("mass ratio {:.4g}: its second crest under the first, of the amplitude", ratio),
             crest(swing, 0, 1) - crest(swing, 1, 2));
    t.control("a piston 10 % too heavy", name, std::abs(ride(t, ratio, kh, 1, 1.1, 1.1).period() - 1));
  }
  Curve cosine{"exact", {}, {}, true};
  for (double s = 0; s < 2; s += 0.05) cosine.x.push_back(s), cosine.y.push_back(-std::cos(2 * std::numbers::pi * s));
  plot.curves.push_back(std::move(cosine));
  t.plot(std::move(plot));
}

}  // namespace
}  // namespace piston_case

extern const Case piston;
const Case piston{"piston",
                  "a heavy box rides on a compressible column: the period of its bouncing",
                  "linear acoustics, exact: piston_on_compressible_column.csv",
                  true,
                  piston_case::run,
                  22,
                  130};

}  // namespace dreampm::validate::cases

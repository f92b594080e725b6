// A rigid mass on a compressible column: kH tan(kH) = m_fluid/m_piston, omega = (kH) c/H. The mass is a stiff elastic
// box, whose own sound takes a hundredth of a period to cross it.
#include <numbers>

#include "dreampm/validate/measure/fit.h"
#include "dreampm/validate/measure/motion.h"
#include "dreampm/validate/run.h"

namespace dreampm::validate::cases {
namespace {

constexpr double height = 0.5, c = 10, area_density = 1000 * height, thickness = 0.125;

/// The motion of the piston, times in exact periods of the mass ratio m_fluid/m_piston. Set 1 is the piston.
Swing ride(Trial& t, double ratio, double kh, double density_factor = 1) {
  const double density = area_density / ratio / thickness * density_factor, sound = 60;
  Run<float> run(t, "piston",
                 {fmt::format("materials.box.density={:.17g}", density),
                  fmt::format("materials.box.youngs_modulus={:.17g}", density * sound * sound)});
  const double omega = kh * c / height, period = 2 * std::numbers::pi / omega, amplitude = 0.003;
  const double k = kh / height;
  const Field mode = [&](const Vec3d& p) { return Vec3d{0, p.y < height ? std::sin(k * p.y) / std::sin(kh) : 1.0, 0}; };
  for (auto& set : run.newborns)
    for (Newborn& n : set) set_motion(n, [&](const Vec3d& p) { return mode(p) * (amplitude * omega); }, 1e-5);
  run.begin();
  const std::vector<Newborn> piston = run.newborns[1];
  Swing swing;
  swing.add(0, 0);
  run.until(2.1 * period, [&](const StepReport&) {
    const auto x = positions_by_id(run.world);
    double q = 0;
    for (const Newborn& n : piston) q += (x[n.id].y - n.position.y) / (amplitude * static_cast<double>(piston.size()));
    swing.add(run.world.time / period, q);
  });
  return swing;
}

void run(Trial& t) {
  const Table exact = reference_table("piston_on_compressible_column.csv");
  Plot plot{"piston", "A piston on a compressible column", "time / exact period", "displacement / amplitude", {}};
  for (std::size_t row = 0; row < exact.size(); ++row) {
    const double ratio = exact.number(row, "mfluid_over_mpiston"), kh = exact.number(row, "kH");
    if (ratio != 1 && ratio != 4 && !t.full()) continue;
    const Swing swing = ride(t, ratio, kh);
    const std::string name = fmt::format("mass ratio {:.4g}: error of the period", ratio);
    t.at_most(name, std::abs(swing.period() - 1), 0.01, "%");
    plot.curves.push_back({fmt::format("m_fluid/m_piston = {:.4g}", ratio), swing.times, swing.values});
    if (ratio == 1) t.control("a piston 10 % too heavy", name, std::abs(ride(t, ratio, kh, 1.1).period() - 1));
  }
  Curve cosine{"exact", {}, {}, true};
  for (double s = 0; s < 2; s += 0.05) cosine.x.push_back(s), cosine.y.push_back(std::sin(2 * std::numbers::pi * s));
  plot.curves.push_back(std::move(cosine));
  t.plot(std::move(plot));
}

}  // namespace

extern const Case piston;
const Case piston{"piston", "a heavy box rides on a compressible column: the period of its bouncing",
                  "linear acoustics, exact: piston_on_compressible_column.csv", true, run};

}  // namespace dreampm::validate::cases

// The vortex of Taylor and Green in a box without friction: KE ~ exp(-4 pi^2 nu t/s^2).
#include "dreampm/validate/vortex.h"

namespace dreampm::validate::cases {
namespace {

constexpr double sound = 20;  // m/s, in the scene

/// One liquid at rising resolutions; the finest is judged.
struct Study {
  const char* name;
  double nu;  ///< m^2/s, in a box of 1 m and at 1 m/s
  const char* transfer;
  std::vector<int> cells, full;  ///< what a quick run takes, and what --full adds
};

VortexDecay decay_of(Trial& t, const Study& s, int cells, Plot& plot) {
  const VortexDecay v = vortex_decay(t, cells, s.nu, 1, s.transfer);
  t.tell(fmt::format("{}, {} cells: decay rate over the exact one", s.name, cells), v.rate);
  t.tell(fmt::format("{}, {} cells: viscosity of the method itself, nu/(c dx)", s.name, cells),
         v.excess * cells / sound);
  Curve c{fmt::format("{}, {} cells", s.name, cells), v.times, v.log_energy};
  for (double& x : c.x) x *= -v.exact_rate;
  plot.curves.push_back(std::move(c));
  return v;
}

void run(Trial& t) {
  t.chose(
      "Poisson-disk points: a lattice is drawn out into lines by the first turn. Filled 1 % over rest density, or the "
      "liquid, which cannot pull, would cavitate in the core. Speeds of 1 m/s, Mach 0.05; a slab 4 cells thick.");
  // APIC smooths what is short on the grid, by 0.14 (k dx)^2 c dx: at a small viscosity it takes more cells.
  const Study studies[] = {{"Re = 10", 0.1, "apic", {16, 32}, {64}},
                           {"Re = 100", 0.01, "apic", {24, 48}, {64}},
                           {"Re = 100, asflip", 0.01, "asflip", {32}, {}}};
  Plot plot{"taylor-green", "Kinetic energy of a Taylor-Green vortex", "time times the exact rate", "ln(KE/KE0)", {}};
  for (const Study& s : studies) {
    std::vector<int> sizes = s.cells;
    if (t.full()) sizes.insert(sizes.end(), s.full.begin(), s.full.end());
    std::vector<double> cells, errors;
    VortexDecay v;
    for (const int n : sizes) {
      v = decay_of(t, s, n, plot);
      cells.push_back(n), errors.push_back(v.rate - 1);
    }
    const std::string finest = fmt::format("{}, {} cells: ", s.name, sizes.back());
    t.at_most(finest + "error of the decay rate", std::abs(errors.back()), 0.05, "%");
    // Viscosity does nearly all of the slowing, so its account must hold it: the gate is that of the rate.
    t.at_most(finest + "heat of viscosity over kinetic energy lost, minus 1", std::abs(v.heat - 1), 0.05, "%");
    if (sizes.size() > 1) t.at_least(fmt::format("{}: order of the error", s.name), order_of(cells, errors), 1);
    if (s.nu == 0.1)
      t.control("a fifth less viscosity", finest + "error of the decay rate",
                std::abs(vortex_decay(t, sizes.back(), s.nu, 0.8).rate - 1));
  }
  plot.curves.push_back({"exact", {0, 0.25, 0.5, 0.75, 1, 1.25, 1.5}, {0, -0.25, -0.5, -0.75, -1, -1.25, -1.5}, true});
  t.plot(std::move(plot));
}

}  // namespace

extern const Case taylor_green;
const Case taylor_green{"taylor-green",
                        "how fast viscosity slows a vortex in a box without friction",
                        "Navier-Stokes, exact: KE ~ exp(-4 pi^2 nu t/s^2)",
                        true,
                        run,
                        20,
                        67};

}  // namespace dreampm::validate::cases

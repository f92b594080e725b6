// The vortex of Taylor and Green in a box without friction: KE ~ exp(-4 pi^2 nu t/s^2).
#include "dreampm/validate/vortex.h"

namespace dreampm::validate::cases {
namespace {

constexpr double sound = 20;  // m/s, in the scene

const char* const own_viscosity =
    "the method has a viscosity of its own, which falls with the cell's size (told below): from this Reynolds number "
    "on "
    "it outweighs the liquid's at this resolution";

void run(Trial& t) {
  std::vector<int> sizes{16, 32};
  if (t.full()) sizes.push_back(64);
  Plot plot{"taylor-green", "Kinetic energy of a Taylor-Green vortex", "time times the exact rate", "ln(KE/KE0)", {}};
  for (const double nu : {0.1, 0.01}) {
    const double reynolds = 1 / nu;
    std::vector<double> cells, errors;
    VortexDecay v;
    for (const int n : sizes) {
      v = vortex_decay(t, n, nu);
      cells.push_back(n), errors.push_back(v.rate - 1);
      t.tell(fmt::format("Re = {:.0f}, {} cells: decay rate over the exact one", reynolds, n), v.rate);
      t.tell(fmt::format("Re = {:.0f}, {} cells: viscosity of the method itself, nu/(c dx)", reynolds, n),
             v.excess * n / sound);
      Curve c{fmt::format("Re = {:.0f}, {} cells", reynolds, n), v.times, v.log_energy};
      for (double& x : c.x) x *= -v.exact_rate;
      plot.curves.push_back(std::move(c));
    }
    const std::string name = fmt::format("Re = {:.0f}, {} cells: error of the decay rate", reynolds, sizes.back());
    t.at_most(name, std::abs(errors.back()), 0.05, "%").known(own_viscosity, 0.4);
    const std::string heat =
        fmt::format("Re = {:.0f}, {} cells: heat of viscosity over kinetic energy lost", reynolds, sizes.back());
    // Where viscosity does nearly all of the slowing, its account must hold it: the gate is that of the rate.
    if (nu == 0.1)
      t.at_most(heat + ", minus 1", std::abs(v.heat - 1), 0.05, "%");
    else
      t.tell(heat, v.heat);
    t.at_least(fmt::format("Re = {:.0f}: order of the error", reynolds), order_of(cells, errors), 1);
    if (nu == 0.1) t.control("a fifth less viscosity", name, std::abs(vortex_decay(t, sizes.back(), nu, 0.8).rate - 1));
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
                        7};

}  // namespace dreampm::validate::cases

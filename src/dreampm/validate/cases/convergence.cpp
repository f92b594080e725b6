// Orders of convergence: the vortex of Taylor and Green, the wave in a bar, and a manufactured solution for the fixed
// corotated solid after Kamojjala et al. 2015: x = X + A sin(2 pi X) sin(w t), y likewise, held to its course by the
// force b = u'' - dP/dF F'/rho0, which every node gets before each step.
#include <cmath>
#include <numbers>

#include "dreampm/physics/materials/elastic.h"
#include "dreampm/validate/bar.h"
#include "dreampm/validate/measure/motion.h"
#include "dreampm/validate/vortex.h"

namespace dreampm::validate::cases {
namespace {

constexpr double two_pi = 2 * std::numbers::pi, amplitude = 0.05, omega = two_pi * 5, end = 0.1;

/// One axis of the motion.
double place(double X, double t) { return X + amplitude * std::sin(two_pi * X) * std::sin(omega * t); }
double stretch(double X, double t) { return 1 + amplitude * two_pi * std::cos(two_pi * X) * std::sin(omega * t); }
double stretch_slope(double X, double t) {
  return -amplitude * two_pi * two_pi * std::sin(two_pi * X) * std::sin(omega * t);
}
double acceleration(double X, double t) {
  return -omega * omega * amplitude * std::sin(two_pi * X) * std::sin(omega * t);
}
/// Where what is at x now came from, by Newton's method; stretches stay above 0.68.
double origin_of(double x, double t) {
  double X = x;
  for (int i = 0; i < 8; ++i) X -= (place(X, t) - x) / stretch(X, t);
  return X;
}

/// dP_xx/dF_xx of the law at F = diag(a, b, 1) [Pa], by central differences: P = tau F^-T.
double stiffness(const Elastic::Law<double>& law, double a, double b) {
  const auto stress = [&](double f) {
    Elastic::State<double> s{Mat3d::diagonal(f, b, 1)};
    return law.respond(s).tau.xx / f;
  };
  constexpr double h = 1e-5;
  return (stress(a + h) - stress(a - h)) / (2 * h);
}

/// The largest rms distance from the exact motion over the run, relative to the amplitude.
double manufactured_error(Trial& t, int cells, bool forced = true) {
  const double dx = 1.0 / cells;
  Run<float> run(t, "manufactured",
                 {fmt::format("space.spacing={:.17g}", dx / 2), fmt::format("space.max=[1,1,{:.17g}]", 4 * dx),
                  fmt::format("bodies.slab.shape={{box: {{min: [0,0,0], max: [1,1,{:.17g}]}}}}", 4 * dx)});
  const auto law = Elastic::Law<double>::from(run.world.sets[0].values);
  const double density = run.world.sets[0].values["density"];
  for (Newborn& n : run.newborns[0])
    set_motion(
        n,
        [](const Vec3d& p) { return Vec3d{std::sin(two_pi * p.x), std::sin(two_pi * p.y), 0} * (amplitude * omega); },
        1e-5);
  const auto newborns = run.all_newborns();
  run.begin();
  World<float>& w = run.world;
  double worst = 0;
  while (w.time < end) {
    const double now = w.time, dt = w.dt_next;
    for (std::size_t b = 0; forced && b < w.grid.blocks.size(); ++b)
      for (int n = 0; n < block_nodes; ++n) {
        Node<float>& node = w.grid.nodes[b * block_nodes + static_cast<std::size_t>(n)];
        if (!(node.m > 0)) continue;
        const Vec3i at = w.grid.blocks[b] * block_width + Vec3i{n / 16, n / 4 % 4, n % 4};
        // Nodes behind a wall stand for their images in it.
        const double x = std::clamp((at.x - w.low.x) * dx, 0.0, 1.0), y = std::clamp((at.y - w.low.y) * dx, 0.0, 1.0);
        const double X = origin_of(x, now), Y = origin_of(y, now), fx = stretch(X, now), fy = stretch(Y, now);
        const double kick = dt * static_cast<double>(node.m);
        node.x += static_cast<float>(kick *
                                     (acceleration(X, now) - stiffness(law, fx, fy) * stretch_slope(X, now) / density));
        node.y += static_cast<float>(kick *
                                     (acceleration(Y, now) - stiffness(law, fy, fx) * stretch_slope(Y, now) / density));
      }
    if (!run.step().frame_done) continue;
    const auto x = positions_by_id(w);
    double sum = 0;
    for (const Newborn& n : newborns)
      sum +=
          std::pow(x[n.id].x - place(n.position.x, w.time), 2) + std::pow(x[n.id].y - place(n.position.y, w.time), 2);
    worst = std::max(worst, std::sqrt(sum / static_cast<double>(newborns.size())) / amplitude);
  }
  return worst;
}

Curve in_logs(std::string name, const std::vector<double>& cells, const std::vector<double>& errors) {
  Curve c{std::move(name), {}, {}};
  for (std::size_t i = 0; i < cells.size(); ++i)
    c.x.push_back(std::log2(cells[i])), c.y.push_back(std::log10(std::abs(errors[i])));
  return c;
}

void run(Trial& t) {
  Plot plot{"convergence", "Errors by resolution", "log2 of cells a side", "log10 of the relative error", {}};
  const auto study = [&](const std::string& name, std::vector<double> cells, auto&& error) {
    std::vector<double> errors;
    for (const double n : cells) {
      errors.push_back(std::abs(error(static_cast<int>(n))));
      t.tell(fmt::format("{}, {:.0f} cells: relative error", name, n), errors.back(), "%");
    }
    t.at_least(name + ": order", order_of(cells, errors), 1);
    plot.curves.push_back(in_logs(name, cells, errors));
  };
  std::vector<double> vortex{16, 32}, bar{32, 64}, slab{8, 16, 32};
  if (t.full()) vortex.push_back(64), bar.push_back(128), slab.push_back(64);
  study("Taylor-Green, Re = 10, decay rate", vortex, [&](int n) { return vortex_decay(t, n, 0.1).rate - 1; });
  study("bar wave, elastic, period", bar, [&](int n) { return ring_bar(t, "bar-wave-elastic", n).period - 1; });
  study("manufactured solution, position", slab, [&](int n) { return manufactured_error(t, n); });
  // Without its force the slab swings on its own, at another frequency, and no resolution helps.
  t.control("the manufactured solution without its force", "manufactured solution, position: order",
            order_of({8, 16}, {manufactured_error(t, 8, false), manufactured_error(t, 16, false)}));
  t.plot(std::move(plot));
}

}  // namespace

extern const Case convergence;
const Case convergence{"convergence",
                       "orders of convergence of a vortex, a wave and a manufactured solution",
                       "exact solutions; Kamojjala et al. 2015, Engineering with Computers 31:475",
                       false,
                       run,
                       62,
                       62};

}  // namespace dreampm::validate::cases

// Martin and Moyce's falling columns of water: the front along the floor and the height at the
// wall.
#include <cmath>

#include "validate/measure/front.h"
#include "validate/measure/hydrostatic.h"
#include "validate/validation_run.h"

namespace dreampm::validate::cases {
namespace dam_break_case {
namespace {

constexpr double g = 9.81, a = 0.05715;

/// The fall of a column in the experiment's units: T = n t sqrt(g/a), Z = x/a; tau = t sqrt(g/a), H
/// = h/(n^2 a).
struct Fall {
  std::vector<double> front_time, front, height_time, height;
};

Fall fall(Trial& t, int n2, int cells, double end, const std::vector<std::string>& overrides = {}) {
  const double dx = a / cells;
  const auto box = [&](double x, double y) { return fmt::format("[{:.17g},{:.17g},{:.17g}]", x, y, 4 * dx); };
  std::vector<std::string> all = overrides;
  all.push_back(fmt::format("space.spacing={:.17g}", dx / 2));
  all.push_back("space.max=" + box((n2 == 1 ? 9 : 16) * a, 1.5 * n2 * a));
  all.push_back("bodies.column.shape={box: {min: [0,0,0], max: " + box(a, n2 * a) + "}}");
  ValidationRun<float> run(t, fmt::format("dam-break-{}", n2), all);
  // The diaphragm holds a column at rest: pressed by its own weight.
  const Hydrostatic rest(run.world.sets[0].values, g, n2 * a);
  if (run.compresses()) rest.move(run.seeds[0]);
  run.begin();
  if (run.compresses()) rest.press(run.world);
  const double unit = std::sqrt(g / a), n = std::sqrt(static_cast<double>(n2));
  Front front(a);
  Fall f;
  f.height_time.push_back(0), f.height.push_back(1);
  run.until(end / (n * unit), [&](const StepSums& r) {
    front.add(run.world);
    if (!r.frame_done) return;
    f.height_time.push_back(run.world.time * unit);
    f.height.push_back(surface_height(run.world, 0, 2) / (n2 * a));
  });
  for (std::size_t i = 0; i < front.times.size(); ++i)
    f.front_time.push_back(front.times[i] * unit * n), f.front.push_back(front.places[i] / a);
  return f;
}

/// Root mean square of relative errors of the front, ours read `shift` earlier.
double front_error(const Fall& f, const Table& rows, double shift) {
  double sum = 0;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const double z = interpolate(f.front_time, f.front, rows.number(r, "x") - shift);
    sum += std::pow(z / rows.number(r, "y") - 1, 2);
  }
  return std::sqrt(sum / static_cast<double>(rows.size()));
}

double best_shift(const Fall& f, const Table& rows) {
  double best = 0;
  for (int i = -30; i <= 30; ++i)
    if (front_error(f, rows, 0.01 * i) < front_error(f, rows, best)) best = 0.01 * i;
  return best;
}

double height_error(const Fall& f, const Table& rows) {
  double worst = 0;
  for (std::size_t r = 0; r < rows.size(); ++r)
    if (rows.number(r, "x") <= 2.45)
      worst =
          std::max(worst, std::abs(interpolate(f.height_time, f.height, rows.number(r, "x")) - rows.number(r, "y")));
  return worst;
}

std::string at(int n2, int cells) { return fmt::format("n^2 = {}, a/{}: ", n2, cells); }
const char *const rms = "rms error of the front, best shift", *const high = "worst error of H for tau <= 2.45";

/// The part of the experiment with which a column is compared. Fronts are published as a table (n^2
/// = 2) or read from its plot (n^2 = 1).
struct Measured {
  Table heights, fronts, table;
  double end;  ///< of T
  explicit Measured(int n2)
      : Measured(
            reference_table("martin_moyce_1952.csv").where("base", "a=2.25in").where("case", fmt::format("n2={}", n2)),
            n2) {}

 private:
  Measured(const Table& mine, int n2)
      : heights(mine.where("quantity", "height")),
        fronts(mine.where("quantity", "front")),
        table(n2 == 1 ? fronts : fronts.where("where", "MM Table 2 (transcribed)")),
        end(0.35 + (n2 == 1 ? 3.32 : 9.237)) {}
};

Plot plot_of(int n2, const std::string& by) {
  return {fmt::format("dam-break{}-{}", by.empty() ? "" : "-projection", n2),
          fmt::format("Martin and Moyce's dam break, n^2 = {}{}", n2, by),
          "T = n t sqrt(g/a), tau = t sqrt(g/a)",
          "front Z = x/a, height H = h/(n^2 a)",
          {}};
}

void add_experiment(Plot& plot, const Measured& measured) {
  plot.curves.push_back({"experiment, front", measured.fronts.numbers("x"), measured.fronts.numbers("y"), true});
  plot.curves.push_back({"experiment, height", measured.heights.numbers("x"), measured.heights.numbers("y"), true});
}

void run_projection(Trial& t) {
  constexpr int draws = 5;
  const std::string mean = fmt::format(", mean of {} draws", draws);
  t.note_choice(
      "Walls as in dam-break; 200 frames a second, which steps end at. The front is where a slab is half full: by the "
      "places of jittered particles its error of n^2 = 1 differs by half a per cent from draw to draw.");
  const auto by = [](std::vector<std::string> more = {}) {
    more.insert(more.end(), {"time.solver=projection", "time.fps=200"});
    return more;
  };
  for (const int n2 : {1, 2}) {
    const Measured measured(n2);
    Plot plot = plot_of(n2, ", by the projection");
    std::vector<int> sizes{16};
    if (t.full()) sizes.push_back(32);
    for (const int cells : sizes) {
      const std::string name = at(n2, cells);
      std::vector<double> best, unshifted, shifts, worst;
      Fall f;
      for (int draw = 1; draw <= draws; ++draw) {
        f = fall(t, n2, cells, measured.end, by({fmt::format("seed={}", draw)}));
        shifts.push_back(best_shift(f, measured.table));
        best.push_back(front_error(f, measured.table, shifts.back()));
        unshifted.push_back(front_error(f, measured.table, 0));
        worst.push_back(height_error(f, measured.heights));
      }
      Metric& front = t.at_most(name + rms + mean, mean_of(best).mean, 0.05, "%");
      if (n2 == 1 && cells == 32)
        front.known(
            "The front begins a fifth of a unit of T later than the experiment's, as it does at a/16, and is nearly as "
            "far ahead in the end; not understood.",
            0.054);
      t.report(name + "its standard error", mean_of(best).uncertainty, "%");
      t.report(name + "that shift of T" + mean, mean_of(shifts).mean);
      t.report(name + "rms error of the front, unshifted" + mean, mean_of(unshifted).mean, "%");
      if (cells == 16)
        t.at_most(name + high + mean, mean_of(worst).mean, 0.07);
      else
        t.report(name + high + mean, mean_of(worst).mean);
      plot.curves.push_back({fmt::format("front, a/{}", cells), f.front_time, f.front});
      plot.curves.push_back({fmt::format("height, a/{}", cells), f.height_time, f.height});
    }
    const Fall wrong = fall(t, n2, 16, measured.end, by({"materials.water.viscosity=10"}));
    for (const int cells : sizes)
      t.control("honey for water, a/16", at(n2, cells) + rms + mean,
                front_error(wrong, measured.table, best_shift(wrong, measured.table)));
    t.control("honey for water, a/16", at(n2, 16) + high + mean, height_error(wrong, measured.heights));
    add_experiment(plot, measured);
    t.plot(std::move(plot));
  }
}

void run(Trial& t) {
  t.note_choice(
      "Floor and back wall slip and have the skin friction of a smooth wall, and particles are jittered, both since "
      "commit c4adf5d. Before, the floor stuck, the back wall slipped, and particles lay on a lattice. Without skin "
      "friction n^2 = 1 runs too fast and misses its gate at a/16 (reported below with --full).");
  t.note_choice("Hydrostatic pressure at the start, as the diaphragm holds the column.");
  for (const int n2 : {1, 2}) {
    // The long series of n^2 = 2 read from figure 3 is reported too.
    const Measured measured(n2);
    const auto& [heights, fronts, table, end] = measured;
    Plot plot = plot_of(n2, "");
    std::vector<int> sizes{16};
    if (t.full()) sizes.push_back(32);
    for (const int cells : sizes) {
      const Fall f = fall(t, n2, cells, end);
      const std::string name = at(n2, cells);
      const double shift = best_shift(f, table);
      t.at_most(name + rms, front_error(f, table, shift), 0.05, "%");
      t.report(name + "that shift of T", shift);
      t.report(name + "rms error of the front, unshifted", front_error(f, table, 0), "%");
      if (n2 == 2)
        t.report(name + "the same with all points read from figure 3, best shift",
                 front_error(f, fronts, best_shift(f, fronts)), "%");
      if (cells == 16)
        t.at_most(name + high, height_error(f, heights), 0.07);
      else
        t.report(name + high, height_error(f, heights));
      plot.curves.push_back({fmt::format("front, a/{}", cells), f.front_time, f.front});
      plot.curves.push_back({fmt::format("height, a/{}", cells), f.height_time, f.height});
      if (cells == 16 && t.full()) {
        // Skin friction of the floor and of the wall behind matters: without it a column runs too
        // fast at any resolution.
        const Fall smooth =
            fall(t, n2, cells, end, {"space.walls.floor.skin_friction=false", "space.walls.x_min.skin_friction=false"});
        t.report(name + "the same without skin friction", front_error(smooth, table, best_shift(smooth, table)), "%");
      }
    }
    const Fall wrong = fall(t, n2, 16, end, {"materials.water.viscosity=10"});
    for (const int cells : sizes)
      t.control("honey for water, a/16", at(n2, cells) + rms, front_error(wrong, table, best_shift(wrong, table)));
    t.control("honey for water, a/16", at(n2, 16) + high, height_error(wrong, heights));
    add_experiment(plot, measured);
    t.plot(std::move(plot));
  }
}

}  // namespace
}  // namespace dam_break_case

extern const Case dam_break;
const Case dam_break{"dam-break",
                     "the front and the height of falling columns of water, n^2 = 1 and 2",
                     "Martin & Moyce 1952, Phil. Trans. R. Soc. A 244:312, experiment",
                     true,
                     dam_break_case::run,
                     17,
                     120};

extern const Case dam_break_projection;
const Case dam_break_projection{"dam-break-projection",
                                "the front and the height of falling columns of water by the projection",
                                "Martin & Moyce 1952, Phil. Trans. R. Soc. A 244:312, experiment",
                                true,
                                dam_break_case::run_projection,
                                8};

}  // namespace dreampm::validate::cases

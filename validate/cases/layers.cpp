// Two liquids of different densities, the lighter one above: each keeps its volume and its place.
#include <algorithm>
#include <array>

#include "validate/measure/density.h"
#include "validate/validation_run.h"

namespace dreampm::validate::cases {
namespace layers_case {
namespace {

constexpr int layer = 6, depth = 2 * layer;         // cells
constexpr int first_row = 2, last_row = depth - 2;  // of nodes

struct Left {
  double sunk = 0, strayed = 0;
  std::vector<double> rows;  // of nodes, without those beside floor and surface
};

/// Returns the state after `time` [s].
Left leave(Trial& t, double time, const std::vector<std::string>& overrides = {}) {
  ValidationRun<float> run(t, "layers", overrides);
  run.begin();
  const World<float>& w = run.world;
  const double start = mean_position(w).y;
  run.until(time);
  Left left;
  left.sunk = 1 - mean_position(w).y / start;
  left.rows = node_rows(w, first_row, last_row);
  each_particle(w, [&](std::size_t set, std::size_t, const Vec3d& at) {
    const double y = (at.y - w.origin.y) / w.dx, beyond = set == 0 ? y - layer : layer - y;
    left.strayed += (beyond > 1) / static_cast<double>(w.particles());
  });
  return left;
}

Curve profile(std::string name, const Left& left) {
  Curve c{std::move(name), {}, left.rows};
  for (std::size_t r = 0; r < left.rows.size(); ++r) c.x.push_back(static_cast<double>(r) + first_row);
  return c;
}

void run(Trial& t) {
  t.note_choice("As a scene gets it that asks for nothing more: jittered, and not pressed at the start.");
  t.note_choice(
      "Their densities are measured by volume. When the grid knew only the mass of both, a liquid of 200 kg/m^3 on "
      "water rose by 9 % of the depth in 5 s, and rows beside the border were off by 8 %.");
  const double time = t.full() ? 60 : 10;
  struct Pair {
    const char* name;
    std::vector<std::string> overrides;
  };
  const std::array<Pair, 2> pairs{{{"a tenth of water's density", {}},
                                   {"oil", {"materials.light.density=914", "materials.light.viscosity=0.084"}}}};
  const auto row = [](const Pair& p) { return std::string(p.name) + ": matter of rows of nodes, farthest off"; };
  const auto sunk = [](const Pair& p) { return std::string(p.name) + ": the center of volume moved, of its height"; };
  const auto strayed = [](const Pair& p) { return std::string(p.name) + ": particles over a cell beyond the border"; };
  Plot plot{"layers",
            fmt::format("A light liquid on water, left alone for {:.0f} s", time),
            "height over the floor  [cells]",
            "matter of a row of nodes / that of a full one",
            {}};
  for (const Pair& p : pairs) {
    const Left left = leave(t, time, p.overrides);
    t.at_most(row(p), farthest_off(left.rows), 0.02, "%");
    t.at_most(sunk(p), std::abs(left.sunk), 0.01, "%");
    t.at_most(strayed(p), left.strayed, 0.001, "%");
    plot.curves.push_back(profile(p.name, left));
  }
  for (const Pair& p : pairs) {
    const auto wrong = [&](double until, std::vector<std::string> how) {
      how.insert(how.begin(), p.overrides.begin(), p.overrides.end());
      return leave(t, until, how);
    };
    const Left pulls = wrong(20, {"materials.water.tension=true", "materials.light.tension=true"});
    t.control("liquids that pull, 20 s", row(p), farthest_off(pulls.rows));
    t.control("water with a sound of 4 m/s, 5 s", sunk(p),
              std::abs(wrong(5, {"materials.water.bulk_modulus=1.6e4"}).sunk));
    t.control("the lighter one below, 1 s", strayed(p),
              wrong(1, {"bodies.water.material=light", "bodies.light.material=water"}).strayed);
    if (&p == &pairs[0]) plot.curves.push_back(profile("control: liquids that pull, after 20 s", pulls));
  }
  plot.curves.insert(plot.curves.end(),
                     {level("full", 0, depth, 1), level("gates", 0, depth, 1.02), level("", 0, depth, 0.98)});
  t.plot(std::move(plot));
}

}  // namespace
}  // namespace layers_case

extern const Case layers;
const Case layers{"layers",
                  "two liquids of different densities, the lighter above, stay where they lie",
                  "layers at rest stay at rest, each with its volume",
                  false,
                  layers_case::run,
                  30,
                  90};

}  // namespace dreampm::validate::cases

// Random scenes run for some hundred steps: numbers stay numbers, nothing is lost, and steps do not
// shrink.
#include <algorithm>
#include <cmath>
#include <mutex>

#include "dreampm/base/parallel.h"
#include "validate/measure/particles.h"
#include "validate/random_scene.h"
#include "validate/validation_run.h"

namespace dreampm::validate::cases {
namespace stability_case {
namespace {

/// Kinetic, over that of the fall and of what gave energy.
constexpr double most_energy = 1;

struct Outcome {
  std::string fault;    ///< empty: a clean draw
  double shortest = 0;  ///< step over its floor
  double kinetic = 0;   ///< largest kinetic energy over that of the fall
  double energy = 0;    ///< the same over that of the fall and of what gave energy
  double given = 0;     ///< by volume relaxation: energy over it
  double hardened = 0;  ///< by hardening
  double carried = 0;   ///< by the transfer, at most
  std::string scene;
  std::uint64_t particle_steps = 0;
};

/// Returns the fault of the world, which began with `particles` particles; empty if there is none.
std::string fault_of(const World<float>& w, std::size_t particles) {
  if (w.particles() + w.left != particles)
    return fmt::format("{} particles are in the scene and {} left it, of {}", w.particles(), w.left, particles);
  std::size_t strange = 0, outside = 0;
  const Vec3d high = w.origin + static_cast<Vec3d>(w.high - w.low) * w.dx;
  each_particle(w, [&](std::size_t s, std::size_t p, const Vec3d& at) {
    bool finite = true;
    for (int a = 0; a < 3; ++a) finite = finite && std::isfinite(at[a]);
    const ParticleSetView<float> set(w, s);
    for (std::size_t c = 0; c < set.columns(); ++c) finite = finite && std::isfinite(set.column(c)[p]);
    strange += !finite;
    bool inside = true;
    for (int a = 0; a < 3; ++a) {
      const auto side = static_cast<std::size_t>(2 * a);
      inside = inside && (w.walls[side].type == WallType::open || at[a] >= w.origin[a] - 1e-5 * w.dx) &&
               (w.walls[side + 1].type == WallType::open || at[a] <= high[a] + 1e-5 * w.dx);
    }
    outside += finite && !inside;
  });
  if (strange) return fmt::format("{} particles have something that is not a number", strange);
  if (outside) return fmt::format("{} particles are outside of the walls", outside);
  return {};
}

Outcome run_scene(const Options& options, const RandomScene& draw) {
  Outcome o;
  o.scene = draw.text;
  o.shortest = 1e30;
  Trial own(options);
  try {
    ValidationRun<float> run(own, draw.scene);
    run.begin();
    const std::size_t particles = run.world.particles();
    double mass = 0;
    for (const auto& set : run.world.sets) mass += set.mass * static_cast<double>(set.size());
    const double start = mass, energy = mass * draw.fall * draw.fall / 2;
    // Energy from laws so far: from volume relaxation, and from hardening, which makes the same
    // strain store more; and from transfers, in sum.
    double relaxed = 0, hardened = 0, transferred = 0;
    Motion<float> motion;
    for (int n = 1; n <= random_scene_steps && o.fault.empty() && run.world.particles() > 0; ++n) {
      const StepSums r = run.step(&motion, 0);
      const Balance b = balance(run.world, motion);
      relaxed -= std::min(0.0, r.pass.energy.relaxed), hardened -= std::min(0.0, r.pass.energy.plastic);
      transferred -= r.transfer;
      const double carried = std::max(0.0, transferred);
      o.shortest = std::min(o.shortest, r.dt / draw.dt_floor);
      o.kinetic = std::max(o.kinetic, b.kinetic / energy);
      o.given = relaxed / energy;
      o.hardened = hardened / energy;
      o.carried = std::max(o.carried, carried / energy);
      o.energy = std::max(o.energy, b.kinetic / (energy + relaxed + hardened + carried));
      if (r.dt < draw.dt_floor)
        o.fault = fmt::format("a step of {:.3g} s, under the floor of {:.3g} s", r.dt, draw.dt_floor);
      // Sums over nodes in float.
      else if (!(std::abs(r.grid.mass - mass) < 1e-4 * start))
        o.fault = fmt::format("the grid holds {:.6g} of the mass", r.grid.mass / start);
      else if (n % 50 == 0)
        o.fault = fault_of(run.world, particles);
      mass -= r.left_mass;
      if (!o.fault.empty()) o.fault = fmt::format("step {}: {}", n, o.fault);
    }
  } catch (const RunError& e) {
    o.fault = e.what();
  }
  o.particle_steps = own.particle_steps;
  return o;
}

/// Draws side by side, each on one thread; the outcomes in the draws' order.
std::vector<Outcome> run_scenes(const Options& options, const std::vector<RandomScene>& draws) {
  std::vector<Outcome> all(draws.size());
  parallel_for(draws.size(), 1, [&](std::size_t i) { on_this_thread([&] { all[i] = run_scene(options, draws[i]); }); });
  return all;
}

void run(Trial& t) {
  t.note_choice(
      "Two bodies fall on a floor and on each other: any materials with parameters anywhere in their ranges (but for "
      "seed's legacy, the report's own program, whose hardening has no bound), any transfer, 1 to 64 particles a cell "
      "in any pattern, any walls, one in ten of them open, any cfl that the parser takes (validate/random_scene.h). "
      "Nothing "
      "lost: what is in the scene and what left it are what began.");
  t.note_choice(
      "Energy: known sources are the volume relaxation of liquids, which brings J to a density that 1 to 64 random "
      "particles a "
      "cell read badly (an earlier version once gave a draw 899 times the energy of its fall in one relaxation), "
      "hardening that makes the same strain store more (snow, seed), and asflip, whose affine part can grow beyond the "
      "velocities that it is taken from (docs/theory/step.md, Transfers: --seed 2004 --draw 126).");
  const Options& o = t.options();
  const int count = o.draws > 0 ? o.draws : t.full() ? 200 : 12;
  std::vector<RandomScene> draws;
  if (o.draw >= 0)
    draws.push_back(random_scene(o.seed, o.draw, o.cfl));
  else
    for (int i = 0; i < count; ++i) draws.push_back(random_scene(o.seed, i, o.cfl));
  const auto outcomes = run_scenes(o, draws);
  const std::string at_cfl = o.cfl > 0 ? fmt::format(" at cfl {}", o.cfl) : "";
  int failed = 0;
  double shortest = 1e30, kinetic = 0, energy = 0, given = 0, hardened = 0, carried = 0;
  for (const Outcome& r : outcomes) energy = std::max(energy, r.energy);
  for (std::size_t i = 0; i < draws.size(); ++i) {
    const Outcome& r = outcomes[i];
    t.cost(r.particle_steps);
    shortest = std::min(shortest, r.shortest), kinetic = std::max(kinetic, r.kinetic);
    given = std::max(given, r.given), hardened = std::max(hardened, r.hardened);
    carried = std::max(carried, r.carried);
    failed += !r.fault.empty();
    std::string about = r.fault;
    if (r.energy == energy && energy > most_energy)
      about += fmt::format("{}{:.4g} times the kinetic energy of its fall and of known sources",
                           about.empty() ? "" : "; ", energy);
    if (!about.empty()) t.attach({draws[i].scene.name + ".yaml", about + at_cfl, r.scene});
  }
  const std::string name = fmt::format("draws of seed {}{} that failed, of {}", o.seed, at_cfl, draws.size());
  t.at_most(name, failed, 0);
  t.report("shortest step over its floor", shortest);
  t.report("largest kinetic energy over that of the fall", kinetic);
  t.report("largest energy that volume relaxation gave, over that of the fall", given);
  t.report("largest energy that hardening gave, over that of the fall", hardened);
  t.report("largest energy that transfers gave, over that of the fall", carried);
  const std::string sources = "largest kinetic energy over that of the fall and of known sources";
  t.at_most(sources, energy, most_energy);
  if (draws.size() > 1) {
    const auto sorted = [&](std::string label, double Outcome::* value) {
      Curve c{std::move(label), {}, {}};
      for (const Outcome& r : outcomes) c.y.push_back(r.*value);
      std::sort(c.y.begin(), c.y.end());
      for (std::size_t i = 0; i < c.y.size(); ++i) c.x.push_back(static_cast<double>(i + 1));
      return c;
    };
    const double last = static_cast<double>(draws.size());
    t.plot({"stability",
            "Largest kinetic energy of each of " + std::to_string(draws.size()) + " random scenes",
            "scenes, by their energy",
            "kinetic energy",
            {sorted("over that of the fall and of known sources", &Outcome::energy),
             level("gate", 1, last, most_energy)}});
  }
  // The bound of the step is there for a reason: some of a few scenes must break with six times it.
  std::vector<RandomScene> wrong;
  for (int i = 0; i < 4; ++i) {
    wrong.push_back(random_scene(1, i));
    wrong.back().scene.time.cfl = 3;
  }
  const auto noticed = run_scenes(o, wrong);
  t.control("steps of 3 cells", name,
            static_cast<double>(
                std::count_if(noticed.begin(), noticed.end(), [](const Outcome& r) { return !r.fault.empty(); })));
  std::vector<RandomScene> thrown;
  for (int i = 0; i < 4; ++i) {
    thrown.push_back(random_scene(1, i));
    for (model::Body& body : thrown.back().scene.bodies) body.velocity = body.velocity * 2;
  }
  double loudest = 0;
  for (const Outcome& r : run_scenes(o, thrown)) loudest = std::max(loudest, r.energy);
  t.control("bodies thrown at twice their speed", sources, loudest);
}

void run_playground(Trial& t) {
  t.note_choice(
      "The report's two presets with its sliders by chance: v 0 to 0.7, lower -400 to -100, upper 0 to 100, elastic on "
      "or off, h 0.25 to 4, gravity -10 to 10 m/s^2 along each axis; its grids of 32 and, one in eight, of 64 "
      "(validate/random_scene.h). Its slider Time Step says how much time passes in a drawn frame, and not the step: "
      "that "
      "follows from the state.");
  const Options& o = t.options();
  constexpr int all = 300;
  const int count = o.draws > 0 ? o.draws : t.full() ? all : 24;
  std::vector<RandomScene> draws;
  if (o.draw >= 0)
    draws.push_back(random_report_scene(o.seed, o.draw));
  else
    for (int i = 0; i < count; ++i) draws.push_back(random_report_scene(o.seed, i));
  if (o.cfl > 0)
    for (RandomScene& draw : draws) draw.scene.time.cfl = o.cfl;
  int failed = 0;
  double kinetic = 0, energy = 0, hardened = 0, shortest = 1e30;
  const std::vector<Outcome> outcomes = run_scenes(o, draws);
  for (std::size_t i = 0; i < draws.size(); ++i) {
    const Outcome& r = outcomes[i];
    t.cost(r.particle_steps);
    failed += !r.fault.empty();
    kinetic = std::max(kinetic, r.kinetic), energy = std::max(energy, r.energy);
    hardened = std::max(hardened, r.hardened), shortest = std::min(shortest, r.shortest * draws[i].dt_floor);
    if (!r.fault.empty() || r.energy > most_energy)
      t.attach({draws[i].scene.name + ".yaml", r.fault.empty() ? "energy from nowhere" : r.fault, r.scene});
  }
  const std::string name = fmt::format("draws of seed {} that failed, of {}", o.seed, draws.size());
  t.at_most(name, failed, 0);
  t.report("shortest step", shortest, "s");
  t.report("largest kinetic energy over that of the fall", kinetic);
  t.report("largest energy that hardening gave, over that of the fall", hardened);
  const std::string sources = "largest kinetic energy over that of the fall and of known sources";
  t.at_most(sources, energy, most_energy);
  // Controls: each fault is found.
  std::vector<RandomScene> wrong, thrown;
  for (int i = 0; i < 4; ++i) {
    wrong.push_back(random_report_scene(1, i)), thrown.push_back(random_report_scene(1, i));
    wrong.back().scene.time.cfl = 3;
    for (model::Body& body : thrown.back().scene.bodies) body.velocity = {0, -1.5 * thrown.back().fall, 0};
  }
  const auto noticed = run_scenes(o, wrong), loud = run_scenes(o, thrown);
  t.control("steps of 3 cells", name,
            static_cast<double>(
                std::count_if(noticed.begin(), noticed.end(), [](const Outcome& r) { return !r.fault.empty(); })));
  double loudest = 0;
  for (const Outcome& r : loud) loudest = std::max(loudest, r.energy);
  t.control("bodies thrown at half again the speed of the fall", sources, loudest);
}

}  // namespace
}  // namespace stability_case

extern const Case stability_playground;
const Case stability_playground{
    "stability-playground",
    "the playground's report presets with their sliders by chance: no NaN, nothing lost, no energy from nowhere",
    "conservation of mass and of energy",
    false,
    stability_case::run_playground,
    30,
    290};

extern const Case stability;
const Case stability{
    "stability",
    "scenes by chance: no NaN, nothing lost, no energy from nowhere, no step under its floor (--draws, --seed, --draw, "
    "--cfl)",
    "conservation of mass; of energy, which bounds how fast and how stiff matter can get, and so the step",
    true,
    stability_case::run,
    15,
    35};

}  // namespace dreampm::validate::cases

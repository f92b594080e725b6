// Columns of grains fall down and spread: the final heap against discrete-element runs. The
// friction is not fitted here: it is that with which Lagree et al. 2011 describe both columns by
// the mu(I) law, 0.32 to 0.60 with I0 = 0.4 and the size of their grains.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "validate/measure/fit.h"
#include "validate/measure/particles.h"
#include "validate/validation_run.h"

namespace dreampm::validate::cases {
namespace granular_case {
namespace {

/// Height over x of the right half by volume, in units of H0 = 1 m.
struct Heap {
  std::vector<double> x, h;
  double grain = 0;    ///< diameter: where the heap ends
  double packing = 0;  ///< volume of the grains over that under their surface, for x below 0.4

  /// The farthest place where the height falls through a grain.
  double run_out() const {
    for (std::size_t i = x.size(); i-- > 1;)
      if (h[i - 1] >= grain && h[i] < grain)
        return x[i - 1] + (x[i] - x[i - 1]) * (h[i - 1] - grain) / (h[i - 1] - h[i]);
    return x.empty() ? 0 : x.back();
  }
  double top() const { return *std::max_element(h.begin(), h.end()); }
};

/// The volume of the grains at x < `reach` [m] over that below the highest of them in each slab of
/// one cell.
double packing(const World<float>& world, double reach) {
  const auto& set = world.sets[0];
  std::vector<double> top(static_cast<std::size_t>(reach / world.dx));
  double grains = 0, room = 0;
  each_particle(world, [&](std::size_t, std::size_t, const Vec3d& at) {
    const auto slab = static_cast<std::size_t>(std::max(0.0, at.x / world.dx));
    if (slab >= top.size()) return;
    grains += set.rest_volume;
    top[slab] = std::max(top[slab], at.y + std::cbrt(set.rest_volume) / 2);
  });
  for (const double y : top) room += y * world.dx * world.dx * (world.high.z - world.low.z);
  return grains / room;
}

/// `friction`: an angle [deg] beyond what scenes may ask for; 0: that of the scene.
Heap heap(Trial& t, const std::string& scene, double time, double grain, const std::vector<std::string>& overrides = {},
          double friction = 0) {
  ValidationRun<float> run(t, scene, overrides);
  if (friction > 0) run.world.sets[0].values.set("friction_angle", friction);
  run.begin();
  run.until(time * std::sqrt(1 / 9.81));
  Heap r;
  r.grain = grain;
  const auto volume = slab_volumes(run.world, 0);
  const double area = run.world.dx * run.world.dx * (run.world.high.z - run.world.low.z);
  // Slabs of one cell hold grains very unevenly: their mean over a tenth of H0, mirrored at x = 0.
  const int reach = std::max(1, static_cast<int>(std::lround(0.05 / run.world.dx))),
            n = static_cast<int>(volume.size());
  for (int i = 0; i + reach < n; ++i) {
    double sum = 0;
    for (int j = i - reach; j <= i + reach; ++j) sum += volume[static_cast<std::size_t>(j < 0 ? -j - 1 : j)];
    r.x.push_back((i + 0.5) * run.world.dx), r.h.push_back(sum / (area * (2 * reach + 1)));
  }
  r.packing = packing(run.world, 0.4);
  return r;
}

/// The mean of the left and the right half of a snapshot.
Heap reference(const Table& table, const std::string& snapshot, double grain) {
  const Table rows = table.where("k", snapshot);
  std::vector<std::pair<double, double>> side[2];
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const double x = rows.number(r, "x_over_H0");
    side[x < 0 ? 0 : 1].emplace_back(std::abs(x), rows.number(r, "h_over_H0"));
  }
  std::vector<double> x[2], h[2];
  for (int s = 0; s < 2; ++s) {
    std::sort(side[s].begin(), side[s].end());
    for (const auto& [a, b] : side[s]) x[s].push_back(a), h[s].push_back(b);
    x[s].push_back(x[s].back() + 1e-6), h[s].push_back(0);
  }
  Heap r;
  r.grain = grain;
  for (double at = 0; at < std::max(x[0].back(), x[1].back()) + 0.02; at += 0.02)
    r.x.push_back(at), r.h.push_back((interpolate(x[0], h[0], at) + interpolate(x[1], h[1], at)) / 2);
  return r;
}

/// The mean difference of height over the reference's run-out.
double difference(const Heap& ours, const Heap& theirs) {
  double sum = 0;
  int n = 0;
  for (std::size_t i = 0; i < theirs.x.size() && theirs.x[i] <= theirs.run_out(); ++i, ++n)
    sum += std::abs(interpolate(ours.x, ours.h, theirs.x[i]) - theirs.h[i]);
  return sum / n;
}

struct Column {
  const char *scene, *file, *snapshot, *name;
  double time, grain, run_out, top;  ///< in sqrt(H0/g) and H0; run-out and top as the file's head says
};

void run(Trial& t) {
  t.note_choice(
      "One friction for both columns, stated beforehand: sin phi = 0.32, rising by 0.28 with I0 = 0.4, and the grains' "
      "size, all of Lagree et al. 2011; matched in plane strain. The right half, on a floor that sticks.");
  t.note_choice(
      "The control's mu = 2 is Coulomb's coefficient, tan phi: 63.4 degrees. As the ratio of shear to mean pressure in "
      "the plane, which the 0.32 of Lagree et al. is, mu = sin phi: grains without cohesion have no more than 1.");
  const Column columns[] = {
      {"granular-wide", "granular_contact_dynamics_a0.5.csv", "8", "a = 0.5", 8, 0.005 / 0.149, 3.876, 0.998},
      {"granular-tall", "granular_contact_dynamics_a6.26.csv", "6", "a = 6.26", 6, 0.005 / 0.67, 2.149, 0.203}};
  for (const Column& c : columns) {
    const Heap ours = heap(t, c.scene, c.time, c.grain),
               theirs = reference(reference_table(c.file), c.snapshot, c.grain);
    const std::string name(c.name), run_out = name + ": error of the run-out", height = name + ": error of the height",
                                    room = name + ": grains within 0.4 H0 over the room under their surface",
                                    profile = name + ": mean difference of the profile, of H0";
    const auto run_out_error = [&](const Heap& h) { return std::abs(h.run_out() / c.run_out - 1); };
    const auto height_error = [&](const Heap& h) { return std::abs(h.top() / c.top - 1); };
    t.at_most(run_out, run_out_error(ours), 0.1, "%");
    t.report(name + fmt::format(": run-out, wanted {:.3f}", c.run_out), ours.run_out(), "H0");
    t.at_most(height, height_error(ours), 0.1, "%");
    t.report(name + fmt::format(": height, wanted {:.3f}", c.top), ours.top(), "H0");
    // No reference: matter is not to vanish into itself.
    t.at_most(room, ours.packing, 1.1);
    t.at_most(profile, difference(ours, theirs), 0.1);
    // So steep a heap rests after half the time.
    const Heap steep = heap(t, c.scene, c.time / 2, c.grain, {}, std::atan(2.0) * 180 / std::numbers::pi);
    const bool wide = c.scene == std::string("granular-wide");
    t.control(name + ": mu = 2", run_out, run_out_error(steep));
    t.control(name + ": a hundredth of Young's modulus", room,
              heap(t, c.scene, c.time, c.grain, {"materials.grains.youngs_modulus=2e4"}).packing);
    if (wide) {
      // However steep, the middle of a wide heap stays as high as it was.
      const Heap flat = heap(t, c.scene, c.time / 2, c.grain, {"materials.grains.friction_angle=5"});
      t.control(name + ": a friction angle of 5 degrees", height, height_error(flat));
      t.control(name + ": mu = 2", profile, difference(steep, theirs));
    } else {
      // A tall heap is thin: its profile is off by a tenth of H0 only if the column stands.
      t.control(name + ": mu = 2", height, height_error(steep));
      t.control(name + ": cohesion of 100 kPa", profile,
                difference(heap(t, c.scene, c.time / 3, c.grain, {"materials.grains.cohesion=1e5"}), theirs));
    }
    t.plot({c.scene,
            "A column of grains after its fall, " + name,
            "x / H0",
            "height / H0",
            {{"ours", ours.x, ours.h}, {"discrete elements", theirs.x, theirs.h, true}}});
  }
}

}  // namespace
}  // namespace granular_case

extern const Case granular;
const Case granular{"granular",
                    "the heaps of a wide and of a tall column of grains, one friction for both",
                    "discrete elements, of Lagree, Staron & Popinet 2011, J. Fluid Mech. 686:378",
                    true,
                    granular_case::run,
                    25,
                    20};

}  // namespace dreampm::validate::cases

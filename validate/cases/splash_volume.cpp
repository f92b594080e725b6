// Volume after a splash: matter that has come to rest fills its own volume again: slabs, layers,
// rain on a pool, mud.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "dreampm/math/rng.h"
#include "validate/measure/particles.h"
#include "validate/measure/volume.h"
#include "validate/validation_run.h"

namespace dreampm::validate::cases {
namespace splash_volume_case {
namespace {

constexpr double g = 9.81;
constexpr double settled = 2;  ///< s after the impact, when a volume is judged

/// The falling matter: a slab from wall to wall, or a pool into which drops fall.
struct Fall {
  std::string name;
  double bottom, depth;  ///< m, of the slab or the pool
  int drops = 0;
  double impact() const { return std::sqrt(2 * bottom / g); }  ///< s
};

std::string box_of(const Fall& fall) {
  return fmt::format("bodies.water.shape={{box: {{min: [0, {:.17g}, 0], max: [0.4, {:.17g}, 0.2]}}}}", fall.bottom,
                     fall.bottom + fall.depth);
}

/// Drops of 2 cells in air, apart from each other and above the pool. Returns when the last one
/// arrives [s].
double add_drops(model::Scene& scene, const Fall& fall) {
  constexpr double radius = 0.02;
  constexpr std::uint64_t seed = 1;
  std::uint64_t n = 0;
  const auto between = [&](double low, double high) { return low + (high - low) * uniform(seed, n++); };
  const auto point = [&](const Vec3d& low, const Vec3d& high) {
    const double x = between(low.x, high.x), y = between(low.y, high.y), z = between(low.z, high.z);
    return Vec3d{x, y, z};
  };
  const Vec3d margin{1.5 * radius, 1.5 * radius, 1.5 * radius};
  const Vec3d low = scene.space.min + margin + Vec3d{0, fall.depth, 0}, high = scene.space.end() - margin;
  const model::Body pool = scene.bodies.front();
  std::vector<Vec3d> centers;
  double last = 0;
  while (static_cast<int>(centers.size()) < fall.drops) {
    const Vec3d at = point(low, high), velocity = point({-1, -2, -1}, {1, 0, 1});
    if (std::any_of(centers.begin(), centers.end(), [&](const Vec3d& c) { return length(c - at) < 2.2 * radius; }))
      continue;
    centers.push_back(at);
    model::Body drop = pool;
    drop.name = fmt::format("drop_{}", centers.size());
    drop.shape = {};
    drop.shape.form = SphereShape{radius};
    drop.shape.center = at;
    drop.velocity = velocity;
    scene.bodies.push_back(std::move(drop));
    const double way = at.y - fall.depth;
    last = std::max(last, (velocity.y + std::sqrt(velocity.y * velocity.y + 2 * g * way)) / g);
  }
  return last;
}

struct Course {
  std::vector<double> time, volume;  ///< of frames: s after the impact; over that of the particles at rest
  double astray = 0;                 ///< cells, of a slab's middle from its parabola before the impact
  double off() const { return std::abs(volume.back() - 1); }
};

/// `size`: of particles at rest from the beginning on, over that which they fill.
Course let_fall(Trial& t, const Fall& fall, std::vector<std::string> overrides, double watch = settled,
                double size = 1) {
  overrides.push_back(box_of(fall));
  model::Scene scene = built_in_scene("splash-volume", overrides);
  const double impact = fall.drops ? add_drops(scene, fall) : fall.impact();
  ValidationRun<float> run(t, scene);
  run.begin();
  const double start = mean_position(run.world).y;
  const double rest = static_cast<double>(run.world.particles()) * run.world.sets[0].rest_volume;
  run.world.sets[0].rest_volume *= size, run.world.sets[0].mass *= size;
  Course c;
  run.watch_until(impact + watch, [&] {
    const double now = run.world.time;
    if (!fall.drops && now < impact)
      c.astray = std::abs(mean_position(run.world).y - start + 0.5 * g * now * now) / run.world.dx;
    c.time.push_back(now - impact);
    c.volume.push_back(
        volume_by_columns(positions_by_id(run.world), scene.space.min, scene.space.end(), 2 * run.world.dx) / rest);
  });
  return c;
}

Curve curve_of(const Course& c, std::string name) {
  Curve curve{std::move(name), {}, {}};
  for (std::size_t i = 0; i < c.time.size(); ++i)
    if (c.time[i] > 0) curve.x.push_back(c.time[i]), curve.y.push_back(c.volume[i]);
  return curve;
}

/// The still pool must stay within its own gate all the time, not only in the end.
void still_pool(Trial& t) {
  const Fall pool{"a still pool of 6.5 cells", 0, 0.13};
  constexpr double time = 20;
  const auto farthest = [](const Course& c) {
    double worst = 0;
    for (const double v : c.volume) worst = std::max(worst, std::abs(v - 1));
    return worst;
  };
  for (const std::string transfer : {"apic", "asflip"}) {
    const std::string name = fmt::format("{}, {}: volume within {} s, farthest off", pool.name, transfer, time);
    t.at_most(name, farthest(let_fall(t, pool, {"materials.water.transfer=" + transfer}, time)), 0.01, "%");
    t.control("sound of 4 m/s, 5 s", name, farthest(let_fall(t, pool, {"materials.water.bulk_modulus=1.6e4"}, 5)));
  }
}

void run_projection(Trial& t) {
  t.note_choice("The volume follows from the particles' places, 2 s after the impact, as in splash-volume.");
  std::vector<Fall> falls{{"slab of 2 cells from 0.2 m", 0.2, 0.04},
                          {"layer of 4 cells from 0.5 m", 0.5, 0.08},
                          {"layer of 8 cells from 0.5 m", 0.5, 0.16}};
  const Fall rain{"rain on a pool of 1.5 cells", 0, 0.03, 20};
  falls.push_back(rain);
  // Frames as seldom as a film's: steps are as long as they may be.
  const auto by = [](std::vector<std::string> more = {}) {
    more.push_back("time.fps=24");
    return by_projection("water", more);
  };
  const Course small = let_fall(t, falls.front(), by(), settled, 0.9);
  Plot plot{"splash-volume-projection",
            "What has fallen, and the volume that it takes, by the projection",
            "time after the impact  [s]",
            "volume / volume of the particles",
            {}};
  for (const Fall& fall : falls) {
    const Course c = let_fall(t, fall, by());
    t.at_most(fall.name + ": volume off by", c.off(), 0.03, "%");
    t.control("particles of nine tenths of their volume, slab", fall.name + ": volume off by", small.off());
    if (&fall == &falls[1]) {
      const std::string way = fall.name + ": its middle from the parabola before the impact, in cells";
      t.at_most(way, c.astray, 0.05);
      t.control("gravity 9.6 for 9.81", way, let_fall(t, fall, by({"gravity=[0,-9.6,0]"}), 0).astray);
    }
    plot.curves.push_back(curve_of(c, fall.name));
  }
  plot.curves.push_back(level("its own volume", 0, settled, 1));
  t.plot(std::move(plot));
}

void run(Trial& t) {
  t.note_choice(
      "The volume follows from the particles' places: in each column of 2 x 2 cells twice their mean height over the "
      "floor. The ledger's `volume`, a sum of V0 J, does not see it: water that swells in a splash and forgets its "
      "gaps has J near 1 in all of its particles, and presses as if at rest. So it stayed at 1.5 of its volume when "
      "what a surface reads was not believed, however thin the layer.");
  t.note_choice(
      "The gate is 3 % at 2 s after the impact: a hundredth of it is compression, and the depth of a layer of 2 cells "
      "is known to a few hundredths of a cell. A fall of 0.5 m has thrown the layer apart to several times its volume "
      "half a second after the impact: it has 1 s to come down and as long to be at rest.");
  t.note_choice(
      "The rain is 20 drops of 2 cells, places and speeds drawn from the library's own random numbers with seed 1. Its "
      "impact is that of the last drop.");
  std::vector<Fall> falls{{"slab of 2 cells from 0.2 m", 0.2, 0.04}, {"layer of 4 cells from 0.5 m", 0.5, 0.08}};
  std::vector<std::string> stiff{"0.01"};
  const Fall rain{"rain on a pool of 1.5 cells", 0, 0.03, 20};
  if (t.full()) {
    falls.push_back({"layer of 2 cells from 0.5 m", 0.5, 0.04});
    falls.push_back({"layer of 8 cells from 0.5 m", 0.5, 0.16});
    falls.push_back(rain);
    stiff.push_back("0.005");
  }
  const std::string none = "materials.water.relaxation=0";
  const Course loose = let_fall(t, falls.front(), {none}), loose_rain = t.full() ? let_fall(t, rain, {none}) : loose;
  Plot plot{"splash-volume",
            "What has fallen, and the volume that it takes",
            "time after the impact  [s]",
            "volume / volume at rest",
            {}};
  for (const Fall& fall : falls)
    for (const std::string& compression : stiff)
      for (const std::string transfer : {"apic", "asflip"}) {
        const std::string what = fmt::format("{}, {}, max_compression {}", fall.name, transfer, compression);
        const Course c = let_fall(
            t, fall, {"materials.water.transfer=" + transfer, "materials.water.max_compression=" + compression});
        const std::string metric = what + ": volume off by";
        t.at_most(metric, c.off(), 0.03, "%");
        t.control("no volume relaxation", metric, (fall.drops ? loose_rain : loose).off());
        if (compression == stiff.front()) plot.curves.push_back(curve_of(c, fall.name + ", " + transfer));
      }
  if (t.full()) {
    const std::string mud =
        "materials.water={type: viscoplastic, density: 1500, yield_stress: 5, consistency: 1, max_compression: 0.01}";
    const Course loose_mud = let_fall(t, falls.front(), {mud, none});
    for (const Fall& fall : {falls[0], falls[1]}) {
      const Course c = let_fall(t, fall, {mud});
      const std::string metric = "mud, " + fall.name + ": volume off by";
      t.at_most(metric, c.off(), 0.03, "%");
      t.control("no volume relaxation", metric, loose_mud.off());
      plot.curves.push_back(curve_of(c, "mud, " + fall.name));
    }
    still_pool(t);
  }
  plot.curves.push_back(curve_of(loose, "control: no volume relaxation"));
  plot.curves.push_back(level("its own volume", 0, settled, 1));
  t.plot(std::move(plot));
}

}  // namespace
}  // namespace splash_volume_case

extern const Case splash_volume;
const Case splash_volume{"splash-volume",
                         "water and mud that fell flat fill their own volume again when they have come to rest",
                         "conservation of volume",
                         true,
                         splash_volume_case::run,
                         11,
                         110};

extern const Case splash_volume_projection;
const Case splash_volume_projection{"splash-volume-projection",
                                    "water that fell flat keeps its volume by the projection, and falls as matter does",
                                    "conservation of volume; a fall, exact",
                                    true,
                                    splash_volume_case::run_projection,
                                    3};

}  // namespace dreampm::validate::cases

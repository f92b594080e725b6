// Water at rest beside colliders: it stays outside of them, where it lies, and at rest.
#include <algorithm>
#include <array>
#include <cmath>

#include "validate/measure/density.h"
#include "validate/validation_run.h"

namespace dreampm::validate::cases {
namespace still_shore_case {
namespace {

struct Left {
  double inside = 0;                ///< cells that the deepest particle lies inside
  double moved = 0;                 ///< cells, rms, in the last second
  double sunk = 0;                  ///< of its height
  std::vector<double> time, risen;  ///< s; of its center's height, in thousandths
};

/// Returns the rest of the water after `time` [s]. `shapes`: of the colliders, of this run if there
/// are none yet.
Left leave(Trial& t, double time, std::vector<Collider>& shapes, const std::vector<std::string>& overrides) {
  ValidationRun<float> run(t, "still-shore", overrides);
  if (shapes.empty()) shapes = run.world.colliders;
  run.begin();
  const double start = mean_position(run.world).y;
  Left left;
  const auto look = [&](const StepSums& step) {
    if (!step.frame_done) return;
    left.time.push_back(run.world.time);
    left.risen.push_back(1000 * (mean_position(run.world).y / start - 1));
  };
  run.until(time - 1, look);
  const std::vector<Vec3d> before = positions_by_id(run.world);
  run.until(time, look);
  double moved2 = 0;
  const ParticleSetView<float> water(run.world, 0);
  water.for_each([&](std::size_t p, const Vec3d& at) {
    moved2 += length2(at - before[water.id(p)]);
    for (const Collider& c : shapes) left.inside = std::max(left.inside, -c.distance(at) / run.world.dx);
  });
  left.moved = std::sqrt(moved2 / static_cast<double>(run.world.particles())) / run.world.dx;
  left.sunk = 1 - mean_position(run.world).y / start;
  return left;
}

void run(Trial& t) {
  t.note_choice(
      "No surface lies along the grid: a bank of 28 degrees, a pillar turned by 30 degrees, a ball of 2 cells.");
  t.note_choice(
      "When contact stopped nodes inside of colliders instead, water over such a bank moved at 118 mm/s after 3 s, and "
      "particles lay up to 1.2 cells inside.");
  std::vector<Collider> shapes;
  std::vector<const char*> types{"separate"};
  if (t.full()) types.insert(types.end(), {"slip", "stick"});
  const double time = t.full() ? 10 : 5;
  Plot plot{"still-shore", "Water left alone beside colliders", "time [s]", "rise of its center [thousandths]", {}};
  const auto metrics = [](const std::string& type) {
    return std::array<std::string, 3>{type + ": deepest particle inside, in cells",
                                      type + ": how far particles moved in the last second, rms, in cells",
                                      type + ": its center sank or rose"};
  };
  const auto numbers = [](const Left& left) {
    return std::array<double, 3>{left.inside, left.moved, std::abs(left.sunk)};
  };
  for (const std::string type : types) {
    std::vector<std::string> overrides;
    for (const char* const collider : {"bank", "pillar", "ball"})
      overrides.push_back(fmt::format("colliders.{}.type={}", collider, type));
    const Left left = leave(t, time, shapes, overrides);
    const auto [inside, moved, sunk] = numbers(left);
    plot.curves.push_back({"ours, " + type, left.time, left.risen});
    const auto names = metrics(type);
    t.at_most(names[0], inside, 0.25, "");
    t.at_most(names[1], moved, 0.5, "");
    t.at_most(names[2], sunk, 0.01, "%");
  }
  plot.curves.push_back({"at rest", {0, time}, {0, 0}, true});
  t.plot(std::move(plot));
  const Left gone = leave(t, 1, shapes, {"colliders.ball.shape.center=[0.29,-1,0.24]"}),
             tilted = leave(t, 1, shapes, {"gravity=[1,-9.81,0]"}),
             soft = leave(t, 2, shapes, {"materials.water.bulk_modulus=1.6e4"});
  for (const std::string type : types) {
    t.control("the ball taken away, 1 s", metrics(type)[0], gone.inside);
    t.control("gravity that leans by 6 degrees, 1 s", metrics(type)[1], numbers(tilted)[1]);
    t.control("sound of 4 m/s, 2 s", metrics(type)[2], numbers(soft)[2]);
  }
}

}  // namespace
}  // namespace still_shore_case

extern const Case still_shore;
const Case still_shore{"still-shore",
                       "water at rest beside colliders stays out of them, and at rest",
                       "water at rest stays at rest",
                       true,
                       still_shore_case::run,
                       10,
                       60};

}  // namespace dreampm::validate::cases

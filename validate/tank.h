// A slab of water in a tank, pressed by its own weight, which the cases of the liquid with relaxed
// volume share: cells of 0.02 m unless said otherwise, walls that slip at the sides.
#pragma once
#include <cmath>
#include <numbers>

#include "validate/measure/density.h"
#include "validate/measure/hydrostatic.h"
#include "validate/validation_run.h"

namespace dreampm::validate {

class Tank {
 public:
  static constexpr double g = 9.81;

  /// Acceleration of the shaking, over gravity.
  static constexpr double push = 0.6;
  enum class Motion { small, shaken };
  /// The filling: a slab, or as the overrides give it.
  enum class Filling { slab, given };

  /// `cells` of the tank, of which `depth` are filled. Sound is ten times the largest expected
  /// speed (LIQUID): that of a fall by the depth; in a tank to be shaken, where gravity leans by as
  /// much as `push`, from its one end to the other too.
  Tank(Trial& trial, const Vec3i& cells, int depth, const std::vector<std::string>& overrides = {}, double dx = 0.02,
       Motion motion = Motion::small, Filling filling = Filling::slab)
      : run(trial, "tank", with_size(cells, depth, dx, motion, filling, overrides)),
        height(depth * dx),
        rest(run.world.sets[0].values, g, height) {
    if (run.compresses()) rest.move(run.seeds[0]);
  }
  /// Begins the run, after the seeds were given their motion.
  void begin() {
    run.begin();
    if (run.compresses()) rest.press(run.world);
    start_ = center();
  }
  double center() const { return mean_position(run.world).y; }
  /// Steps until `time` [s], by each frame (1/50 s); returns the mean depth over it against the
  /// start's, minus 1.
  double depth_until(double time) {
    double sum = 0;
    int n = 0;
    run.until(time, [&](const StepSums& r) {
      if (r.frame_done) sum += center(), ++n;
    });
    return sum / n / start_ - 1;
  }
  /// The depth now against the start's, minus 1.
  double depth() const { return center() / start_ - 1; }
  /// Shakes it along x at 0.6 g (push) and its first sloshing frequency until `time` [s], calling
  /// each() once a frame.
  template <class Each>
  void shake(double time, const Each& each) {
    const double length = run.world.dx * (run.world.high.x - run.world.low.x), k = std::numbers::pi / length;
    const double omega = std::sqrt(g * k * std::tanh(k * height));
    while (run.world.time < time) {
      run.world.gravity.x = push * g * std::sin(omega * run.world.time);
      if (run.step().frame_done) each();
    }
    run.world.gravity.x = 0;
  }
  /// Brings it to rest for `calm` [s] under a damping of 10/s, then watches it for `watch` [s]
  /// without: the mean depth against the start's, minus 1.
  double depth_at_rest(double calm, double watch) {
    run.world.settings.damping = 10;
    run.until(run.world.time + calm);
    run.world.settings.damping = 0;
    return depth_until(run.world.time + watch);
  }

  ValidationRun<float> run;
  double height;  ///< m, of the filling before it is pressed
  Hydrostatic rest;

 private:
  static std::vector<std::string> with_size(const Vec3i& cells, int depth, double dx, Motion motion, Filling filling,
                                            std::vector<std::string> all) {
    const double fall = (motion == Motion::shaken ? push * cells.x : 0) + depth;
    all.push_back(fmt::format("space.spacing={:.17g}", dx / 2));
    all.push_back(fmt::format("space.max=[{:.17g},{:.17g},{:.17g}]", cells.x * dx, cells.y * dx, cells.z * dx));
    if (filling == Filling::slab)
      all.push_back(fmt::format("bodies.water.shape={{box: {{min: [0,0,0], max: [{:.17g},{:.17g},{:.17g}]}}}}",
                                cells.x * dx, depth * dx, cells.z * dx));
    all.push_back(fmt::format("materials.water.bulk_modulus={:.17g}", 1e5 * 2 * g * fall * dx));
    return all;
  }
  double start_ = 0;
};

}  // namespace dreampm::validate

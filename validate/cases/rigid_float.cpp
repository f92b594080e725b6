// Rigid boxes float by the projection: their draft, and rest.
#include <algorithm>
#include <cmath>

#include "validate/floater.h"

namespace dreampm::validate::cases {
namespace rigid_float_case {
namespace {

constexpr double height = 0.12, lifted = 0.01, calm = 2, draft_from = 3, draft_to = 4, rest_from = 4, rest_to = 6;

double exact_draft(double density) { return density / Floater::water_density * height; }

FloaterSetUp box_of(double density, double dx) {
  FloaterSetUp s;
  s.projection = true, s.dx = dx, s.density = density, s.below = 0;
  return s;
}

struct Draft {
  double mean = 0;  ///< m, from draft_from to draft_to
  std::vector<double> time, depth;
};

/// A box of that density [kg/m^3], which may only move up and down, let go above the draft of one
/// of `taken_for`.
Draft draft(Trial& t, double density, double dx, double taken_for) {
  FloaterSetUp s = box_of(density, dx);
  s.below = exact_draft(taken_for) - height / 2 - lifted;
  s.extra = ", lock: [x, z, rx, ry, rz]";
  Floater f(t, s);
  f.run.world.settings.damping = 5;
  Draft d;
  int samples = 0;
  f.run.watch_until(draft_to, [&] {
    if (f.run.world.time >= calm) f.run.world.settings.damping = 0;
    d.time.push_back(f.run.world.time), d.depth.push_back(f.draft());
    if (f.run.world.time >= draft_from) d.mean += d.depth.back(), ++samples;
  });
  d.mean /= samples;
  return d;
}

struct Rest {
  double heave = 0, spin = 0;  ///< the largest while it is watched: m/s, 1/s
  std::vector<double> time, speed;
};

Curve curve_of(const Rest& r, std::string name) {
  Curve c{std::move(name), r.time, r.speed};
  for (double& y : c.y) y = std::log10(std::max(y, 1e-9));
  return c;
}

/// A free box of half the water's density, watched from `from` to `end` [s].
Rest rest(Trial& t, const FloaterSetUp& s, double from, double end) {
  Floater f(t, s);
  Rest r;
  f.run.until(end, [&](const StepSums& step) {
    const Twist& twist = f.body().twist;
    if (f.run.world.time >= from) {
      r.heave = std::max(r.heave, std::abs(twist.velocity.y));
      r.spin = std::max(r.spin, length(twist.spin));
    }
    if (step.frame_done) r.time.push_back(f.run.world.time), r.speed.push_back(f.speed());
  });
  return r;
}

std::string draft_of(double density, double dx) {
  return fmt::format("{:.0f} kg/m^3, {:.2g} cells high: error of the draft", density, height / dx);
}
std::string rest_of(const char* what, double dx) {
  return fmt::format("free, {:.2g} cells high: {} from {} to {} s", height / dx, what, rest_from, rest_to);
}

void judge(Trial& t, double dx, Plot& drafts, Plot& speeds) {
  const bool coarse = height / dx < 6;
  for (const double density : {300, 500, 800}) {
    const Draft d = draft(t, density, dx, density);
    const double off = d.mean / exact_draft(density) - 1;
    Metric& error = t.at_most(draft_of(density, dx), std::abs(off), 0.02, "%");
    if (coarse && density == 300)
      error.known("Not explained: let go at its draft, or 1 or 3 cm off it the other way, it is within 1 %.", 0.03);
    t.report("the draft over the exact, minus 1", off, "%");
    drafts.curves.push_back({fmt::format("{:.0f} kg/m^3, {:.2g} cells", density, height / dx), d.time, d.depth});
    if (!coarse) drafts.curves.push_back(level("", 0, draft_to, exact_draft(density)));
  }
  const Rest still = rest(t, box_of(500, dx), rest_from, rest_to);
  t.at_most(rest_of("heave", dx), still.heave, 0.01, "m/s");
  Metric& spin = t.at_most(rest_of("spin", dx), still.spin, 0.1, "1/s");
  if (coarse) spin.known("It turns about the vertical, where nothing holds it; it rocks by 0.03/s.", 0.12);
  speeds.curves.push_back(curve_of(still, fmt::format("at its draft, {:.2g} cells high", height / dx)));
}

void run(Trial& t) {
  t.note_choice(
      "A box of 20 x 12 x 20 cm in a basin of 40 x 40 cm with 20 cm of water. For its draft it may only move up and "
      "down, is let go 1 cm above it, and the water is damped by 5/s for 2 s, so that no waves are left; its mean from "
      "3 to 4 s is judged. The water's level is that of a flat surface around the box, from the mean height of its "
      "particles.");
  t.note_choice("For its rest the box is free, lies at its draft from the start, and nothing is damped.");
  Plot drafts{"rigid-float-projection",
              "Draft of rigid boxes by the projection (dashed: exact)",
              "time  [s]",
              "draft  [m]",
              {}},
      speeds{"rigid-float-projection-rest",
             "Speed of the fastest point of a free box, by the projection",
             "time  [s]",
             "log10 of m/s",
             {}};
  std::vector<double> sizes{0.02};
  if (t.full()) sizes.push_back(0.025);
  for (const double dx : sizes) judge(t, dx, drafts, speeds);
  const double dx = sizes.front();
  for (const double density : {300, 500, 800}) {
    const Draft light = draft(t, 0.95 * density, dx, density);
    for (const double size : sizes)
      t.control("a box a twentieth lighter, 6 cells high", draft_of(density, size),
                std::abs(light.mean / exact_draft(density) - 1));
  }
  FloaterSetUp thrown = box_of(500, dx);
  thrown.below = -0.02, thrown.tilt = 15;
  const Rest rocks = rest(t, thrown, 0.5, 1.5);
  const char* const control = "let go 2 cm above its draft and tilted by 15 degrees, 6 cells high, from 0.5 to 1.5 s";
  for (const double size : sizes)
    t.control(control, rest_of("heave", size), rocks.heave), t.control(control, rest_of("spin", size), rocks.spin);
  speeds.curves.push_back(curve_of(rocks, "above it and tilted"));
  t.plot(std::move(drafts)), t.plot(std::move(speeds));
}

}  // namespace
}  // namespace rigid_float_case

extern const Case rigid_float_projection;
const Case rigid_float_projection{
    "rigid-float-projection", "rigid boxes of three densities float at their draft, and rest, by the projection",
    "Archimedes, exact",      true,
    rigid_float_case::run,    20};

}  // namespace dreampm::validate::cases

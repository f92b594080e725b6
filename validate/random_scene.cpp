#include "validate/random_scene.h"

#include <algorithm>
#include <cmath>
#include <variant>
#include <vector>

#include "dreampm/base/error.h"
#include "dreampm/math/rng.h"
#include "dreampm/physics/materials.h"
#include "dreampm/physics/transfers.h"
#include "dreampm/scene/parse.h"
#include "dreampm/setup/assemble.h"
#include "validate/impact.h"

namespace dreampm::validate {
namespace {

constexpr double g = 9.81, meter = 1;
// Pieces of a body count as flung at this factor of the speed of the fall: a small one before a
// large one leaves a wall at up to three times (as a ball dropped on top of a heavy one does).
constexpr double least_flung = 4;
constexpr int transfer_count = static_cast<int>(std::variant_size_v<AnyTransfer>);

class Dice {
 public:
  explicit Dice(std::uint64_t stream) : stream_(stream) {}
  double between(double low, double high) { return low + (high - low) * uniform(stream_, n_++); }
  double in_decades(double low, double high) { return std::exp(between(std::log(low), std::log(high))); }
  int below(int n) { return static_cast<int>(n * uniform(stream_, n_++)); }
  bool chance(double p) { return uniform(stream_, n_++) < p; }
  /// A whole number of as many digits as a scene's seed may have.
  std::uint64_t whole() { return static_cast<std::uint64_t>(1e9 * uniform(stream_, n_++)); }

 private:
  std::uint64_t stream_, n_ = 0;
};

std::string shown(double v) { return fmt::format("{:.6g}", v); }

/// A value of the parameter, as a scene says it. A range in decades that begins at 0 is cut nine
/// below its end, and one in four draws takes the 0.
std::string value_of(Dice& dice, const Param& p) {
  if (p.words_only || (!p.words.empty() && dice.chance(0.25)))
    return std::string(p.words[static_cast<std::size_t>(dice.below(static_cast<int>(p.words.size())))].name);
  if (!p.log) return shown(dice.between(p.min, p.max));
  if (p.min <= 0 && dice.chance(0.25)) return "0";
  return shown(std::clamp(dice.in_decades(p.min > 0 ? p.min : 1e-9 * p.max, p.max), p.min, p.max));
}

/// Any transfer of the list, its numbers anywhere in their ranges; half of all matter keeps the
/// default.
std::string transfer_text(Dice& dice) {
  if (dice.chance(0.5)) return {};
  std::string s;
  int at = dice.below(transfer_count);
  Transfers::for_each([&]<class T>() {
    if (at-- != 0) return;
    s = fmt::format(", transfer: {}", T::name);
    for (const auto& p : T::params) {
      if (!dice.chance(0.7)) continue;
      const bool is_time = p.key == "flip_memory";
      if (is_time && s.find("flip_blend") != std::string::npos) continue;  // one of them
      s += fmt::format(", {}: {}", p.key, shown(is_time ? dice.in_decades(1e-4, 10) : dice.between(p.min, p.max)));
    }
  });
  return s;
}

std::string material_text(Dice& dice, const MaterialInfo& info, double density) {
  std::string s = fmt::format("{{type: {}, density: {}", info.name, shown(density));
  // `legacy` is the report's own program, kept for comparison: its hardening has no bound.
  std::vector<std::string_view> left_out{"density", "legacy"};
  for (const Param& p : info.params)
    if (!p.excludes.empty()) left_out.push_back(dice.chance(0.5) ? p.key : p.excludes);
  for (const Param& p : info.params)
    if (std::find(left_out.begin(), left_out.end(), p.key) == left_out.end())
      s += fmt::format(", {}: {}", p.key, value_of(dice, p));
  return s + transfer_text(dice) + "}";
}

std::string wall_text(Dice& dice) {
  const std::string skin = dice.chance(0.3) ? ", skin_friction: true" : "";
  // One wall of ten is open.
  const int which = dice.below(10);
  if (which < 3) return "{type: slip" + skin + "}";
  if (which < 6) return "{type: stick}";
  if (which == 9) return "{type: open}";
  return fmt::format("{{type: separate, friction: {}{}}}", dice.chance(0.5) ? 0 : dice.below(10) / 10.0, skin);
}

/// A ball or a turned box of a few cells, which stands on the floor or just over it.
std::string collider_shape(Dice& dice, double dx, double wide) {
  const double x = dice.between(0, wide), y = dice.between(0, 1.5), z = dice.between(0, wide);
  const std::string center = fmt::format("center: [{}, {}, {}]", shown(x * dx), shown(y * dx), shown(z * dx));
  if (dice.chance(0.5)) return fmt::format("{{sphere: {{radius: {}}}, {}}}", shown(dice.between(0.7, 2) * dx), center);
  const double a = dice.between(1, 3), b = dice.between(1, 3), c = dice.between(1, 3);
  constexpr const char* axes[] = {"x", "y", "z"};
  const char* const axis = axes[dice.below(3)];
  return fmt::format("{{box: {{size: [{}, {}, {}]}}, {}, rotate: {{axis: {}, angle: {}}}}}", shown(a * dx),
                     shown(b * dx), shown(c * dx), center, axis, shown(dice.between(0, 90)));
}
std::string collider_text(Dice& dice, const std::string& shape) {
  constexpr const char* types[] = {"separate", "slip", "stick"};
  const char* const type = types[dice.below(3)];
  const double friction = dice.chance(0.5) ? 0 : dice.below(10) / 10.0;
  const std::string rubs = type == std::string("stick") ? "" : fmt::format(", friction: {}", friction);
  return fmt::format("colliders:\n  rock: {{shape: {}, type: {}{}}}\n", shape, type, rubs);
}

/// All of the scene but for the frame rate, which hangs on the materials' speeds.
struct Outline {
  std::string head, tail;
  double fall = 0;

  std::string with(double fps, int frames, const std::string& cfl) const {
    return head + fmt::format("time: {{fps: {:.6g}, frames: {}, cfl: {}}}\n", fps, frames, cfl) + tail;
  }
};

Outline outline(Dice& dice, std::uint64_t seed, int index) {
  const auto infos = material_infos();
  const MaterialInfo* info[2];
  double low[2], high[2], density[2];
  for (int i = 0; i < 2; ++i) {
    info[i] = &infos[static_cast<std::size_t>(dice.below(static_cast<int>(infos.size())))];
    low[i] = info[i]->find("density")->min, high[i] = info[i]->find("density")->max;
  }
  // Tables may lie apart: the first density is one that the second can be within ten times of.
  density[0] = dice.in_decades(std::max(low[0], low[1] / 10), std::min(high[0], high[1] * 10));
  density[1] = dice.in_decades(std::max(low[1], density[0] / 10), std::min(high[1], density[0] * 10));

  const double spacing = dice.in_decades(1e-3, 0.1), per_cell = dice.chance(0.5) ? 8 : dice.in_decades(1, 64);
  const double dx = spacing * std::cbrt(per_cell);
  constexpr double most = 1500;  // particles of a body
  const double largest = std::max(3.0, std::min(7.0, std::cbrt(most / per_cell)));
  const double lower = dice.between(3, largest), upper = dice.between(3, largest);  // sides, in cells
  const double gap = dice.chance(0.5) ? 0 : dice.between(0, 0.5), apart = dice.chance(0.5) ? 0 : dice.between(0, 1);
  const double wide = std::ceil(std::max(lower, upper)) + dice.below(5);
  // A pool from wall to wall, if its particles are not too many.
  const bool pool = dice.chance(0.4) && wide * wide * lower * per_cell < 2 * most;
  const double side = pool ? wide : lower;
  const double tall = std::ceil(gap + lower + apart + upper) + 1 + dice.below(4);
  const auto box = [&](double width, double bottom, double height) {
    const double from = pool && width == wide ? 0 : dice.between(0, wide - width);
    return fmt::format("{{box: {{min: [{}, {}, {}], max: [{}, {}, {}]}}}}", shown(from * dx), shown(bottom * dx),
                       shown(from * dx), shown((from + width) * dx), shown((bottom + height) * dx),
                       shown((from + width) * dx));
  };
  Outline o;
  o.fall = std::sqrt(2 * g * (dice.chance(0.5) ? meter : dice.in_decades(1e-2 * meter, meter)));
  const auto body = [&](const char* material, const std::string& shape, bool falls) {
    constexpr const char* patterns[] = {"jitter", "lattice", "poisson"};
    const double sideways = falls && dice.chance(0.3) ? 0.5 : 0;
    return fmt::format("  {0}: {{material: {0}, shape: {1}, velocity: [{2}, {3}, 0], sample: {{pattern: {4}}}}}\n",
                       material, shape, shown(sideways * o.fall),
                       shown(falls ? -o.fall * std::sqrt(1 - sideways * sideways) : 0), patterns[dice.below(3)]);
  };
  o.head = fmt::format(
      "dreampm: 1\nname: draw-{0}-{1}\nabout: RandomScene {1} of seed {0} of the case stability.\nseed: {2}\n", seed,
      index, dice.whole());
  // One by one: in a call's arguments the order of throws would be the compiler's.
  const std::string sides = wall_text(dice), floor = wall_text(dice), ceiling = wall_text(dice);
  o.head += fmt::format(
      "space:\n  min: [0, 0, 0]\n  max: [{0}, {1}, {0}]\n  spacing: {2}\n  particles_per_cell: {3}\n  walls: {{sides: "
      "{4}, floor: {5}, ceiling: {6}}}\n",
      shown(wide * dx), shown(tall * dx), shown(spacing), shown(per_cell), sides, floor, ceiling);
  o.tail = "gravity: [0, -9.81, 0]\nmaterials:\n";
  o.tail += fmt::format("  lower: {}\n", material_text(dice, *info[0], density[0]));
  o.tail += fmt::format("  upper: {}\n", material_text(dice, *info[1], density[1]));
  const bool lower_falls = dice.chance(0.6);
  std::string lower_box = box(side, gap, lower), upper_box = box(upper, gap + lower + apart, upper);
  if (dice.chance(0.4)) {
    const std::string rock = collider_shape(dice, dx, wide);
    for (std::string* shape : {&lower_box, &upper_box}) *shape = fmt::format("{{difference: [{}, {}]}}", *shape, rock);
    o.tail += collider_text(dice, rock);
  }
  o.tail += "bodies:\n" + body("lower", lower_box, lower_falls);
  o.tail += body("upper", upper_box, true);
  o.tail += fmt::format("output: {{folder: out/draw-{}-{}}}\n", seed, index);
  return o;
}

model::Scene parsed(const std::string& text, const std::string& name) {
  scene::ParseResult result = scene::parse_scene_text(text, name, {.variant = {}, .overrides = {}, .assets = {}});
  if (!result.ok()) throw InputError(result.text());
  return std::move(result.scene);
}

}  // namespace

double shortest_dt(double cfl, double dx, const SignalSpeeds& most) {
  const double free = wave_bound(cfl, dx, most).dt, limit = explicit_dt(dx, most.viscosity);
  const auto gain = [&](int s) { return dt_of_stages(s, euler_dt(dx, most.viscosity, most.contacts)) / limit; };
  int stages = 2;
  while (gain(stages) < 1 + stage_cost * stages) ++stages;
  return std::min(stable_dt(cfl, dx, most, 1e30).dt, std::max(limit, free / (1 + stage_cost * stages)));
}

RandomScene random_report_scene(std::uint64_t seed, int index) {
  Dice dice(mix64(seed ^ 0x7265706f7274) + static_cast<std::uint64_t>(index));
  const int cells = index % 8 == 7 ? 64 : 32;
  const bool two = dice.chance(0.5);
  const double quarter = 0.25, volume = (two ? 2 : 1) * quarter * quarter * quarter;
  const double particles = cells * cells * cells / 4.0, spacing = std::cbrt(volume / particles);
  constexpr double pull = 10, hardest = 4;  // the ends of the sliders
  const double gx = dice.between(-pull, pull), gy = dice.between(-pull, pull), gz = dice.between(-pull, pull);
  const double v = dice.between(0, 0.7), low = dice.between(-400, -100), high = dice.between(0, 100),
               h = dice.between(0.25, hardest);
  const bool elastic = dice.chance(0.3);
  RandomScene draw;
  draw.text = fmt::format(
      "dreampm: 1\nname: report-draw-{0}-{1}\nabout: RandomScene {1} of seed {0} of the case "
      "stability-playground.\nseed: "
      "{2}\nspace: {{min: [0, 0, 0], max: [1, 1, 1], spacing: {3:.17g}, particles_per_cell: {4}}}\n",
      seed, index, dice.whole(), spacing, shown(particles / (volume * cells * cells * cells)));
  draw.text += fmt::format("gravity: [{}, {}, {}]\nmaterials:\n", shown(gx), shown(gy), shown(gz));
  draw.text += fmt::format("  diy: {{type: seed, v: {}, lower: {}, upper: {}, elastic: {}, h: {}}}\n", shown(v),
                           shown(low), shown(high), elastic, shown(h));
  // The solid cube of the report: its Lame parameters, at its hardest.
  const double mu = 416.6 * hardest, lambda = 277.7 * hardest;
  if (two)
    draw.text += fmt::format("  cube: {{type: elastic, density: 1, youngs_modulus: {}, poissons_ratio: {}}}\n",
                             shown(mu * (3 * lambda + 2 * mu) / (lambda + mu)), shown(lambda / (2 * (lambda + mu))));
  draw.text += "bodies:\n";
  const auto body = [&](const char* material, double x, double y) {
    draw.text += fmt::format(
        "  {0}: {{material: {0}, shape: {{box: {{min: [{1}, {2}, {1}], max: [{3}, {4}, {3}]}}}}, sample: {{pattern: "
        "poisson}}}}\n",
        material, x, y, x + quarter, y + quarter);
  };
  if (two) body("cube", 0.30, 0.60), body("diy", 0.40, 0.25);
  if (!two) body("diy", 0.35, 0.35);
  draw.text += fmt::format("output: {{folder: out/report-draw-{}-{}}}\n", seed, index);
  draw.scene = parsed(draw.text, fmt::format("report draw {} of seed {}", index, seed));
  draw.fall = std::sqrt(2 * (std::abs(gx) + std::abs(gy) + std::abs(gz)) * meter);
  // The report asks for 1e-4 s and more: one that is shorter than a fiftieth of that stands still.
  draw.dt_floor = 2e-6;
  return draw;
}

RandomScene random_scene(std::uint64_t seed, int index, double asked_cfl) {
  Dice dice(mix64(seed) + static_cast<std::uint64_t>(index));
  const Outline o = outline(dice, seed, index);
  const std::string name = fmt::format("draw {} of seed {}", index, seed);
  // Nearly all that the parser takes.
  const double drawn = largest_cfl * (1 - 0.95 * dice.between(0, 1));
  const std::string cfl = shown(asked_cfl > 0 ? std::min(asked_cfl, largest_cfl) : drawn);
  const model::Scene first = parsed(o.with(100, 1, cfl), name);
  const InitialState start = assemble(first, name);
  const World<double>& world = start.world;

  // It goes on falling through its room, and through an open floor as far again before it is taken
  // out, and a block.
  const double room = first.space.end().y - first.space.min.y;
  const bool out = first.space.walls[dreampm::index(Side::y_min)].type == WallType::open;
  const double fall = std::sqrt(o.fall * o.fall + 2 * g * (out ? 2 * room + block_width * world.dx : room));
  double mass = 0, least = 1e30;
  for (std::size_t i = 0; i < world.sets.size(); ++i) {
    const double own = world.sets[i].mass * static_cast<double>(start.seeds[i].size());
    mass += own;
    if (own > 0) least = std::min(least, own);
  }
  const double flung = fall * std::max(least_flung, 2 * std::sqrt(mass / least));
  double step = 1;
  SignalSpeeds most{.contacts = world.viscous_contacts()};
  const double dx = world.dx, limit = asked_cfl > 0 ? asked_cfl : first.time.cfl;
  for (const auto& set : world.sets) {
    const MaterialFacts facts = facts_of(*find_material(set.material), set.values);
    step = std::min(
        step, stable_dt(limit, dx, {fall * world.reach(), facts.sound_speed, 0, facts.kinematic_viscosity}, 1).dt);
    // The gradient of a step's velocities is at most 2 v/dx (math/bspline.h: 4 sum w |x| = 2 where
    // it is largest).
    const ImpactBounds worst = impact(set.material, set.values,
                                      {.energy = set.values["density"] * flung * flung / 2,
                                       .time = dx / (fall + facts.sound_speed),
                                       .coarse = 2 * limit * flung / (flung + facts.sound_speed)});
    most.wave = std::max(most.wave, worst.sound_speed);
    most.shock = std::max(most.shock, shock_wave_speed(set.material, set.values, flung * world.reach()));
    most.viscosity = std::max(most.viscosity, worst.viscosity);
  }
  most.speed = (flung + most.wave) * world.reach();
  RandomScene draw;
  draw.fall = fall;
  // The rest of a frame is split evenly, so that a step can be half of its bound.
  draw.dt_floor = shortest_dt(limit, dx, most) / 2;
  const double fps = std::clamp(1 / (25 * step), 1.0, 10000.0);
  const int frames = 2 + static_cast<int>(random_scene_steps * step * fps);
  draw.text = o.with(fps, frames, cfl);
  draw.scene = parsed(draw.text, name);
  draw.scene.time.cfl = limit;
  return draw;
}

}  // namespace dreampm::validate

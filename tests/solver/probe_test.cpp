// Each type of probe against a case whose value is known.
#include "dreampm/solver/probe/probe.h"

#include <gtest/gtest.h>

#include <random>

#include "away.h"
#include "dreampm/base/error.h"
#include "dreampm/base/parallel.h"
#include "liquids.h"

namespace dreampm::probe_test {
namespace {
using namespace test;

constexpr double spacing = 0.01, dx = 0.02;

/// A world with what its probes need, stepped by the cpu backend.
struct Scene {
  World<float> world;
  std::vector<std::vector<ParticleSeed>> seeds;
  std::vector<ProbeStart::Body> bodies;
  std::unique_ptr<Backend<float>> backend = make_cpu_backend();
  std::unique_ptr<World<double>> frame = std::make_unique<World<double>>();
  Motion<float> motion;
  StepSums report;

  explicit Scene(Vec3i cells, WallType walls = WallType::separate) : world(empty_world<float>(dx, cells, walls)) {
    world.settings.fixed_dt = 2e-4;
  }
  /// A body of a material of its own.
  void add(std::string_view material, Values values, const Box3d& box, const Field& velocity) {
    add(material, values, lattice(box, spacing, velocity, static_cast<std::uint32_t>(count())));
  }
  void add(std::string_view material, Values values, std::vector<ParticleSeed> body) {
    bodies.push_back(
        {"body", world.sets.size(), static_cast<std::uint32_t>(count()), static_cast<std::uint32_t>(body.size())});
    frame->sets.emplace_back().material = std::string(material);
    add_set(world, material, std::move(values), spacing);
    world.sets.back().name = fmt::format("m{}", world.sets.size());
    seeds.push_back(std::move(body));
  }
  std::size_t count() const {
    std::size_t n = 0;
    for (const auto& set : seeds) n += set.size();
    return n;
  }
  void start() {
    begin(world, *backend, seeds);
    motion = initial_velocities(world, seeds);
    frame->colliders = world.colliders;
  }
  std::unique_ptr<Probe<float>> probe(ProbeForm form) const {
    return make_probe<float>({"p", 0, std::move(form)}, {*frame, seeds, bodies, spacing, {}});
  }
  /// The row of a probe that sees nothing but what it asks for.
  std::optional<std::vector<double>> sample(Probe<float>& p) const {
    World<float> w = world;
    Motion<float> m = motion;
    spoil(w, m, others(p.fields()));
    return p.sample({w, m});
  }
  std::vector<double> look(Probe<float>& p) const { return sample(p).value(); }
  /// Steps, the probe following, until `time`.
  void run(double time, Probe<float>* follower = nullptr) {
    while (world.time < time - 1e-9) {
      report = step<float>(world, *backend, &motion, 0);
      if (follower) follower->accumulate(report);
    }
  }
};

Values water(double bulk = 1e5) { return values_of("newtonian", {{"density", 1000}, {"bulk_modulus", bulk}}); }
Values jelly() { return values_of("elastic", {{"density", 1000}, {"youngs_modulus", 2e4}, {"poissons_ratio", 0.3}}); }
Field even(const Vec3d& v) {
  return [v](const Vec3d&) { return v; };
}

TEST(Height, OfAFlatSurfaceIsExactAnywhere) {
  for (const double depth : {0.005, 0.01, 0.04, 0.11, 0.2}) {
    Scene s({16, 16, 16});
    // One layer of half the height for the film.
    s.add("newtonian", water(), {{0, 0, 0}, {0.32, std::max(depth, spacing), 0.32}}, still());
    s.start();
    if (depth < spacing)
      for (float& j : s.motion.sets[0].volume_ratio) j = 0.5f;
    for (const Vec3d at : {Vec3d{0.16, 0, 0.16}, Vec3d{0, 0, 0.16}, Vec3d{0.32, 0, 0}, Vec3d{0.163, 0, 0.091}})
      EXPECT_NEAR(s.look(*s.probe(HeightProbe{at.x, at.z}))[0], depth, 0.02 * dx) << depth << " " << at.x;
  }
}

TEST(Height, IsTheFloorWhereNothingIsAndADropIsNoSurface) {
  Scene s({16, 16, 16});
  s.add("newtonian", water(), {{0, 0, 0}, {0.16, 0.1, 0.32}}, still());
  s.add("newtonian", water(), {{0.24, 0.2, 0.16}, {0.25, 0.21, 0.17}}, still());
  s.start();
  EXPECT_DOUBLE_EQ(s.look(*s.probe(HeightProbe{0.24, 0.16}))[0], 0);
  EXPECT_NEAR(s.look(*s.probe(HeightProbe{0.08, 0.16}))[0], 0.1, 1e-3);
  EXPECT_NEAR(s.look(*s.probe(HeightProbe{0.16, 0.16}))[0], 0.1, dx) << "the column is half wet";
}

TEST(Pressure, OfAColumnAtRestIsItsWeight) {
  const double height = 0.3, g = 9.81;
  Scene s({8, 24, 8}, WallType::slip);
  const Hydrostatic still_water(water(4e5), g, height);
  s.add("newtonian", water(4e5), still_water.fill({0.16, height, 0.16}, spacing));
  s.world.gravity = {0, -g, 0};
  s.start();
  still_water.press(s.world, s.seeds[0]);
  for (const double y : {0.05, 0.12, 0.2}) {
    const auto p = s.probe(PressureProbe{{0, y, 0.08}, {2, 0, 0}, 0.04});
    // The particles' own pressures are those of their heights; the ball is even about y but for the
    // lattice.
    EXPECT_NEAR(s.look(*p)[0], 1000 * g * (height - y), 0.02 * 1000 * g * height) << y;
  }
  EXPECT_EQ(s.look(*s.probe(PressureProbe{{0, 0.4, 0.08}, {1, 0, 0}, 0.04}))[0], 0) << "a dry wall";
  EXPECT_EQ(s.look(*s.probe(PressureProbe{{0.08, 0.1, 0.08}, {0, 0, -1}, 1e-3}))[0], 0) << "between the particles";
}

TEST(Pressure, OnAWallOfASolidIsItsNormalStress) {
  // Squeezed along x in a slip channel: sigma_xx = (lambda + 2 mu) strain to first order, sigma_yy
  // = lambda strain.
  Scene s({8, 8, 8}, WallType::slip);
  s.add("elastic", jelly(), {{0, 0, 0}, {0.16, 0.16, 0.16}}, still());
  s.start();
  const double strain = -1e-3;
  for (float& f : s.world.sets[0].state[0]) f = static_cast<float>(1 + strain);
  for (float& j : s.motion.sets[0].volume_ratio) j = static_cast<float>(1 + strain);
  const Lame lame = Lame::of(2e4, 0.3);
  const double along = -(lame.lambda + 2 * lame.mu) * strain, across = -lame.lambda * strain;
  EXPECT_NEAR(s.look(*s.probe(PressureProbe{{0, 0.08, 0.08}, {1, 0, 0}, 0.03}))[0], along, 0.003 * along);
  EXPECT_NEAR(s.look(*s.probe(PressureProbe{{0.08, 0, 0.08}, {0, 1, 0}, 0.03}))[0], across, 0.003 * across);
}

TEST(Velocity, OfABodyInEvenMotionIsItsOwn) {
  Scene s({32, 16, 16}, WallType::open);
  const Vec3d v{0.9, -0.3, 0.2};
  s.add("elastic", jelly(), {{0.1, 0.12, 0.12}, {0.2, 0.2, 0.2}}, even(v));
  s.start();
  const auto p = s.probe(VelocityProbe{{0.15, 0.16, 0.16}, 0.02});
  EXPECT_NEAR(s.look(*p)[0], v.x, 1e-6);
  s.run(0.02);
  const auto got = s.look(*p);
  for (int a = 0; a < 3; ++a) EXPECT_NEAR(got[static_cast<std::size_t>(a)], v[a], 1e-4);
  EXPECT_TRUE(std::isnan(s.look(*s.probe(VelocityProbe{{0.5, 0.1, 0.1}, 0.02}))[1])) << "nothing is there";
}

TEST(Flux, OfABlockThroughAPlane) {
  Scene s({32, 16, 16}, WallType::open);
  const double speed = 1.5, area = 0.08 * 0.06;
  s.add("elastic", jelly(), {{0.1, 0.12, 0.12}, {0.2, 0.2, 0.18}}, even({speed, 0, 0}));
  s.start();
  const auto with = s.probe(FluxProbe{{0.203, 0, 0}, {2, 0, 0}}),
             against = s.probe(FluxProbe{{0.203, 0, 0}, {-1, 0, 0}});
  EXPECT_FALSE(s.sample(*with)) << "a mean needs an interval";
  EXPECT_FALSE(s.sample(*against));
  // Its front is 3 mm before the plane: it enters at 2 ms and is through at 0.103 / 1.5 s.
  for (const double t : {0.01, 0.02, 0.04}) {
    s.run(t);
    const auto row = s.look(*with);
    EXPECT_NEAR(row[1], area * (speed * t - 0.003), 1e-5 * area) << t;
    if (t > 0.01) {
      EXPECT_NEAR(row[0], area * speed, 1e-3 * area * speed) << t;
    }
    EXPECT_NEAR(s.look(*against)[1], -row[1], 1e-15);
  }
  // Memory carries it over a restart.
  const auto again = s.probe(FluxProbe{{0.203, 0, 0}, {2, 0, 0}});
  again->restore(with->memory());
  s.run(0.08);
  const auto row = s.look(*with), row_again = s.look(*again);
  EXPECT_EQ(row, row_again);
  EXPECT_NEAR(row[1], area * 0.1, 1e-6 * area * 0.1) << "all of it";
}

TEST(Flux, CountsEveryRoundOfAPeriodicAxis) {
  Scene s({16, 16, 16}, WallType::open);
  s.world.periodic = {true, false, false};
  const double speed = 4, area = 0.08 * 0.06;
  s.add("elastic", jelly(), {{0.1, 0.12, 0.12}, {0.2, 0.2, 0.18}}, even({speed, 0, 0}));
  s.start();
  const auto p = s.probe(FluxProbe{{0.3, 0, 0}, {1, 0, 0}}), v = s.probe(VelocityProbe{{0.31, 0.16, 0.15}, 0.05});
  s.sample(*p);
  for (int i = 1; i <= 16; ++i) {  // 0.64 m: twice round
    s.run(i * 0.01);
    const double total = s.look(*p)[1];
    if (i == 8) {
      EXPECT_NEAR(total, 0.1 * area, 1e-4 * area) << "once";
    }
    if (i == 16) {
      EXPECT_NEAR(total, 0.2 * area, 1e-4 * area) << "twice";
    }
    if (i == 4) {
      EXPECT_NEAR(s.look(*v)[0], speed, 1e-3) << "0.26 to 0.36: across the border";
    }
  }
}

TEST(InRegion, OfAKnownBlock) {
  Scene s({16, 16, 16}, WallType::open);
  s.add("elastic", jelly(), {{0.1, 0.1, 0.1}, {0.2, 0.18, 0.16}}, even({0, -2, 0}));
  s.start();
  Shape all, half;
  all.form = BoxShape{{0.3, 0.3, 0.3}}, all.center = Vec3d{0.15, 0.15, 0.15};
  half.form = PlaneShape{{0.15, 0, 0}, {1, 0, 0}};
  const double volume = 0.1 * 0.08 * 0.06;
  const auto whole = s.look(*s.probe(RegionProbe{all})), left = s.look(*s.probe(RegionProbe{half}));
  const std::vector<double> want{volume, 1000 * volume, 0.15, 0.14, 0.13, 1, 2};
  for (std::size_t i = 0; i < want.size(); ++i) EXPECT_NEAR(whole[i], want[i], 1e-6 * want[i]) << i;
  EXPECT_NEAR(left[0], volume / 2, 1e-6 * volume);
  EXPECT_NEAR(left[2], 0.125, 1e-6);
  Shape away;
  away.form = SphereShape{0.05}, away.center = Vec3d{0, 0, 0};
  const auto nothing = s.look(*s.probe(RegionProbe{away}));
  EXPECT_EQ(nothing[0], 0);
  EXPECT_EQ(nothing[1], 0);
  EXPECT_TRUE(std::isnan(nothing[2]) && std::isnan(nothing[5]) && std::isnan(nothing[6]));
}

TEST(Force, OnTheFloorIsTheWeightAndOnASideThePush) {
  const double height = 0.2, g = 9.81, side = 0.16;
  Scene s({8, 16, 8}, WallType::slip);
  const Hydrostatic still_water(water(), g, height);
  s.add("newtonian", water(), still_water.fill({side, height, side}, spacing));
  s.world.gravity = {0, -g, 0};
  s.start();
  still_water.press(s.world, s.seeds[0]);
  const auto floor = s.probe(ForceProbe{"floor"}), wall = s.probe(ForceProbe{"x_max"});
  EXPECT_FALSE(s.sample(*floor)) << "a mean needs an interval";
  for (int i = 0; i < 1500; ++i) {  // 0.3 s: sound goes up and down 7 times
    s.report = step<float>(s.world, *s.backend, &s.motion, 0);
    floor->accumulate(s.report);
    wall->accumulate(s.report);
  }
  const double weight = 1000 * side * side * height * g;
  const auto f = s.look(*floor), w = s.look(*wall);
  EXPECT_NEAR(f[1], -weight, 0.01 * weight);
  EXPECT_NEAR(f[0], 0, 0.01 * weight);
  // About the origin: r x F with r the middle of the floor.
  EXPECT_NEAR(f[3], side / 2 * weight, 0.01 * weight * side);
  EXPECT_NEAR(f[5], -side / 2 * weight, 0.01 * weight * side);
  // Pressure follows the weight above, and its matter is pressed by up to 2 %: p dy = p J dY. The
  // force on the floor, which must be the weight, swings by 0.04 % still; half a cell of 10 at the
  // surface holds 0.25 % of the push.
  double push = 0;
  const int layers = 1000;
  for (int i = 0; i < layers; ++i) {
    const double p = 1000 * g * height * (i + 0.5) / layers;
    push += p * (1 + still_water.strain(p)) * side * height / layers;
  }
  EXPECT_NEAR(w[0], push, 0.005 * push);
}

TEST(Force, OnAColliderIsWhatItHolds) {
  Scene s({8, 16, 8}, WallType::slip);
  const double g = 9.81;
  Shape table;
  table.form = PlaneShape{{0, 0.08, 0}, {0, 1, 0}};
  s.world.colliders.push_back({"table", make_region(table, spacing, {}), WallType::separate, 0});
  s.add("elastic", jelly(), {{0, 0.08, 0}, {0.16, 0.16, 0.16}}, still());
  s.world.gravity = {0, -g, 0};
  s.world.settings.damping = 20;
  s.start();
  const auto floor = s.probe(ForceProbe{"floor"}), on = s.probe(ForceProbe{"table"});
  s.run(0.3);
  for (int i = 0; i < 1000; ++i) {
    s.report = step<float>(s.world, *s.backend, &s.motion, 0);
    floor->accumulate(s.report);
    on->accumulate(s.report);
  }
  const double weight = 1000 * 0.16 * 0.16 * 0.08 * g;
  EXPECT_NEAR(s.look(*on)[1], -weight, 0.01 * weight);
  EXPECT_NEAR(s.look(*floor)[1], 0, 1e-3 * weight);
}

TEST(Extent, OfABoxAndNotOfItsSpray) {
  Scene s({32, 16, 16}, WallType::open);
  const Box3d box{{0.11, 0.1, 0.1}, {0.24, 0.18, 0.16}};
  s.add("elastic", jelly(), box, still());
  s.add("newtonian", water(), {{0.4, 0.12, 0.12}, {0.41, 0.13, 0.13}}, still());
  s.start();
  for (std::uint8_t a = 0; a < 3; ++a) {
    const auto ends = s.look(*s.probe(ExtentProbe{a, "m1"}));
    EXPECT_NEAR(ends[0], box.min[a], 1e-6) << int(a);
    EXPECT_NEAR(ends[1], box.max[a], 1e-6) << int(a);
  }
  const auto all = s.look(*s.probe(ExtentProbe{0}));
  EXPECT_NEAR(all[1], box.max.x, 1e-6) << "one drop is no front";
  EXPECT_TRUE(std::isnan(s.look(*s.probe(ExtentProbe{0, "m2"}))[1])) << "half a cell is no layer";
}

TEST(Extent, EndsAtAClosedWallButNotAtAnOpenOne) {
  // The middle of a particle may come as near to a wall as 1e-3 cell: jitter brings it to a quarter
  // of the spacing.
  std::mt19937_64 rng(3);
  std::uniform_real_distribution<double> jitter(-spacing / 4, spacing / 4);
  auto body = lattice({{0, 0, 0}, {0.16, 0.16, 0.16}}, spacing, still());
  Box3d middles;
  for (ParticleSeed& n : body) {
    for (int a = 0; a < 3; ++a) n.position[a] += jitter(rng);
    middles.add(n.position);
  }
  for (const bool open : {false, true}) {
    Scene s({8, 8, 8}, open ? WallType::open : WallType::slip);
    s.add("elastic", jelly(), body);
    s.world.walls[2 * 1 + 1].type = WallType::open;  // the ceiling
    s.start();
    for (std::uint8_t a = 0; a < 3; ++a) {
      SCOPED_TRACE(int(a) + 10 * open);
      const auto ends = s.look(*s.probe(ExtentProbe{a, "m1"}));
      EXPECT_LT(middles.min[a] - spacing / 2, -1e-3) << "without the walls";
      // Positions are floats.
      EXPECT_NEAR(ends[0], open ? middles.min[a] - spacing / 2 : 0, 1e-7);
      EXPECT_NEAR(ends[1], open || a == 1 ? middles.max[a] + spacing / 2 : 0.16, 1e-7);
    }
  }
}

TEST(Extent, KnowsNoWallsAlongAPeriodicAxis) {
  Scene s({8, 8, 8}, WallType::slip);
  s.world.periodic[0] = true;
  s.world.walls[0].type = s.world.walls[1].type = WallType::open;
  s.add("elastic", jelly(), lattice({{0, 0, 0}, {0.16, 0.16, 0.16}}, spacing, still()));
  for (ParticleSeed& n : s.seeds[0]) n.position = n.position + Vec3d{-0.002, -0.002, 0};
  s.start();
  EXPECT_NEAR(s.look(*s.probe(ExtentProbe{0}))[0], -0.002, 1e-7);
  EXPECT_NEAR(s.look(*s.probe(ExtentProbe{1}))[0], 0, 1e-7);
}

TEST(Point, OfABodyThatTurnsAndStretches) {
  Scene s({32, 32, 16}, WallType::open);
  const Box3d box{{0.2, 0.28, 0.12}, {0.4, 0.36, 0.2}};
  s.add("elastic", jelly(), box, still());
  s.start();
  const Vec3d tip{0.4, 0.32, 0.16}, inner{0.2313, 0.3, 0.151};
  const auto at_tip = s.probe(PointProbe{"body", tip}), at_inner = s.probe(PointProbe{"body", inner});
  // x -> A x + b, by hand: a quarter turn and a stretch.
  const Mat3d a{{0.9, -0.4, 0.02, 0.45, 1.05, 0, 0.01, 0.03, 0.97}};
  const Vec3d b{0.15, 0.02, 0.01};
  auto& set = s.world.sets[0];
  for (std::size_t p = 0; p < set.size(); ++p) {
    const Vec3d x = (a * s.seeds[0][set.id[p]].position + b) / dx;
    const std::size_t block = [&] {
      std::size_t k = 0;
      while (set.block_start[k + 1] <= p) ++k;
      return k;
    }();
    for (int i = 0; i < 3; ++i)
      set.u[static_cast<std::size_t>(i)][p] =
          static_cast<float>(x[i] - 0.5 - first_stencil(s.world.particle_blocks[block])[i]);
    for (std::size_t i = 0; i < 9; ++i) set.state[i][p] = static_cast<float>(a.m[i]);
  }
  for (const auto& [probe, start] : {std::pair{at_tip.get(), tip}, {at_inner.get(), inner}}) {
    const auto row = s.look(*probe);
    ASSERT_EQ(row.size(), 12u);
    const Vec3d want = a * start + b;
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(row[static_cast<std::size_t>(i)], want[i], 2e-6);
    for (std::size_t i = 0; i < 9; ++i) EXPECT_NEAR(row[3 + i], a.m[i], 1e-6);
  }
  EXPECT_EQ(at_tip->columns().back(), "f_22");
}

TEST(Point, WhereTheBodyIsNotIsRefused) {
  Scene s({32, 32, 16}, WallType::open);
  s.add("newtonian", water(), {{0.2, 0.28, 0.12}, {0.4, 0.36, 0.2}}, still());
  EXPECT_EQ(s.probe(PointProbe{"body", {0.4, 0.36, 0.2}})->columns().size(), 3u) << "a liquid keeps no F";
  try {
    s.probe(PointProbe{"body", {0.43, 0.3, 0.15}});
    FAIL();
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("probe p: at [0.43, 0.3, 0.15] the body body has no matter"),
              std::string::npos)
        << e.what();
  }
}

TEST(Probes, ForcesDoNotDependOnTheThreads) {
  std::vector<std::vector<double>> all;
  for (const int threads : {1, 2, 5}) {
    const ThreadLimit limit(threads);
    Scene s({8, 16, 8}, WallType::stick);
    s.world.gravity = {1, -9.81, 2};
    s.add("newtonian", water(), {{0, 0, 0}, {0.16, 0.1, 0.16}}, still());
    s.start();
    const auto floor = s.probe(ForceProbe{"floor"});
    s.run(0.01, floor.get());
    all.push_back(s.look(*floor));
  }
  EXPECT_EQ(all[0], all[1]);
  EXPECT_EQ(all[0], all[2]);
}

}  // namespace
}  // namespace dreampm::probe_test

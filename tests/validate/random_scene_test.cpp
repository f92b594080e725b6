// Scenes by chance, and how hard their materials can be pressed.
#include "validate/random_scene.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "dreampm/physics/dt.h"
#include "dreampm/physics/materials.h"
#include "dreampm/scene/emit.h"
#include "dreampm/scene/parse.h"
#include "validate/impact.h"

namespace dreampm::validate {
namespace {

TEST(RandomScene, IsTheSameAloneAndReadsBack) {
  const RandomScene a = random_scene(7, 3), again = random_scene(7, 3);
  EXPECT_EQ(a.text, again.text);
  EXPECT_EQ(a.dt_floor, again.dt_floor);
  EXPECT_NE(a.text, random_scene(7, 4).text);
  EXPECT_NE(a.text, random_scene(8, 3).text);
  const auto back = scene::parse_scene_text(a.text, "draw.yaml");
  ASSERT_TRUE(back.ok()) << back.text();
  EXPECT_EQ(scene::scene_hash(back.scene, scene::Part::simulation),
            scene::scene_hash(a.scene, scene::Part::simulation));
}

/// Beyond what scenes may ask for, and nothing else of the draw changes.
TEST(RandomScene, TakesACflFromOutside) {
  const RandomScene drawn = random_scene(7, 3), wild = random_scene(7, 3, 0.9);
  EXPECT_EQ(wild.scene.time.cfl, 0.9);
  EXPECT_TRUE(scene::parse_scene_text(wild.text, "draw.yaml").ok());
  EXPECT_EQ(wild.scene.space, drawn.scene.space);
  EXPECT_EQ(wild.fall, drawn.fall);
  EXPECT_GT(wild.dt_floor, drawn.dt_floor) << "the floor is that of its cfl";
}

/// The bound holds for all that is slower, softer and less viscous, with and without contacts; and
/// some of it comes close.
TEST(RandomScene, NoStepIsShorterThanTheShortest) {
  constexpr double dx = 0.01, cfl = 0.5;
  for (const int contacts : {0, 1, 2})
    for (const double most_viscous : {1e-4, 1e-2, 3e-2, 0.1, 1.0, 10.0, 1e3}) {
      const SignalSpeeds most{.speed = 3, .wave = 20, .shock = 20, .viscosity = most_viscous, .contacts = contacts};
      const double floor = shortest_dt(cfl, dx, most);
      double shortest = 1;
      for (const double slower : {1.0, 0.9, 0.5, 0.1, 0.01})
        for (double thinner = 1; thinner > 1e-8; thinner *= 0.99) {
          SignalSpeeds f = most;
          f.speed *= slower, f.wave *= slower, f.shock *= slower, f.viscosity *= thinner;
          shortest = std::min(shortest, stable_dt(cfl, dx, f, 1).dt);
        }
      EXPECT_GE(shortest, floor * (1 - 1e-12)) << most_viscous << " with " << contacts;
      EXPECT_LE(shortest, floor * 1.02) << most_viscous << " with " << contacts;
    }
}

TEST(RandomScene, TakesEveryMaterialAndKeepsToItsWord) {
  std::set<std::string> materials;
  std::set<std::string> transfers;
  bool open = false, skin = false;
  double lowest = 1, highest = 0;
  for (int i = 0; i < 60; ++i) {
    const RandomScene d = random_scene(1, i);
    const double first = d.scene.materials[0].values["density"], second = d.scene.materials[1].values["density"];
    EXPECT_LE(std::max(first / second, second / first), 10 * (1 + 1e-4)) << d.text;
    for (const auto& m : d.scene.materials) materials.insert(m.type), transfers.insert(m.transfer);
    for (const auto& w : d.scene.space.walls) open = open || w.type == WallType::open, skin = skin || w.skin_friction;
    for (const auto& b : d.scene.bodies) EXPECT_LE(length(b.velocity), std::sqrt(2 * 9.81) * (1 + 1e-4));
    EXPECT_GT(d.dt_floor, 0);
    lowest = std::min(lowest, d.scene.time.cfl), highest = std::max(highest, d.scene.time.cfl);
  }
  EXPECT_EQ(materials.size(), material_infos().size());
  EXPECT_EQ(transfers.size(), 3u);
  EXPECT_TRUE(open);
  EXPECT_TRUE(skin);
  EXPECT_LT(lowest, 0.1);
  EXPECT_GT(highest, 0.9 * largest_cfl);
}

/// A liquid is pressed until the energy is spent: its sound speed there is what the law itself says
/// at that J.
TEST(Crush, PressesAsFarAsTheEnergyGoes) {
  Values v;
  for (const auto& [key, value] : {std::pair{"density", 1000.0},
                                   {"bulk_modulus", 1e6},
                                   {"gamma", 7.0},
                                   {"viscosity", 0.0},
                                   {"tension", 0.0},
                                   {"relaxation", 0.0}})
    v.set(key, value);
  v.with_defaults(Newtonian::info.params);
  const auto law = Newtonian::Law<double>::from(v);
  for (const double energy : {1e3, 1e5, 1e6}) {
    const ImpactBounds worst = impact("newtonian", v, {energy, 1e-3, 2e-3});
    Newtonian::State<double> s{0};
    while (law.respond(s).energy < energy && s.e > -0.6) s.e -= 1e-5;
    EXPECT_NEAR(worst.sound_speed / law.respond(s).sound_speed, 1, 0.02) << energy;
  }
  EXPECT_THROW(impact("ether", v, {1, 1, 1}), std::out_of_range);
}

/// Snow that is packed hardens: the energy of a fall of a meter makes it faster than at rest, more
/// energy still more.
TEST(Crush, PackedSnowIsFaster) {
  Values v;
  v.with_defaults(Snow::info.params);
  const double rest = facts_of(Snow::info, v).sound_speed;
  const double some = impact("snow", v, {400 * 9.81, 1e-2, 2e-3}).sound_speed;
  const double more = impact("snow", v, {16 * 400 * 9.81, 1e-2, 2e-3}).sound_speed;
  EXPECT_GT(some, 1.05 * rest);
  EXPECT_GT(more, some);
}

/// Steps that turn a particle inside out make snow as hard as it gets, with hardly any energy.
TEST(Crush, CoarseStepsPackSnowAtOnce) {
  Values v;
  v.with_defaults(Snow::info.params);
  const double rest = facts_of(Snow::info, v).sound_speed, hardest = rest * std::exp(v["hardening"] * 0.4 / 2);
  EXPECT_LT(impact("snow", v, {1, 1e-2, 2e-3}).sound_speed, 0.5 * hardest);
  EXPECT_NEAR(impact("snow", v, {1, 1e-2, 1.4}).sound_speed / hardest, 1, 0.05);
}

/// One load may come after another: snow that is packed and then pulled has been both.
TEST(Crush, LoadsFollowEachOther) {
  Values v;
  v.set("upper", 9000);
  v.set("lower", -1000);
  v.with_defaults(Seed::info.params);
  const double e = v["youngs_modulus"], rho = v["density"];
  const double packed = std::sqrt(e * std::exp(Seed::most_hardened) / rho);
  EXPECT_GT(impact("seed", v, {1e9, 1e-2, 2e-3}).sound_speed, 1.5 * packed);
}

}  // namespace
}  // namespace dreampm::validate

// Values read from a simulation are those of its physics.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "dreampm/base/error.h"
#include "dreampm/simulation.h"
#include "scenes.h"

namespace dreampm {
namespace {
using namespace test;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

TEST(ReadsOfMatter, GravityByKeysIsThatOfNow) {
  Simulation s(
      parse_scene("dreampm: 1\nname: turn\nspace: {max: [0.2, 0.2, 0.2], spacing: 0.02}\n"
                  "gravity: {keys: [{t: 0, value: [0, -10, 0]}, {t: 0.1, value: [10, -10, 0]}]}\n"
                  "materials: {water: {type: newtonian}}\n"
                  "bodies: {drop: {material: water, shape: {sphere: {radius: 0.05}, center: [0.1, 0.1, 0.1]}}}\n",
                  "turn.yaml"),
      quiet());
  EXPECT_EQ(s.gravity(), (Vec3d{0, -10, 0}));
  s.advance_to(0.05);
  EXPECT_NEAR(s.gravity().x, 100 * s.time(), 1e-9);
}

// The gradient that particles come with: they turn as a rigid body does.
TEST(ReadsOfMatter, ParticlesComeWithTheirVelocityGradient) {
  Simulation s(dam_and_jelly(), quiet());
  const Vec3d middle{0.18, 0.16, 0.08};
  const std::array<Vec3d, 3> spinning{Vec3d{0, -3, 0}, Vec3d{3, 0, 0}, Vec3d{0, 0, 0}};
  std::vector<NewParticle> some;
  for (const double x : {-0.01, 0.01})
    for (const double y : {-0.01, 0.01}) some.push_back({middle + Vec3d{x, y, 0}, {-3 * y, 3 * x, 0}, spinning});
  s.add_particles("jelly", some);
  const ParticleView jelly = s.particles("jelly");
  const AttributeView gradient = s.attribute("jelly", "velocity_gradient");
  for (std::size_t k = 0; k < 4; ++k) {
    const std::size_t i = jelly.size() - 4 + k;
    EXPECT_NEAR(jelly.velocity[i].x, some[k].velocity.x, 1e-6);
    EXPECT_EQ(gradient.values[9 * i + 1], -3) << "dv_x/dy";
    EXPECT_EQ(gradient.values[9 * i + 3], 3) << "dv_y/dx";
  }
  some[0].gradient[0].x = std::nan("");
  EXPECT_THROW(s.add_particles("jelly", some), InputError);
}

// A cube that gravity presses: its deformation is what its volume says.
TEST(ReadsOfMatter, TheDeterminantOfFIsJ) {
  for (const std::string backend : {"cpu", "reference"}) {
    Simulation s(dam_and_jelly(), quiet(1, backend));
    EXPECT_EQ(s.backend(), backend);
    EXPECT_EQ(s.isa().empty(), false);
    s.advance_to(0.1);
    const AttributeView f = s.attribute("jelly", "f"), j = s.attribute("jelly", "j"), jp = s.attribute("jelly", "jp");
    ASSERT_EQ(f.size(), s.particle_count("jelly"));
    float changed = 0;
    for (std::size_t i = 0; i < f.size(); ++i) {
      const auto m = f.values.subspan(9 * i, 9);
      const float det =
          m[0] * (m[4] * m[8] - m[5] * m[7]) - m[1] * (m[3] * m[8] - m[5] * m[6]) + m[2] * (m[3] * m[7] - m[4] * m[6]);
      EXPECT_NEAR(det, j.values[i], 1e-4) << backend;
      EXPECT_EQ(jp.values[i], 1) << "it keeps none";
      changed = std::max(changed, std::abs(det - 1));
    }
    EXPECT_GT(changed, 1e-3f);
  }
}

// rho c^2 = E (1 - nu)/((1 + nu)(1 - 2 nu)), of the material as it is and as it would be.
TEST(ReadsOfMatter, AMaterialAsItIsAndAsItWouldBe) {
  Simulation s(dam_and_jelly(), quiet());
  const double nu = 0.3, modulus = (1 - nu) / ((1 + nu) * (1 - 2 * nu));
  const MaterialState now = s.material("jelly");
  EXPECT_EQ(now.type, "neo_hookean");
  EXPECT_FALSE(now.liquid);
  EXPECT_TRUE(s.material("water").liquid);
  EXPECT_NEAR(500 * now.sound_speed * now.sound_speed, 2e4 * modulus, 1);
  EXPECT_NEAR(now.poissons_ratio, nu, 1e-6) << "in float";
  EXPECT_NEAR(now.particle_mass, 500 * std::pow(0.02, 3), 1e-12);
  const MaterialState other =
      s.material("jelly", std::vector<ParameterValue>{{"youngs_modulus", 8e4}, {"density", 1000}});
  EXPECT_NEAR(1000 * other.sound_speed * other.sound_speed, 8e4 * modulus, 1);
  EXPECT_NEAR(other.particle_mass, 2 * now.particle_mass, 1e-12);
  EXPECT_EQ(s.parameter("jelly", "youngs_modulus"), 2e4) << "nothing is changed";
  s.set_parameter("jelly", "youngs_modulus", 8e4), s.set_parameter("jelly", "density", 1000);
  EXPECT_EQ(s.material("jelly").sound_speed, other.sound_speed);
  EXPECT_TRUE(std::isnan(s.parameter("water", "bulk_modulus"))) << "the solver works it out";
}

// Over two calls the mean is of both, and what a wall of water pushes is what one call says.
TEST(ReadsOfMatter, ForcesAreMeansOverSeveralCalls) {
  const auto with_gate = [] {
    return Simulation(
        parse_scene("dreampm: 1\nname: gate\nspace: {max: [0.3, 0.2, 0.2], spacing: 0.02}\n"
                    "materials: {water: {type: newtonian}}\n"
                    "bodies: {pool: {material: water, shape: {box: {min: [0, 0, 0], max: [0.2, 0.16, 0.2]}}}}\n"
                    "colliders: {gate: {shape: {box: {min: [0.2, 0, 0], max: [0.24, 0.2, 0.2]}}}}\n",
                    "gate.yaml"),
        quiet());
  };
  Simulation one = with_gate(), two = with_gate();
  one.advance_steps(60);
  two.advance_steps(20), two.advance_steps(40, ForceMean::goes_on);
  const double whole = one.collider("gate").force.x;
  EXPECT_GT(whole, 0);
  EXPECT_NEAR(two.collider("gate").force.x, whole, 1e-9 * whole);
  two.advance_steps(20);
  EXPECT_GT(std::abs(two.collider("gate").force.x - whole), 1e-6 * whole) << "a call of its own begins anew";
}

TEST(ReadsOfMatter, PartsThatASolverRefuses) {
  const Scene snow = dam_and_jelly().with({"materials.jelly={type: snow}"});
  EXPECT_THAT(refused_parts(snow), IsEmpty());
  const Scene pinned = parse_scene(
      "dreampm: 1\nname: pinned\nspace: {max: [0.4, 0.4, 0.2], spacing: 0.02}\ntime: {solver: projection}\n"
      "materials: {water: {type: newtonian}}\n"
      "bodies: {pool: {material: water, shape: {box: {min: [0, 0, 0], max: [0.4, 0.1, 0.2]}}}}\n"
      "pins: {held: {shape: {box: {min: [0, 0, 0], max: [0.1, 0.1, 0.1]}}}}\n",
      "pinned.yaml");
  EXPECT_THAT(refused_parts(pinned), ElementsAre(HasSubstr("pin held")));
  EXPECT_THROW(Simulation(pinned, quiet()), InputError);
}

}  // namespace
}  // namespace dreampm

// The material of docs/howto/add-a-material.md, which is not of this tree, added by its header
// alone and run.
#include <gtest/gtest.h>

#include <physics/lanes_under_test.h>
#include <physics/states.h>
#include <solver/worlds.h>
#include <memory>
#include <numbers>

#include "dreampm/scene/parse.h"
#include "dreampm/setup/assemble.h"

namespace dreampm {
namespace {
using namespace test;

TEST(OutOfTree, TheListKnowsIt) {
  const MaterialInfo* info = find_material("kelvin_voigt");
  ASSERT_NE(info, nullptr);
  EXPECT_EQ(material_infos().size(), static_cast<std::size_t>(OwnMaterials::size) + 1);
  Values v = complete(*info);
  EXPECT_NEAR(facts_of(*info, v).poissons_ratio, 4e4 / (2 * (4e4 + 1e4)), 1e-5);
  EXPECT_NEAR(facts_of(*info, v).kinematic_viscosity, 1e-3, 1e-12);
}

TEST(OutOfTree, ItReportsTheViscosityItActsWith) {
  const Values v = complete(KelvinVoigt::info);
  const auto law = KelvinVoigt::Law<double>::from(v);
  Rng rng(19);
  for (int trial = 0; trial < 100; ++trial) {
    const auto s = random_state<KelvinVoigt, double>(law, rng, 0.05);
    EXPECT_EQ(viscosity_complaint<KelvinVoigt>(law, v, s, random_matrix(rng, 0.1)), "");
  }
}

constexpr double bar_length = 0.4, bar_mu = 1e4, bar_lambda = 4e4;

/// Energies over the kinetic energy at the start.
struct Period {
  double kinetic;  ///< what is left of it after one period
  double lost;     ///< of kinetic and elastic energy together
  double viscous;  ///< what the ledger's dissipated_viscosity sums
};

/// The longest standing wave of a bar of damped rubber between two walls, for one period.
Period after_a_period(int cells, double viscosity) {
  const double dx = bar_length / cells;
  World<double> w = empty_world<double>(dx, {cells, 2, 2}, WallType::slip);
  add_set(w, "kelvin_voigt",
          values_of("kelvin_voigt", {{"mu", bar_mu}, {"lambda", bar_lambda}, {"viscosity", viscosity}}), dx / 2);
  // Slip walls hold the ends and the sides: uniaxial strain.
  const Field wave = [](const Vec3d& p) { return Vec3d{0.01 * std::sin(std::numbers::pi * p.x / bar_length), 0, 0}; };
  const std::vector<std::vector<ParticleSeed>> seeds{lattice({{0, 0, 0}, {bar_length, 2 * dx, 2 * dx}}, dx / 2, wave)};
  w.settings.fps = std::sqrt((bar_lambda + 2 * bar_mu) / 1000) / (2 * bar_length);
  const auto backend = make_reference_backend<double>();
  begin(w, *backend, seeds);
  const Balance start = balance(w, initial_velocities(w, seeds));
  Motion<double> motion;
  double heat = 0;
  while (w.frame == 1) heat += step<double>(w, *backend, &motion).pass.energy.viscous;
  const Balance end = balance(w, motion);
  return {end.kinetic / start.kinetic, (start.kinetic + start.elastic - end.kinetic - end.elastic) / start.kinetic,
          heat / start.kinetic};
}

TEST(OutOfTree, ItRunsAndItsDashpotDampsAsTheoryTells) {
  // rho u_tt = (lambda + 2 mu) u_xx + 2 eta u_xxt: the energy falls by exp(-2 eta k^2/rho t).
  // Strain is largest at the walls, whose mirror image the grid does not have: an error of first
  // order in dx, so half as much on half the cells.
  const double eta = 20, k = std::numbers::pi / bar_length, period = 2 * bar_length / std::sqrt(60.0);
  const double want = 2 * eta / 1000 * k * k * period;
  double error[2], rest[2];
  for (int fine = 0; fine < 2; ++fine) {
    const int cells = fine ? 40 : 20;
    const Period free = after_a_period(cells, 0), damped = after_a_period(cells, eta);
    const double rate = std::log(free.kinetic / damped.kinetic);
    std::printf(
        "%d cells: %.4f of the energy left without a dashpot, %.4f with it: rate %.4f, theory %.4f; of the %.4f "
        "lost %.4f is the dashpot's heat\n",
        cells, free.kinetic, damped.kinetic, rate, want, damped.lost, damped.viscous);
    EXPECT_LT(free.kinetic, 1);
    EXPECT_EQ(free.viscous, 0);
    // The lost energy is the dashpot's heat, and that which the transfer takes without it too; the
    // rest is the error of an explicit step, of first order in dt, and dt goes with dx.
    rest[fine] = std::abs(damped.lost - damped.viscous - free.lost) / damped.lost;
    error[fine] = std::abs(rate / want - 1);
  }
  EXPECT_LT(error[1], 0.05);
  EXPECT_LT(error[1], 0.6 * error[0]);
  EXPECT_LT(rest[1], 0.02);
  EXPECT_LT(rest[1], 0.6 * rest[0]);
}

#ifdef DM_LANES_UNDER_TEST
constexpr const char* falling_cube = R"(dreampm: 1
name: foam
space: {min: [0, 0, 0], max: [0.2, 0.2, 0.2], spacing: 0.01}
time: {fps: 50, frames: 5}
materials: {foam: {type: kelvin_voigt, mu: 2.0e4, viscosity: 5}, water: {type: newtonian, preset: water}}
bodies:
  cube: {material: foam, shape: {box: {min: [0.06, 0.1, 0.06], max: [0.14, 0.18, 0.14]}}, velocity: [0, -1, 0]}
  pool: {material: water, shape: {box: {min: [0, 0, 0], max: [0.2, 0.06, 0.2]}}}
)";

std::vector<Vec3d> ran(const InitialState& start, Backend<float>& backend) {
  World<float> w = as_world<float>(start.world);
  begin(w, backend, start.seeds);
  for (int i = 0; i < 100; ++i) step<float>(w, backend, nullptr);
  return positions_by_id(w);
}

TEST(OutOfTree, ASceneNamesItAndTheKernelRunsItBesideWater) {
  const auto parsed = scene::parse_scene_text(falling_cube, "foam.yaml");
  ASSERT_TRUE(parsed.ok()) << parsed.text();
  const InitialState start = assemble(parsed.scene, "foam.yaml");
  const double dx = start.world.dx;
  const auto reference = make_reference_backend<float>(), cpu = make_cpu_backend("sse4");
  const auto want = ran(start, *reference), got = ran(start, *cpu);
  double sum = 0, moved = 0;
  for (const auto& set : start.seeds)
    for (const ParticleSeed& n : set) {
      sum += length2(got[n.id] - want[n.id]) / (dx * dx);
      moved = std::max(moved, length(want[n.id] - n.position) / dx);
    }
  EXPECT_GT(moved, 1);
  EXPECT_LE(std::sqrt(sum / static_cast<double>(want.size())), 1e-5);

  const auto wrong = scene::parse_scene_text(
      std::string(falling_cube).replace(std::string_view(falling_cube).find("mu: 2"), 2, "nu"), "foam.yaml");
  EXPECT_FALSE(wrong.ok());
  EXPECT_NE(wrong.text().find("nu"), std::string::npos) << wrong.text();
}

TEST(OutOfTree, ItRunsInLanes) {
  using M = KelvinVoigt;
  const auto law = M::Law<float>::from(complete(M::info));
  Rng rng(15);
  auto call = std::make_unique<LawCall>();
  call->law = &law;
  call->dt = 1e-4f;
  std::vector<M::State<float>> states;
  for (int p = 0; p < lanes_tested; ++p) {
    states.push_back(random_state<M, float>(law, rng, 0.05));
    for (int c = 0; c < state_columns<M>; ++c) call->state[c][p] = states.back()[c];
    for (int k = 0; k < 9; ++k) call->gradient[k][p] = static_cast<float>(between(rng, -0.05, 0.05));
  }
  sse4::lanes_under_test().advance(OwnMaterials::size, *call);
  for (int p = 0; p < lanes_tested; ++p) {
    StrainIncrement<float> at{{}, call->dt, 1, 0};
    for (int k = 0; k < 9; ++k) at.gradient.m[k] = call->gradient[k][p];
    const auto r = advanced(law, states[static_cast<std::size_t>(p)], at);
    const float stiff = 1000 * r.sound_speed * r.sound_speed;
    EXPECT_NEAR(call->tau[0][p], r.tau.xx, 1e-6f * stiff);
    EXPECT_NEAR(call->tau[3][p], r.tau.xy, 1e-6f * stiff);
  }
}
#endif

}  // namespace
}  // namespace dreampm

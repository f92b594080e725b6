// The material of docs/howto/add-a-material.md, which is not of this tree, added by its header alone and run.
#include <gtest/gtest.h>

#include <physics/lanes_under_test.h>
#include <physics/states.h>
#include <solver/worlds.h>
#include <memory>
#include <numbers>

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

constexpr double bar_length = 0.4, bar_mu = 1e4, bar_lambda = 4e4;

/// The longest standing wave of a bar of damped rubber between two walls: its kinetic energy after one period, over
/// that of the start.
double left_after_a_period(int cells, double viscosity) {
  const double dx = bar_length / cells;
  World<double> w = empty_world<double>(dx, {cells, 2, 2}, WallType::slip);
  add_set(w, "kelvin_voigt",
          values_of("kelvin_voigt", {{"mu", bar_mu}, {"lambda", bar_lambda}, {"viscosity", viscosity}}), dx / 2);
  // Slip walls hold the ends and the sides: uniaxial strain.
  const Field wave = [](const Vec3d& p) { return Vec3d{0.01 * std::sin(std::numbers::pi * p.x / bar_length), 0, 0}; };
  const std::vector<std::vector<Newborn>> newborns{lattice({{0, 0, 0}, {bar_length, 2 * dx, 2 * dx}}, dx / 2, wave)};
  w.settings.fps = std::sqrt((bar_lambda + 2 * bar_mu) / 1000) / (2 * bar_length);
  const auto backend = make_reference_backend<double>();
  begin(w, *backend, newborns);
  const double start = balance(w, motion_at_birth(w, newborns)).kinetic;
  Motion<double> motion;
  while (w.frame == 1) step<double>(w, *backend, &motion);
  return balance(w, motion).kinetic / start;
}

TEST(OutOfTree, ItRunsAndItsDashpotDampsAsTheoryTells) {
  // rho u_tt = (lambda + 2 mu) u_xx + 2 eta u_xxt: the energy falls by exp(-2 eta k^2/rho t). Strain is largest at the
  // walls, whose mirror image the grid does not have: an error of first order in dx, so half as much on half the cells.
  const double eta = 20, k = std::numbers::pi / bar_length, period = 2 * bar_length / std::sqrt(60.0);
  const double want = 2 * eta / 1000 * k * k * period;
  double error[2];
  for (int fine = 0; fine < 2; ++fine) {
    const int cells = fine ? 40 : 20;
    const double free = left_after_a_period(cells, 0), damped = left_after_a_period(cells, eta);
    const double rate = std::log(free / damped);
    std::printf("%d cells: %.4f of the energy left without a dashpot, %.4f with it: rate %.4f, theory %.4f\n", cells,
                free, damped, rate, want);
    EXPECT_LT(free, 1);
    error[fine] = std::abs(rate / want - 1);
  }
  EXPECT_LT(error[1], 0.05);
  EXPECT_LT(error[1], 0.6 * error[0]);
}

#ifdef DM_LANES_UNDER_TEST
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
    Local<float> at{{}, call->dt, 1, 0};
    for (int k = 0; k < 9; ++k) at.gradient.m[k] = call->gradient[k][p];
    const auto r = law.advance(states[static_cast<std::size_t>(p)], at);
    const float stiff = 1000 * r.sound_speed * r.sound_speed;
    EXPECT_NEAR(call->tau[0][p], r.tau.xx, 1e-6f * stiff);
    EXPECT_NEAR(call->tau[3][p], r.tau.xy, 1e-6f * stiff);
  }
}
#endif

}  // namespace
}  // namespace dreampm

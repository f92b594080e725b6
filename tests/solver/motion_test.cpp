// Free fall, and blocks on slopes: gravity tilted over the floor of the box, and a tilted plane.
#include <gtest/gtest.h>

#include <numbers>

#include "worlds.h"

namespace dreampm::motion_test {
namespace {
using namespace test;

constexpr double g = 9.81, dx = 0.02, spacing = 0.01;

Values block_values(double youngs) {
  return values_of("elastic", {{"youngs_modulus", youngs}, {"poissons_ratio", 0.3}, {"density", 1000}});
}

using validate::mean_position;

// Symplectic Euler: v_n = v_0 - n dt g, x_n = x_0 + n dt v_0 - n (n + 1)/2 dt^2 g.
template <class R>
void check_fall(Backend<R>& backend, double allowed) {
  World<R> w = empty_world<R>(dx, {40, 80, 40}, WallType::open);
  w.gravity = {0, -g, 0};
  const double dt = 5e-4;
  w.settings.fps = 1 / dt;
  w.settings.fixed_dt = dt;
  add_set(w, "elastic", block_values(1e4), spacing);
  const Vec3d v0{0.3, 1.2, -0.2};
  const std::vector<std::vector<ParticleSeed>> seeds{
      lattice({{0.3, 1.0, 0.3}, {0.4, 1.08, 0.36}}, spacing, [&](const Vec3d&) { return v0; })};
  begin(w, backend, seeds);
  const double worst = validate::fall_error(w, seeds[0], 800, w.gravity, [&] { step<R>(w, backend, nullptr); });
  std::printf("fall on %s: %.2e m after 0.4 s\n", std::string(backend.isa()).c_str(), worst);
  EXPECT_LE(worst, allowed);
}
TEST(Motion, FreeFallIsExactInDouble) { check_fall<double>(*make_reference_backend<double>(), 1e-12); }
TEST(Motion, FreeFallInFloat) { check_fall<float>(*make_cpu_backend(), 5e-6); }

/// How far a flat block goes on the floor when gravity leans by `degrees` towards +x.
double slide(WallType type, double friction, double degrees, double time) {
  World<float> w = empty_world<float>(dx, {90, 12, 16}, WallType::slip);
  w.walls[2] = {type, friction};
  w.gravity = {0, -g, 0};
  w.settings.fps = 1 / time;
  add_set(w, "elastic", block_values(2e5), spacing);
  const std::vector<std::vector<ParticleSeed>> seeds{
      lattice({{0.1, 0.005, 0.06}, {0.3, 0.055, 0.22}}, spacing, still())};
  const auto backend = make_cpu_backend();
  begin(w, *backend, seeds);
  return validate::slide(w, degrees, time, [&] { step<float>(w, *backend, nullptr); });
}

TEST(Motion, FrictionlessSlope) {
  const double t = 0.5, a = 20 * std::numbers::pi / 180, want = 0.5 * g * std::sin(a) * t * t;
  for (const WallType type : {WallType::slip, WallType::separate}) {
    const double got = slide(type, 0, 20, t);
    std::printf("frictionless slope: %.5f m, exact %.5f\n", got, want);
    EXPECT_NEAR(got, want, 0.01 * want);
  }
}

TEST(Motion, CoulombSlope) {
  // Slip with much friction is not asked here: a wall that pulls too brakes by the pressing half of
  // a tremor alone (7 % too slow at 0.3).
  const double t = 0.5, a = 30 * std::numbers::pi / 180;
  for (const auto& [type, mu] :
       {std::pair{WallType::slip, 0.1}, std::pair{WallType::separate, 0.1}, std::pair{WallType::separate, 0.3}}) {
    const double want = 0.5 * g * (std::sin(a) - mu * std::cos(a)) * t * t;
    const double got = slide(type, mu, 30, t);
    std::printf("Coulomb %.1f, slope 30: %.5f m, exact %.5f (%.2f %%)\n", mu, got, want, 100 * (got / want - 1));
    EXPECT_NEAR(got, want, 0.03 * want);
  }
}

TEST(Motion, BelowTheFrictionAngleABlockStays) {
  // tan 20 = 0.364: held by 0.45, not by 0.3.
  EXPECT_LT(std::abs(slide(WallType::separate, 0.45, 20, 0.5)), 0.05 * dx);
  EXPECT_GT(slide(WallType::separate, 0.3, 20, 0.5), dx);
}

TEST(Motion, StickHolds) { EXPECT_LT(std::abs(slide(WallType::stick, 0, 30, 0.5)), 0.1 * dx); }

/// The same on a plane collider that leans by `degrees`; distance along the slope.
double slide_on_plane(WallType type, double friction, double degrees, double time, double& sunk) {
  World<float> w = empty_world<float>(dx, {60, 60, 16}, WallType::slip);
  w.gravity = {0, -g, 0};
  w.settings.fps = 1 / time;
  const double a = degrees * std::numbers::pi / 180;
  const Vec3d normal{std::sin(a), std::cos(a), 0}, along{std::cos(a), -std::sin(a), 0}, side{0, 0, 1};
  const Vec3d point{0.3, 0.8, 0.16};
  Shape plane;
  plane.form = PlaneShape{point, normal};
  w.colliders.push_back({"slope", make_region(plane, dx, {}), type, friction});
  add_set(w, "elastic", block_values(2e5), spacing);
  std::vector<ParticleSeed> block;
  for (int i = -10; i < 10; ++i)
    for (int j = 0; j < 5; ++j)
      for (int k = -8; k < 8; ++k) {
        // The block lies on the plane: one that drops bounces, and friction does not hold it in the
        // air.
        const Vec3d p =
            point + along * ((i + 0.5) * spacing) + normal * ((j + 0.5) * spacing) + side * ((k + 0.5) * spacing);
        block.push_back({static_cast<std::uint32_t>(block.size()), p, {}, {}});
      }
  const auto backend = make_cpu_backend();
  begin(w, *backend, {block});
  const Vec3d start = mean_position(w);
  while (w.frame == 1) step<float>(w, *backend, nullptr);
  const Vec3d moved = mean_position(w) - start;
  sunk = -dot(moved, normal);
  return dot(moved, along);
}

TEST(Motion, TiltedPlane) {
  const double t = 0.4, a = 30 * std::numbers::pi / 180;
  for (const double mu : {0.0, 0.3}) {
    const double want = 0.5 * g * (std::sin(a) - mu * std::cos(a)) * t * t;
    double sunk = 0;
    const double got = slide_on_plane(WallType::slip, mu, 30, t, sunk);
    std::printf("plane, friction %.1f: %.5f m, exact %.5f (%.2f %%), sunk %.3f cells\n", mu, got, want,
                100 * (got / want - 1), sunk / dx);
    EXPECT_NEAR(got, want, 0.05 * want);
    EXPECT_LT(std::abs(sunk), dx);
  }
  double sunk = 0;
  EXPECT_LT(std::abs(slide_on_plane(WallType::stick, 0, 30, t, sunk)), 0.2 * dx);
  EXPECT_LT(std::abs(slide_on_plane(WallType::separate, 0.8, 30, t, sunk)), 0.2 * dx);
}

// A small ball at the far corner of what a block of particles reaches, near no node of the grid's
// first block there.
TEST(Motion, ABallAtTheCornerOfABlockPutsBackWhoLiesInIt) {
  World<float> w = empty_world<float>(dx, {24, 24, 24}, WallType::open);
  const double radius = 1.2 * dx;
  const Vec3d first = static_cast<Vec3d>(first_stencil({2, 2, 2})) * dx, diagonal{1, 1, 1};
  const Vec3d center = first + diagonal * (5 * dx), start = first + diagonal * (4.4 * dx);
  w.settings.fixed_dt = 1e-4;
  Shape ball;
  ball.form = SphereShape{radius};
  ball.center = center;
  w.colliders.push_back({"ball", make_region(ball, dx, {}), WallType::slip, 0});
  add_set(w, "elastic", block_values(1e4), spacing);
  const auto where = [&] { return positions_by_id(w).at(0); };
  const auto backend = make_cpu_backend();
  begin(w, *backend, {{{0, start, {}, {}}}});
  ASSERT_EQ(w.particle_blocks, (std::vector<Vec3i>{{2, 2, 2}}));
  ASSERT_LT(length(where() - center), radius - 0.1 * dx);
  for (int i = 0; i < 20; ++i) step<float>(w, *backend, nullptr);
  // Distances are gathered by the kernel, for which a ball as small as this is a little smaller.
  EXPECT_GT(length(where() - center), radius - 0.03 * dx);
}

}  // namespace
}  // namespace dreampm::motion_test

// Case 1 of the validation set: a free rotating and shearing elastic block keeps its momenta and
// gains no energy.
#include <gtest/gtest.h>

#include "validate/measure/drift.h"
#include "worlds.h"

namespace dreampm::conservation_test {
namespace {
using namespace test;

template <class R>
validate::Drift free_block(Backend<R>& backend, int steps) {
  const double spacing = 0.01;
  World<R> w = empty_world<R>(0.02, {64, 64, 64}, WallType::open);
  const auto set =
      add_set(w, "elastic", values_of("elastic", {{"youngs_modulus", 1e4}, {"poissons_ratio", 0.3}}), spacing);
  (void)set;
  const Vec3d middle{0.64, 0.64, 0.64};
  const Field field = [&](const Vec3d& p) {
    const Vec3d r = p - middle;
    return Vec3d{-2 * r.y + 0.5 * r.z, 2 * r.x, 0.3 * r.y} + Vec3d{0.02, 0.01, -0.015};
  };
  const Box3d box{middle - Vec3d{0.04, 0.03, 0.03}, middle + Vec3d{0.04, 0.03, 0.03}};
  std::vector<std::vector<ParticleSeed>> seeds{lattice(box, spacing, field)};
  w.settings.fps = 100;
  w.settings.fixed_dt = 5e-4;
  begin(w, backend, seeds);
  const Balance start = balance(w, initial_velocities(w, seeds));
  return validate::drift_of(w, start, steps, [&](Motion<R>* motion) { return step(w, backend, motion); });
}

TEST(Conservation, DoubleReferenceKeepsMomentaToRoundOff) {
  const auto backend = make_reference_backend<double>();
  const auto d = free_block(*backend, 10000);
  EXPECT_EQ(d.mass, 0);
  EXPECT_LT(d.momentum, 1e-12);
  EXPECT_LT(d.angular, 1e-12);
  EXPECT_LT(d.energy, 1 + 1e-3);
}

TEST(Conservation, FloatCpuKeepsMomentaToFloatRoundOff) {
  const auto backend = make_cpu_backend();
  const auto d = free_block(*backend, 10000);
  EXPECT_EQ(d.mass, 0);
  EXPECT_LT(d.momentum, 1e-4);
  EXPECT_LT(d.angular, 1e-4);
  EXPECT_LT(d.energy, 1 + 1e-3);
}

}  // namespace
}  // namespace dreampm::conservation_test

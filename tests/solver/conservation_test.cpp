// Case 1 of the validation set: a free rotating and shearing elastic block keeps its momenta and gains no energy.
#include <gtest/gtest.h>

#include "worlds.h"

namespace dreampm {
namespace {
using namespace test;

template <class R>
struct Drift {
  double momentum = 0, angular = 0, energy = 0;
};

template <class R>
Drift<R> free_block(Backend<R>& backend, int steps) {
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
  std::vector<std::vector<Newborn>> newborns{lattice(box, spacing, field)};
  w.settings.fps = 100;
  w.settings.fixed_dt = 5e-4;
  begin(w, backend, newborns);
  const Balance start = balance(w, motion_at_birth(w, newborns));
  Drift<R> d;
  const double scale_p = start.mass * 0.1;
  for (int i = 0; i < steps; ++i) {
    Motion<R> motion;
    const StepReport r = step(w, backend, &motion);
    if (!r.frame_done) continue;
    const Balance b = balance(w, motion);
    EXPECT_DOUBLE_EQ(b.mass, start.mass);
    d.momentum = std::max(d.momentum, length(b.momentum - start.momentum) / scale_p);
    d.angular = std::max(d.angular, length(b.angular - start.angular) / length(start.angular));
    d.energy = std::max(d.energy, (b.kinetic + b.elastic) / (start.kinetic + start.elastic));
  }
  return d;
}

TEST(Conservation, DoubleReferenceKeepsMomentaToRoundOff) {
  const auto backend = make_reference_backend<double>();
  const auto d = free_block(*backend, 10000);
  EXPECT_LT(d.momentum, 1e-12);
  EXPECT_LT(d.angular, 1e-12);
  EXPECT_LT(d.energy, 1 + 1e-3);
}

TEST(Conservation, FloatCpuKeepsMomentaToFloatRoundOff) {
  const auto backend = make_cpu_backend();
  const auto d = free_block(*backend, 10000);
  EXPECT_LT(d.momentum, 1e-4);
  EXPECT_LT(d.angular, 1e-4);
  EXPECT_LT(d.energy, 1 + 1e-3);
}

}  // namespace
}  // namespace dreampm

// Stages 2 and 3: what each particle contributes to the field: an ellipsoid and a weight.
#pragma once
#include <vector>

#include "dreampm/math/mat3.h"
#include "dreampm/surface/cells.h"

namespace dreampm::surface {

/// w(q) = (1 - q^2)^3 for q < 1; its integral over the unit ball.
inline constexpr float kKernelIntegral = 0.63830f;

/// A particle's contribution to the field at x is amount * w(q), q^2 = (x - centre) . form (x - centre).
struct Kernel {
  Vec3f centre;         ///< m
  Sym3<float> form;     ///< 1/m^2; eigenvalues 1/L^2, L at most `support`
  float amount = 0;     ///< 1 in the middle of the liquid, summed over the neighbours
  float smoothing = 1;  ///< how much of the smoothing the surface here can bear, 0..1
};

struct KernelSettings {
  float spacing;  ///< m
  float support;  ///< m
};

/// Round kernels of radius `support`, each of volume spacing^3.
std::vector<Kernel> round_kernels(std::span<const Vec3f> points, const KernelSettings& settings);

/// Divides each amount by g = f + 2 |shift|, where f is the field at the particle and shift the neighbours' weighted
/// mean offset in units of the kernel: g is 1 in a half-space of liquid, so that true sparsity and crowding alone are
/// corrected. `deep` cells are left as they are. `grid` must have been built from the centres.
void correct_amounts(std::vector<Kernel>& kernels, const CellGrid& grid, const std::vector<std::uint8_t>& deep,
                     const KernelSettings& settings);

}  // namespace dreampm::surface

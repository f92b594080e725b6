// Stages 2 and 3: what each particle contributes to the field: an ellipsoid and a weight.
#pragma once
#include <algorithm>
#include <vector>

#include "dreampm/math/mat3.h"
#include "dreampm/surface/cells.h"
#include "dreampm/surface/walls.h"

namespace dreampm::surface {

/// w(q) = (1 - q^2)^3 for q < 1; its integral over the unit ball.
inline constexpr float kKernelIntegral = 0.63830f;

/// A particle's contribution to the field at x is amount * w(q), q^2 = (x - center) . form (x -
/// center).
struct Kernel {
  Vec3f center;         ///< m
  Sym3<float> form;     ///< 1/m^2; eigenvalues 1/L^2, L at most `support`
  float amount = 0;     ///< 1 in the middle of the liquid, summed over the neighbors
  float smoothing = 1;  ///< how much of the smoothing the surface here can bear, 0..1
};

struct KernelSettings {
  float spacing;  ///< m
  float support;  ///< m
};

/// Stage 2. An ellipsoid for each real point from the second moment of its neighbors about the
/// point itself: round in a half-space, flat in sheets, long in threads (after Yu and Turk 2013,
/// who take it about the mean). Points of sheets and threads move towards the middle along the thin
/// axes only, so that the bulk does not shrink. A point without a neighbor gets amount 0: see
/// is_single. `grid` holds the points; points of `deep` cells stay round.
std::vector<Kernel> fit_kernels(const Mirrored& points, const CellGrid& grid, const std::vector<std::uint8_t>& deep,
                                const KernelSettings& settings);

/// A lone drop: it takes no part in the field and is given out as a sphere.
inline bool is_single(const Kernel& k) { return k.amount == 0; }

/// Stage 3. Divides each real kernel's amount by g = f + 2 |shift|, where f is the field at the
/// particle and shift the neighbors' weighted mean offset in units of the kernel: g is 1 in a
/// half-space of liquid, so that true sparsity and crowding alone are corrected. `deep` cells are
/// left as they are. `grid` holds the kernels' centers.
void correct_amounts(std::vector<Kernel>& kernels, std::size_t real, const CellGrid& grid,
                     const std::vector<std::uint8_t>& deep);

/// Makes the images' kernels mirror images of their sources' kernels.
void mirror_kernels(std::vector<Kernel>& kernels, const Mirrored& points);

}  // namespace dreampm::surface

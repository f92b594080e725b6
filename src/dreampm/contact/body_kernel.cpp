#include "dreampm/contact/body_kernel.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <utility>
#include <vector>

#include "dreampm/base/parallel.h"
#include "dreampm/contact/obstacle_nodes.h"
#include "dreampm/contact/thin_places.h"

namespace dreampm {
namespace {

constexpr int voxels = 4;  ///< of the table of kernels along a cell
constexpr int flags = 2;   ///< of thin places along a cell
/// Voxels on either side of a node whose weights are not 0: those of its kernel, and one more.
constexpr int reach = 3 * voxels / 2 + 1;
constexpr float half = 0.5f;  ///< values of kernels are 1/2 less the part inside
/// Half the diagonal of a cube over half its width.
constexpr double diagonal = 1.7321;

constexpr int side = BrickGrid::side;
/// Along each axis of a brick and of what its kernels reach.
constexpr int wide = side + 2 * reach;

/// The kernel over the voxels from a node: what lies in each. That voxels have one value, and that
/// the table is read between them, spreads the kernel: its second moment grows by 1/12 and 1/6 of a
/// voxel's square. The weights are sharpened by as much.
std::array<double, 2 * reach> kernel_by_voxel() {
  constexpr double spread = 1.0 / 12 + 1.0 / 6;
  const auto within = [](int k) {
    const double begin = static_cast<double>(k - reach) / voxels;
    return kernel_inside(begin) - kernel_inside(begin + 1.0 / voxels);
  };
  std::array<double, 2 * reach> weights{};
  for (int k = 0; k < 2 * reach; ++k)
    weights[static_cast<std::size_t>(k)] = within(k) - spread / 2 * (within(k - 1) - 2 * within(k) + within(k + 1));
  return weights;
}

/// A grid of voxels, `fine` along a cell, voxel 0 being the middle of a body.
class Voxels {
 public:
  Voxels(const ColliderView& view, const Vec3d& size, int fine) : view_(view), fine_(fine) {
    for (int a = 0; a < 3; ++a) high_[a] = static_cast<int>(std::ceil((0.5 * size[a] + 3) * fine / side));
  }
  /// Returns a voxel's place in the cells of the view.
  Vec3d at(const Vec3d& voxel) const { return voxel * (1.0 / fine_); }
  Vec3d at(const Vec3i& voxel) const { return at(static_cast<Vec3d>(voxel)); }
  double distance(const Vec3d& voxel) const { return view_.nearest(at(voxel)); }

  /// `fill_brick(brick, values)` for bricks as far as `band` [cells] from the surface; those deeper
  /// inside are `deep`, a constant of BrickGrid.
  template <class Fill>
  BrickGrid fill(double band, std::int32_t deep, const Fill& fill_brick) const {
    BrickGrid grid(Vec3i{} - high_, high_, half);
    const double near = band + diagonal * 0.5 * side / fine_;
    std::vector<std::size_t> open;
    for (std::size_t i = 0; i < grid.size(); ++i) {
      const double d = distance(static_cast<Vec3d>(grid.brick(i) * side) + Vec3d{1, 1, 1} * (0.5 * (side - 1)));
      if (std::abs(d) <= near)
        open.push_back(i);
      else if (d < 0)
        grid.slot(i) = deep;
    }
    for (const std::size_t i : open) grid.open(i, half);
    parallel_for(open.size(), 1, [&](std::size_t o) { fill_brick(grid.brick(open[o]), grid.values()[o]); });
    return grid;
  }

 private:
  const ColliderView& view_;
  int fine_;
  Vec3i high_{};
};

/// `value(voxel)` of all voxels of a brick.
template <class Value>
void for_each_voxel(const Vec3i& brick, BrickGrid::Values& values, const Value& value) {
  for (int n = 0; n < BrickGrid::volume; ++n)
    values[static_cast<std::size_t>(n)] = value(brick * side + Vec3i{n >> 6, n >> 3 & 7, n & 7});
}

/// Sums the parts of voxels that the solid fills, `filled`, over the kernels of a brick's nodes.
void add_up(const BrickGrid& filled, const Vec3i& brick, BrickGrid::Values& values) {
  static const std::array<double, 2 * reach> weights = kernel_by_voxel();
  const auto weight = [&](int k) { return weights[static_cast<std::size_t>(k)]; };
  // Axis after axis: what is summed along one is as long there as the brick.
  std::vector<double> from(std::size_t{wide} * wide * wide), to;
  for (int i = 0, n = 0; i < wide; ++i)
    for (int j = 0; j < wide; ++j)
      for (int k = 0; k < wide; ++k, ++n) {
        const Vec3i v = brick * side + Vec3i{i - reach, j - reach, k - reach};
        from[static_cast<std::size_t>(n)] = static_cast<double>(half - filled.at(v.x, v.y, v.z));
      }
  int size[3] = {wide, wide, wide};
  for (int a = 0; a < 3; ++a) {
    const int before = a == 0 ? 1 : a == 1 ? size[0] : size[0] * size[1];
    const int after = a == 0 ? size[1] * size[2] : a == 1 ? size[2] : 1;
    to.assign(static_cast<std::size_t>(before * side * after), 0);
    for (int b = 0; b < before; ++b)
      for (int i = 0; i < side; ++i)
        for (int k = 0; k < 2 * reach; ++k)
          for (int n = 0; n < after; ++n)
            to[static_cast<std::size_t>((b * side + i) * after + n)] +=
                weight(k) * from[static_cast<std::size_t>((b * wide + i + k) * after + n)];
    size[a] = side;
    from.swap(to);
  }
  for (std::size_t n = 0; n < values.size(); ++n)
    values[n] = half - std::clamp(static_cast<float>(from[n]), 0.0f, 1.0f);
}

/// True if the body is thin at a voxel or near it: as far as the cells beside the cell that holds
/// it.
bool thin_beside(const BrickGrid& thin, const Vec3i& voxel) {
  constexpr int around = 3 * flags / 2;
  for (int i = -around; i <= around; ++i)
    for (int j = -around; j <= around; ++j)
      for (int k = -around; k <= around; ++k)
        if (thin.at(voxel.x + i, voxel.y + j, voxel.z + k) < 0) return true;
  return false;
}

}  // namespace

BodyKernel::BodyKernel(const std::shared_ptr<const Region>& shape, double dx)
    : middle_(shape->bounds().center()), cells_a_meter_(1 / dx) {
  Collider alone;
  alone.shape = shape;
  const std::vector<PlacedCollider> placed{{alone, {Vec3d{}}}};
  const ColliderView view(placed, middle_, dx);
  const Vec3d size = shape->bounds().size() * cells_a_meter_;

  const Voxels fine(view, size, voxels);
  // Here a voxel is the cube that begins at its place.
  const BrickGrid filled = fine.fill(1, BrickGrid::inside, [&](const Vec3i& brick, BrickGrid::Values& values) {
    for_each_voxel(brick, values, [&](const Vec3i& voxel) {
      const double d = fine.distance(static_cast<Vec3d>(voxel) + Vec3d{0.5, 0.5, 0.5}) * voxels;
      return static_cast<float>(std::clamp(d, -0.5, 0.5));
    });
  });
  inside_ = fine.fill(1.5 * diagonal, BrickGrid::inside,
                      [&](const Vec3i& brick, BrickGrid::Values& values) { add_up(filled, brick, values); });

  const Voxels coarse(view, size, flags);
  std::atomic<bool> any = false;
  const BrickGrid thin = coarse.fill(1, BrickGrid::outside, [&](const Vec3i& brick, BrickGrid::Values& values) {
    for_each_voxel(brick, values, [&](const Vec3i& voxel) {
      if (!needs_distance(view, coarse.at(voxel), view.nearest(coarse.at(voxel)))) return half;
      any = true;
      return -half;
    });
  });
  any_thin_ = any;
  if (!any_thin_) return;
  thin_ = coarse.fill(thin_places_reach, BrickGrid::outside, [&](const Vec3i& brick, BrickGrid::Values& values) {
    for_each_voxel(brick, values, [&](const Vec3i& voxel) { return thin_beside(thin, voxel) ? -half : half; });
  });
}

double BodyKernel::inside(const Vec3d& p) const {
  return static_cast<double>(half) - inside_.sample((p - middle_) * (voxels * cells_a_meter_));
}

bool BodyKernel::is_thin(const Vec3d& p) const {
  const Vec3d v = (p - middle_) * (flags * cells_a_meter_);
  const auto nearest = [](double x) { return static_cast<int>(std::lround(x)); };
  return any_thin_ && thin_.at(nearest(v.x), nearest(v.y), nearest(v.z)) < 0;
}

}  // namespace dreampm

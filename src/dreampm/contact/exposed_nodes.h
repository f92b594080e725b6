// Distances from the exposed faces of colliders at nodes, each worked out once.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <unordered_map>

#include "dreampm/contact/collider_view.h"
#include "dreampm/state/grid.h"

namespace dreampm {

/// ColliderView::exposed at the nodes of a block and at those about it that its cells reach: nodes,
/// distances and surface points all ask for the same ones.
class ExposedNodes {
 public:
  /// `view` must outlive this.
  explicit ExposedNodes(const ColliderView& view) : view_(&view) {}
  const ColliderView& view() const { return *view_; }
  /// `node`: from -1 to 5 along each axis.
  const ColliderDistance& at(std::uint16_t collider, const Vec3i& node) {
    Known& all = known(collider);
    std::optional<ColliderDistance>& one = all.exposed[index(node)];
    if (!one) {
      const double d = all.distance[index(node)];
      one = d > ColliderView::slit ? ColliderDistance{d, {}} : view_->exposed(collider, static_cast<Vec3d>(node), d);
    }
    return *one;
  }
  /// ColliderView::distance there.
  double whole(std::uint16_t collider, const Vec3i& node) { return known(collider).distance[index(node)]; }

 private:
  static constexpr int width = block_width + 3;
  static constexpr std::size_t nodes = std::size_t{width} * width * width;
  static std::size_t index(const Vec3i& node) {
    return static_cast<std::size_t>(((node.x + 1) * width + node.y + 1) * width + node.z + 1);
  }
  struct Known {
    std::array<double, nodes> distance;
    std::array<std::optional<ColliderDistance>, nodes> exposed;
  };
  Known& known(std::uint16_t collider) {
    std::unique_ptr<Known>& all = known_[collider];
    if (!all) {
      all = std::make_unique<Known>();
      static const std::array<Vec3d, nodes> places = [] {
        std::array<Vec3d, nodes> lattice;
        for (int n = 0; n < static_cast<int>(nodes); ++n)
          lattice[static_cast<std::size_t>(n)] =
              static_cast<Vec3d>(Vec3i{n / (width * width) - 1, n / width % width - 1, n % width - 1});
        return lattice;
      }();
      view_->distances(collider, places, all->distance.data());
    }
    return *all;
  }

  const ColliderView* view_;
  std::unordered_map<std::uint16_t, std::unique_ptr<Known>> known_;
};

}  // namespace dreampm

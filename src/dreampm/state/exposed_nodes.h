// Distances from the exposed faces of colliders at nodes, each worked out once.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <unordered_map>

#include "dreampm/state/collider_view.h"
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
    std::optional<ColliderDistance>& known =
        known_[collider][static_cast<std::size_t>(((node.x + 1) * width + node.y + 1) * width + node.z + 1)];
    if (!known) known = view_->exposed(collider, static_cast<Vec3d>(node));
    return *known;
  }

 private:
  static constexpr int width = block_width + 3;
  const ColliderView* view_;
  std::unordered_map<std::uint16_t, std::array<std::optional<ColliderDistance>, width * width * width>> known_;
};

}  // namespace dreampm

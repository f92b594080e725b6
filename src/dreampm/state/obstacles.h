// What colliders mean to the nodes of a block: distances, normals and how much of a node's kernel they take. Worked out
// once a block, when matter first comes near.
#pragma once
#include <memory>
#include <unordered_map>
#include <vector>

#include "dreampm/base/hash.h"
#include "dreampm/state/world.h"

namespace dreampm {

struct ObstacleNode {
  std::uint8_t node;      ///< index within the block
  std::uint8_t collider;  ///< index within World::colliders
  bool inside;            ///< the node takes contact: its distance is <= 0
  float blocked;          ///< fraction of the node's kernel inside the collider
  Vec3d normal;           ///< outward
};

/// A cache over fixed colliders; not state: it can be thrown away at any time.
class Obstacles {
 public:
  /// Fills the cache for all grid blocks of the world; call after every regroup. Takes memory only for blocks that were
  /// never part of the grid, and for longer lists than ever.
  template <class R>
  void prepare(const World<R>& world);
  /// The nodes of that grid block that colliders touch; empty for most.
  const std::vector<ObstacleNode>& at(std::size_t grid_block) const {
    return by_block_[grid_block] ? *by_block_[grid_block] : none_;
  }
  bool any() const { return any_; }

 private:
  struct Key {
    std::size_t operator()(const Vec3i& b) const {
      return static_cast<std::size_t>(mix64((std::uint64_t(std::uint32_t(b.x)) << 40) ^
                                            (std::uint64_t(std::uint32_t(b.y)) << 20) ^ std::uint32_t(b.z)));
    }
  };
  using Nodes = std::vector<ObstacleNode>;
  std::unordered_map<Vec3i, std::unique_ptr<Nodes>, Key> cache_;  ///< null where no collider is near
  std::vector<Vec3i> blocks_;                                     ///< of the grid, as of by_block_
  std::vector<const Nodes*> by_block_, before_;                   ///< null alike
  std::vector<std::uint32_t> fresh_;                              ///< grid blocks that the cache does not know
  Nodes none_;
  bool any_ = false;
};

}  // namespace dreampm

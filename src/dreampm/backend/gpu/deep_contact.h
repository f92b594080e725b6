// Contact of nodes deep inside colliders on a device.
#pragma once
#include <cstdint>

#include "dreampm/backend/gpu/node_visit.h"

namespace dreampm::gpu {

/// How a collider's surface holds matter.
struct ColliderSurface {
  WallType type;
  float friction[2];  ///< by field
};
/// A node too deep inside a collider for contact at its surface; as ObstacleNode.
struct DeepNode {
  std::int32_t node;  ///< its number in its block
  Vec3<float> normal, velocity;
};
/// Those of one block in one collider.
struct DeepNodes {
  std::uint32_t begin, end;  ///< of its nodes
  std::int32_t collider;
};
/// A block of the grid that has some, of one collider after the other.
struct DeepBlock {
  std::uint32_t block, begin, end;  ///< of DeepNodes
};

/// Stops nodes at the colliders that hold them. A block of threads takes one that has some.
struct MeetDeep {
  static constexpr int threads = block_nodes;
  struct Shared {
    ImpulseTerms<float> given[threads];
  };
  VisitInput in;
  const DeepBlock* blocks;
  const DeepNodes* groups;
  const DeepNode* nodes;
  const ColliderSurface* colliders;
  SourceTerms* given;  ///< by group

  template <class Block>
  DM_FN void operator()(Block& block, Shared& shared) const {
    const DeepBlock at = blocks[block.index()];
    const Vec3i first = in.blocks[at.block].first;
    for (std::uint32_t g = at.begin; g < at.end; ++g) {
      const DeepNodes group = groups[g];
      add_up_fields<threads>(in.grid, block, shared.given, [&](int f, int t) {
        const std::uint32_t d = group.begin + static_cast<std::uint32_t>(t);
        if (d >= group.end) return ImpulseTerms<float>::none();
        return meet(nodes[d], colliders[group.collider], f,
                    in.grid.field[f][std::int64_t{at.block} * block_nodes + nodes[d].node]);
      });
      block.each_thread([&](int t) {
        if (t == 0) given[g] = in.places.about_origin(shared.given[0], first);
      });
    }
  }

 private:
  static DM_FN ImpulseTerms<float> meet(const DeepNode& at, const ColliderSurface& collider, int f, Node<float>& node) {
    ImpulseSumOf<float> sum;
    if (has_mass(node)) {
      const Vec3<float> before = velocity(node),
                        after =
                            contact(before - at.velocity, at.normal, collider.type, collider.friction[f]) + at.velocity;
      set_velocity(node, after);
      sum.add(static_cast<Vec3<float>>(node_offset(at.node)), node.m, before, after, after);
    }
    return ImpulseTerms<float>::of(sum);
  }
};

}  // namespace dreampm::gpu

// Contact of solids with liquids on a device, where solids have a field of their own: at nodes that
// hold both. As BlockVisit::apply_two_field_contact, and its part in a stage of viscosity.
#pragma once
#include <cstdint>

#include "dreampm/backend/gpu/stage_visit.h"
#include "dreampm/backend/solid_normal.h"

namespace dreampm::gpu {

/// The blocks of the grid that matter of both fields reaches. A block of threads takes one of them.
struct SharedNodes {
  static constexpr int threads = block_nodes;
  struct Shared {
    SolidMasses<float> solid;
    std::int32_t any;  ///< nodes that hold both
  };
  VisitInput in;
  const std::uint32_t* blocks;
  const std::int32_t* around;  ///< 27 each, as Neighbors
  SolidImages images;

  /// A node of both fields.
  struct Both {
    std::int64_t at;  ///< in the fields
    Node<float> liquid, solid;
    Vec3<float> normal;  ///< out of the solid, or zero
    float drag;          ///< as in slip_drag
  };
  /// Calls body(node) for each node that holds both.
  template <class Block, class Body>
  DM_FN void each(Block& block, Shared& shared, const Body& body) const {
    const std::int64_t first = std::int64_t{blocks[block.index()]} * block_nodes;
    block.each_thread([&](int t) {
      if (t == 0) shared.any = 0;
    });
    block.each_thread([&](int t) {
      if (holds_both(first + t)) Block::add(shared.any, 1);
    });
    if (shared.any == 0) return;
    const SolidImages near = images.from(in.blocks[blocks[block.index()]].first);
    const std::int32_t* const neighbors = around + 27 * std::int64_t{block.index()};
    block.each_thread([&](int t) {
      for (int i = t; i < SolidMasses<float>::count; i += threads)
        shared.solid.mass[i] = near.mass(SolidMasses<float>::place(i), [&](const Vec3i& at) {
          const std::int32_t b = neighbors[block_around(at)];
          constexpr int last = block_width - 1;
          return b < 0
                     ? 0.0f
                     : in.grid
                           .field[1][std::int64_t{b} * block_nodes + node_index(at.x & last, at.y & last, at.z & last)]
                           .m;
        });
    });
    block.each_thread([&](int t) {
      const std::int64_t at = first + t;
      if (!holds_both(at)) return;
      const Node<float> liquid = in.grid.field[0][at], solid = in.grid.field[1][at];
      const float viscosity = mixture::viscosity(in.grid.mixture[at]);
      body(Both{at, liquid, solid, shared.solid.normal_at(t),
                slip_drag(in.step.diffusion * viscosity / liquid.m, liquid.m, solid.m)});
    });
  }

 private:
  DM_FN bool holds_both(std::int64_t at) const {
    return has_mass(in.grid.field[0][at]) && has_mass(in.grid.field[1][at]);
  }
};

/// Matter of the two fields may part, but not enter each other.
struct MeetSolids {
  static constexpr int threads = SharedNodes::threads;
  using Shared = SharedNodes::Shared;
  SharedNodes nodes;

  template <class Block>
  DM_FN void operator()(Block& block, Shared& shared) const {
    const VisitInput& in = nodes.in;
    nodes.each(block, shared, [&](const SharedNodes::Both& both) {
      Vec3<float> v = velocity(both.liquid), w = velocity(both.solid);
      two_field_contact(v, both.liquid.m, w, both.solid.m, both.normal, in.step.unstaged(both.drag));
      set_velocity(in.grid.field[0][both.at], v);
      set_velocity(in.grid.field[1][both.at], w);
    });
  }
};

/// Its drag in a stage, after all other forces of it. Without a normal both move as one anyway.
struct DragSolids {
  static constexpr int threads = SharedNodes::threads;
  using Shared = SharedNodes::Shared;
  SharedNodes nodes;
  StageInput stage;

  template <class Block>
  DM_FN void operator()(Block& block, Shared& shared) const {
    const VisitInput& in = nodes.in;
    nodes.each(block, shared, [&](const SharedNodes::Both& both) {
      const Vec3<float>& n = both.normal;
      if (!(dot(n, n) > 0)) return;
      const Vec3<float> liquid = velocity(stage.field[0].old[both.at]), solid = velocity(stage.field[1].old[both.at]),
                        slip = liquid - solid, along = slip - n * dot(slip, n);
      Vec3<float> v = velocity(stage.field[0].change[both.at]), w = velocity(stage.field[1].change[both.at]);
      exchange_velocity(along * (stage.gain * min(both.drag, in.step.staged_drag)), v, both.liquid.m, w, both.solid.m);
      const Vec3<float> change[2] = {v, w}, before[2] = {liquid, solid};
      for (int f = 0; f < 2; ++f) {
        set_velocity(stage.field[f].change[both.at], change[f]);
        set_velocity(in.grid.field[f][both.at], before[f] + change[f]);
      }
    });
  }
};

}  // namespace dreampm::gpu

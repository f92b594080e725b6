// The visit of the grid's nodes in a stage of viscosity on a device: as BlockVisit::rkl_stage and
// store_increment.
#pragma once
#include <cstdint>

#include "dreampm/backend/gpu/node_visit.h"

namespace dreampm::gpu {

/// A stage, as RklStage.
struct StageInput {
  struct Field {
    const Node<float>* momenta;  ///< of viscosity
    const Node<float>* stress;   ///< or null
    Node<float>*old, *change;
  };
  float keep, gain;
  double part;
  Vec3<float> kick;
  bool first;  ///< whether no change was before
  Field field[2];
  SourceTerms* dragged;  ///< impulses of boundary layers, as VisitInput::given; null without
  SourceTerms* driven;   ///< by block of the grid; `work`: of gravity and stress
};

/// The forces of a stage; contact with walls too, where the block does not wait. A block of threads
/// takes a block of the grid.
struct BeginStage {
  static constexpr int threads = block_nodes;
  using Shared = BlockBoundaries::Shared;
  VisitInput in;
  StageInput stage;

  template <class Block>
  DM_FN void operator()(Block& block, Shared& shared) const {
    const int b = block.index();
    const std::int64_t first = std::int64_t{b} * block_nodes;
    block.each_thread([&](int t) {
      shared.terms[t] = NodeTerms<float>::none();
      for (int f = 0; f < 2 && in.grid.field[f]; ++f) shared.terms[t].mass += force(f, first + t);
    });
    add_up_threads<threads>(block, shared.terms);
    block.each_thread([&](int t) {
      if (t != 0) return;
      GridTerms sum = GridTerms::none();
      sum.mass = shared.terms[0].mass;
      shared.sum = in.sums[b] = sum;
    });
    if (stage.dragged) drag(block, shared, b);
    block.each_thread([&](int t) {
      for (int f = 0; f < 2 && in.grid.field[f]; ++f)
        if (Node<float>& node = in.grid.field[f][first + t]; has_mass(node))
          set_velocity(node, velocity(node) + velocity(stage.field[f].change[first + t]));
    });
    if (!in.blocks[b].waits && !in.all_wait) BlockBoundaries::finish(in, block, shared, b);
  }

 private:
  /// Returns the node's mass, where it has any.
  DM_FN float force(int f, std::int64_t at) const {
    const StageInput::Field& of = stage.field[f];
    const Node<float> node = in.grid.field[f][at];
    if (!has_mass(node)) return 0;
    of.old[at] = node;
    Vec3<float> given = velocity(of.momenta[at]);
    if (of.stress) given += velocity(of.stress[at]);
    const Vec3<float> before = stage.first ? Vec3<float>{0, 0, 0} : velocity(of.change[at]);
    set_velocity(of.change[at], stage_change(before, given, node.m, stage.keep, stage.gain, stage.kick));
    return node.m;
  }
  /// The boundary layers of walls.
  template <class Block>
  DM_FN void drag(Block& block, Shared& shared, int b) const {
    const VisitBlock at = in.blocks[b];
    for (int side = 0; at.entries >= 0 && side < 6; ++side) {
      const std::int32_t entry = in.entries[at.entries + side];
      if (entry < 0) continue;
      block.each_thread([&](int t) { shared.given[t] = slow(std::int64_t{b} * block_nodes + t, side, at.first, t); });
      add_up_threads<threads>(block, shared.given);
      block.each_thread([&](int t) {
        if (t == 0) stage.dragged[entry] = in.places.about_origin(shared.given[0], at.first);
      });
    }
  }
  DM_FN ImpulseTerms<float> slow(std::int64_t at, int side, const Vec3i& first, int n) const {
    ImpulseSumOf<float> given;
    BoundaryLayer<float> layer;
    const Node<float> node = in.grid.field[0][at];
    if (has_mass(node) &&
        boundary_layer(in.step, side, first + node_offset(n), node, mixture::viscosity(in.grid.mixture[at]), layer)) {
      const Vec3<float> lost = lost_in_stage(in.step, layer, stage.gain), before = velocity(node),
                        after = before - lost;
      Node<float>& change = stage.field[0].change[at];
      set_velocity(change, velocity(change) - lost);
      given.add(static_cast<Vec3<float>>(node_offset(n)), node.m, before, after, after);
    }
    return ImpulseTerms<float>::of(given);
  }
};

/// Keeps the change of each node as contact left it, and the work of forces.
struct EndStage {
  static constexpr int threads = block_nodes;
  struct Shared {
    ImpulseTerms<float> driven[threads];
  };
  VisitInput in;
  StageInput stage;

  template <class Block>
  DM_FN void operator()(Block& block, Shared& shared) const {
    const int b = block.index();
    add_up_fields<threads>(in.grid, block, shared.driven, [&](int f, int t) {
      return ImpulseTerms<float>::of_work(keep(f, std::int64_t{b} * block_nodes + t));
    });
    block.each_thread([&](int t) {
      if (t == 0) stage.driven[b] = SourceTerms::of_work(0.5 * stage.part * static_cast<double>(shared.driven[0].work));
    });
  }

 private:
  DM_FN float keep(int f, std::int64_t at) const {
    const StageInput::Field& of = stage.field[f];
    const Node<float> node = in.grid.field[f][at];
    if (!has_mass(node)) return 0;
    const Vec3<float> before = velocity(of.old[at]), now = velocity(node);
    if (!(now == before + velocity(of.change[at]))) set_velocity(of.change[at], now - before);
    const Vec3<float> stress = of.stress ? velocity(of.stress[at]) : Vec3<float>{0, 0, 0};
    return driven_work2(stage.kick, stress, node.m, before, now);
  }
};

}  // namespace dreampm::gpu

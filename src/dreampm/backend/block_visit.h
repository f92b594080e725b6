// The visit of one block of the grid, in a step and in its viscous stages.
#pragma once
#include <bit>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "dreampm/backend/contact_gap.h"
#include "dreampm/backend/solid_mass.h"
#include "dreampm/state/force_fields.h"

namespace dreampm {

/// Returns the walls as a field's matter feels them: friction is for solids and grains.
template <class R>
BoxWalls<R> box_walls(const World<R>& world, std::size_t field) {
  const bool frictional = !world.holds_liquid(field);
  BoxWalls<R> w;
  for (int a = 0; a < 3; ++a) w.low[a] = world.low[a], w.high[a] = world.high[a];
  for (int s = 0; s < 6; ++s)
    w.type[s] = world.walls[s].type, w.friction[s] = static_cast<R>(frictional ? world.walls[s].friction : 0);
  return w;
}

/// True if contact of that node acts at the node itself: it is too deep inside for contact at the
/// surface, or is inside where there is none.
template <class R>
bool acts_within(const World<R>& world, const ObstacleNode& o) {
  return o.deep || (o.inside && !world.settings.surface_contact);
}

/// The results of the visit of one block.
struct BlockStats {
  enum Source : std::size_t { first_wall = 0, damping = 6, fields = 7, first_collider = 8 };

  NodeSums sums;
  double arrived2 = 0;       ///< twice GridStats::arrived [J]
  double external_work = 0;  ///< J: what gravity and stress did in a stage
  /// Impulses of the sources that acted: most blocks have none or one.
  std::vector<std::pair<std::size_t, ImpulseSum>> impulses;

  void clear() {
    sums = {};
    arrived2 = external_work = 0;
    impulses.clear();
  }
  ImpulseSum& impulse_of(std::size_t source) {
    for (auto& [who, sum] : impulses)
      if (who == source) return sum;
    return impulses.emplace_back(source, ImpulseSum{}).second;
  }
};

/// The constants of a step. `of_step`: the part of viscous contact that is left to this visit; 1 if
/// there are no stages, 0 if this is what comes before them.
template <class R>
NodeConstants<R> node_constants(const World<R>& w, double dt, double of_step) {
  NodeConstants<R> step{{box_walls(w, 0), box_walls(w, 1)},
                        static_cast<Vec3<R>>(w.viscous_stages == 0 ? w.gravity_over(dt) * dt : Vec3d{}),
                        static_cast<R>(std::exp(-w.settings.damping * dt)),
                        static_cast<R>(dt / (w.dx * w.dx)),
                        static_cast<R>(w.dx),
                        static_cast<R>(w.dx / dt),
                        of_step > 0 && w.has_skin_friction() && !w.grid.mixture.empty(),
                        {},
                        static_cast<R>(w.viscous_stages == 0 ? 0 : stage_drag * w.viscosity * dt / (w.dx * w.dx)),
                        static_cast<R>(of_step)};
  for (std::size_t side = 0; side < 6; ++side) step.slows[side] = w.walls[side].skin_friction;
  return step;
}

/// What all nodes see in one step.
template <class R>
struct NodeStep : NodeConstants<R> {
  const World<R>& world;
  FieldSteps<R> fields;

  NodeStep(const World<R>& w, double dt, double of_step)
      : NodeConstants<R>(node_constants(w, dt, of_step)), world(w), fields(w, dt) {}
};

/// The numbers of stage `stage` of `stages` of RKL1: mu_j = (2 j - 1)/j, nu_j = (1 - j)/j = 1 -
/// mu_j, and all of it 2/(s^2 + s) of the step; a stage ends at (j^2 + j)/(s^2 + s) of it.
struct RklFactors {
  double kept, gain;  ///< of the change before, and of what the whole step would give
  double part;        ///< of the step, that the stage adds
  RklFactors(int stages, int stage)
      : kept((stage - 1.0) / stage), gain((2.0 * stage - 1) / stage * unit(stages)), part(stage * unit(stages)) {}

 private:
  static double unit(double stages) { return 2 / (stages * (stages + 1)); }
};

/// One of the stages of a sub-cycled step: y_j = y_(j-1) + keep (y_(j-1) - y_(j-2)) + gain (f +
/// L(y_(j-1))), f and L of the whole step. Differences are kept and not y_(j-2), so that rounding
/// does not grow from stage to stage.
template <class R>
struct RklStage {
  R keep, gain;
  double part;                           ///< of the step, that this stage adds
  Vec3<R> kick;                          ///< m/s, of gravity in the whole step
  const GridFields<R>& momenta;          ///< of L, that of viscosity within the matter
  std::array<Nodes<R>, 2>&old, &change;  ///< by field: y_(j-1), and the difference in all stages
};

/// Nodes of a block with coordinate `i` along an axis, a bit each.
constexpr std::uint64_t plane_of(int axis, int i) {
  constexpr std::uint64_t first[3] = {0xffff, 0x000f000f000f000f, 0x1111111111111111};
  return first[axis] << (node_step[axis] * i);
}

/// Returns a bit for each node of a block that lies on a wall or behind it.
template <class R>
std::uint64_t nodes_at_walls(const World<R>& world, const Vec3i& block) {
  std::uint64_t nodes = 0;
  for (int a = 0; a < 3; ++a)
    for (int i = 0; i < block_width; ++i) {
      const std::int32_t at = block[a] * block_width + i;
      if (at <= world.low[a] || at >= world.high[a]) nodes |= plane_of(a, i);
    }
  return nodes;
}

/// The nodes of one block, of one field or two.
template <class R>
class BlockVisit {
  using enum BlockStats::Source;

 public:
  /// `at_walls`: nodes on walls or behind, a bit each.
  BlockVisit(const NodeStep<R>& step, const NodeLoops<R>& loops, World<R>& world, const Obstacles& obstacles,
             const ContactGaps& gaps, std::size_t block, std::uint64_t at_walls, BlockStats& found)
      : step_(step),
        loops_(loops),
        world_(world),
        block_(block),
        first_(world.grid.blocks[block] * block_width),
        at_walls_(at_walls),
        near_(obstacles.at(block)),
        gaps_(gaps),
        found_(found) {}

  /// Momentum to velocity, damping, gravity, force fields. Their impulses [kg m/s] go to
  /// `field_impulses`, by field and node; their work is not known yet.
  void momentum_to_velocity(std::array<std::vector<Vec3<R>>, 2>& field_impulses) {
    found_.clear();
    const bool damped = step_.keep != R(1), fielded = step_.fields.any_in(world_, world_.grid.blocks[block_]);
    for (std::size_t f = 0; f < 2; ++f) {
      Node<R>* const nodes = field(f);
      if (!nodes) continue;
      if (Node<R>* const before = in_block(world_.grid.velocity_old[f]))
        for (int n = 0; n < block_nodes; ++n)
          found_.arrived2 +=
              static_cast<double>(normalize_old_velocity(before[n], static_cast<R>(1 / world_.kept_share(f))));
      if (damped)
        for_matter(nodes, [&](Node<R>& node, int n) {
          const Vec3<R> v = velocity(node) * (R(1) / node.m);
          record(found_.impulse_of(damping), n, node, v, v * step_.keep);
        });
      loops_.momentum_to_velocity(nodes, step_.keep, step_.kick, found_.sums);
      if (Vec3<R>* const field_impulse = in_block(field_impulses[f]); fielded)
        for_matter(nodes, [&](Node<R>& node, int n) {
          const Vec3<R> free = velocity(node), v = step_.fields.apply(free, place(n));
          found_.impulse_of(fields).add(place(n), static_cast<double>(node.m), static_cast<Vec3d>(free),
                                        static_cast<Vec3d>(v), {});
          field_impulse[n] = (v - free) * node.m;
          set_velocity(node, v);
        });
    }
  }

  /// Instead of momentum_to_velocity, in a stage of viscosity.
  void rkl_stage(const RklStage<R>& stage) {
    found_.clear();
    for (std::size_t f = 0; f < 2; ++f) {
      Node<R>* const nodes = field(f);
      if (!nodes) continue;
      const Node<R>* const momenta = in_block(stage.momenta.field(f));
      const Node<R>* const stress = in_block(world_.grid.stress[f]);
      Node<R>* const old = in_block(stage.old[f]);
      Node<R>* const change = in_block(stage.change[f]);
      for_matter(nodes, [&](Node<R>& node, int n) {
        old[n] = node;
        Vec3<R> given = velocity(momenta[n]);
        if (stress) given += velocity(stress[n]);
        set_velocity(change[n], stage_change(velocity(change[n]), given, node.m, stage.keep, stage.gain, stage.kick));
        found_.sums.mass += static_cast<double>(node.m);
      });
    }
    stage_solid_drag(stage);
    stage_wall_drag(stage);
    for (std::size_t f = 0; f < 2; ++f)
      if (Node<R>* const nodes = field(f)) {
        const Node<R>* const change = in_block(stage.change[f]);
        for_matter(nodes, [&](Node<R>& node, int n) { set_velocity(node, velocity(node) + velocity(change[n])); });
      }
  }
  /// Stores the increment as contact left it.
  void store_increment(const RklStage<R>& stage) {
    for (std::size_t f = 0; f < 2; ++f) {
      Node<R>* const nodes = field(f);
      if (!nodes) continue;
      const Node<R>* const old = in_block(stage.old[f]);
      const Node<R>* const stress = in_block(world_.grid.stress[f]);
      Node<R>* const change = in_block(stage.change[f]);
      for_matter(nodes, [&](Node<R>& node, int n) {
        const Vec3<R> before = velocity(old[n]), now = velocity(node);
        const Vec3<R> driven = stress ? velocity(stress[n]) : Vec3<R>{};
        found_.external_work +=
            0.5 * stage.part * static_cast<double>(driven_work2(stage.kick, driven, node.m, before, now));
        if (!(now == before + velocity(change[n]))) set_velocity(change[n], now - before);
      });
    }
  }

  /// Solid against liquid, where solids have a field. For this blocks look at the masses of those
  /// around them.
  void apply_two_field_contact() const {
    if (!(found_.sums.mass > 0)) return;
    for_shared_nodes(field(0), field(1), [&](Node<R>& node, Node<R>& solid, const Vec3<R>& normal, const R& drag, int) {
      Vec3<R> v = velocity(node), w = velocity(solid);
      two_field_contact(v, node.m, w, solid.m, normal, step_.unstaged(drag));
      set_velocity(node, v);
      set_velocity(solid, w);
    });
  }
  /// Colliders, walls; then sums. Nobody else may be looking at the block.
  void apply_boundaries() {
    if (!(found_.sums.mass > 0)) return;
    for (Node<R>* const nodes : {field(0), field(1)}) {
      if (!nodes) continue;
      collider_contact(nodes);
      box_contact(nodes);
      loops_.measure(nodes, found_.sums);
    }
  }

 private:
  auto* in_block(auto& all) const { return all.empty() ? nullptr : all.data() + block_ * block_nodes; }
  Node<R>* field(std::size_t f) const { return in_block(world_.grid.field(f)); }
  template <class Body>
  void for_matter(Node<R>* nodes, const Body& body) const {
    for (int n = 0; n < block_nodes; ++n)
      if (has_mass(nodes[n])) body(nodes[n], n);
  }

  /// Calls body(liquid node, solid node, normal out of the solid, drag as in slip_drag, number of
  /// the node).
  template <class Body>
  void for_shared_nodes(Node<R>* nodes, Node<R>* solids, const Body& body) const {
    const Node<R>* const mixed = in_block(world_.grid.mixture);
    std::optional<SolidMass<R>> solid_mass;
    for_matter(nodes, [&](Node<R>& node, int n) {
      if (!has_mass(solids[n])) return;
      if (!solid_mass) solid_mass.emplace(world_, block_);
      body(node, solids[n], solid_mass->normal_at(n),
           slip_drag(step_.diffusion * mixture::viscosity(mixed[n]) / node.m, node.m, solids[n].m), n);
    });
  }
  /// The force of that drag in a stage. Without a normal both move as one anyway.
  void stage_solid_drag(const RklStage<R>& stage) {
    Node<R>* const solids = field(1);
    if (!solids) return;
    Node<R>* const change = in_block(stage.change[0]);
    Node<R>* const solid_change = in_block(stage.change[1]);
    for_shared_nodes(field(0), solids, [&](Node<R>& node, Node<R>& solid, const Vec3<R>& normal, const R& drag, int n) {
      if (!(dot(normal, normal) > R(0))) return;
      const Vec3<R> slip = velocity(node) - velocity(solid), along = slip - normal * dot(slip, normal);
      Vec3<R> v = velocity(change[n]), w = velocity(solid_change[n]);
      exchange_velocity(along * (stage.gain * std::min(drag, step_.staged_drag)), v, node.m, w, solid.m);
      set_velocity(change[n], v);
      set_velocity(solid_change[n], w);
    });
  }
  /// Nodes too deep inside for contact at the surface, or all inside where there is none.
  void collider_contact(Node<R>* nodes) {
    const bool frictional = !world_.holds_liquid(nodes == field(0) ? 0 : 1);
    for (const ObstacleNode& o : near_) {
      Node<R>& node = nodes[o.node];
      if (!acts_within(world_, o) || !has_mass(node)) continue;
      const Collider& collider = world_.colliders[o.collider];
      const Vec3<R> before = velocity(node), surface = static_cast<Vec3<R>>(o.velocity);
      set_velocity(node, contact(before - surface, static_cast<Vec3<R>>(o.normal), collider.contact(),
                                 static_cast<R>(frictional ? collider.friction : 0)) +
                             surface);
      record_contact(found_.impulse_of(first_collider + o.collider), place(o.node), node, before, velocity(node));
    }
  }
  void box_contact(Node<R>* nodes) {
    if (!at_walls_) return;
    const std::size_t f = nodes == field(0) ? 0 : 1;
    const BoxWalls<R> felt = step_.walls[f].from(first_);
    const bool gapped = gaps_.has(world_, f);
    alignas(64) R approach[block_nodes];
    ImpulseSum walls[6];
    for (int side = 0; side < 6; ++side) {
      if (felt.type[side] == WallType::open || !felt.reaches(side, block_width)) continue;
      if (gapped) find_approach(side, approach);
      loops_.box_contact(nodes, felt, side, gapped ? approach : nullptr, walls[side]);
    }
    if (step_.skin && nodes == field(0))
      for (std::uint64_t left = at_walls_; left; left &= left - 1) {
        const int n = std::countr_zero(left);
        if (has_mass(nodes[n])) wall_friction(nodes[n], n, walls);
      }
    add_walls(walls);
  }

  /// The speed at which matter at each node may come nearer to that wall [m/s].
  void find_approach(int side, R (&approach)[block_nodes]) const {
    const WallGap* const gap = gaps_.at_wall(block_, side);
    const int a = axis_of(side), b = (a + 1) % 3, c = (a + 2) % 3;
    for (int n = 0; n < block_nodes; ++n) {
      const Vec3i at = node_offset(n);
      approach[n] =
          gap ? static_cast<R>((*gap)[static_cast<std::size_t>(at[b] * block_width + at[c])]) * step_.per_dt : R(0);
    }
  }

  /// Calls body(side, layer) for the boundary layers of walls on which a liquid's node `n` lies,
  /// unless it leaves them.
  template <class Body>
  void for_boundary_layers(const Node<R>& node, int n, const Body& body) const {
    const Vec3i at = first_ + node_offset(n);
    BoundaryLayer<R> layer;
    for (int side = 0; side < 6; ++side)
      if (boundary_layer(step_, side, at, node, mixture::viscosity(in_block(world_.grid.mixture)[n]), layer))
        body(side, layer);
  }
  void wall_friction(Node<R>& node, int n, ImpulseSum (&walls)[6]) const {
    for_boundary_layers(node, n, [&](int side, const BoundaryLayer<R>& layer) {
      const Vec3<R> before = velocity(node);
      set_velocity(node, after_layer(step_, before, layer));
      record_contact(walls[side], place_in_block(n), node, before, velocity(node));
    });
  }
  /// The force of that drag in a stage.
  void stage_wall_drag(const RklStage<R>& stage) {
    if (!at_walls_ || !step_.skin) return;
    const Node<R>* const nodes = field(0);
    Node<R>* const change = in_block(stage.change[0]);
    ImpulseSum walls[6];
    for (std::uint64_t left = at_walls_; left; left &= left - 1) {
      const int n = std::countr_zero(left);
      if (!has_mass(nodes[n])) continue;
      for_boundary_layers(nodes[n], n, [&](int side, const BoundaryLayer<R>& layer) {
        const Vec3<R> lost = lost_in_stage(step_, layer, stage.gain), before = velocity(nodes[n]);
        set_velocity(change[n], velocity(change[n]) - lost);
        record_contact(walls[side], place_in_block(n), nodes[n], before, before - lost);
      });
    }
    add_walls(walls);
  }
  /// `walls`: with places in the block.
  void add_walls(const ImpulseSum (&walls)[6]) {
    for (std::size_t side = 0; side < 6; ++side)
      if (!(walls[side] == ImpulseSum{}))
        found_.impulse_of(first_wall + side) += walls[side].from_cells(place(0), world_.dx);
  }

  Vec3d place(int n) const { return world_.node_position(first_ + node_offset(n)); }
  void record(ImpulseSum& impulses, int n, const Node<R>& node, const Vec3<R>& before, const Vec3<R>& after) const {
    if (before == after) return;
    const Vec3d from = static_cast<Vec3d>(before), to = static_cast<Vec3d>(after);
    impulses.add(place(n), static_cast<double>(node.m), from, to, (from + to) * 0.5);
  }
  static void record_contact(ImpulseSum& impulses, const Vec3d& at, const Node<R>& node, const Vec3<R>& before,
                             const Vec3<R>& after) {
    if (before == after) return;
    const Vec3d to = static_cast<Vec3d>(after);
    impulses.add(at, static_cast<double>(node.m), static_cast<Vec3d>(before), to, to);
  }

  const NodeStep<R>& step_;
  const NodeLoops<R>& loops_;
  World<R>& world_;
  std::size_t block_;
  Vec3i first_;
  std::uint64_t at_walls_;
  const std::vector<ObstacleNode>& near_;
  const ContactGaps& gaps_;
  BlockStats& found_;
};

}  // namespace dreampm

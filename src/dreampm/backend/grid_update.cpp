// The one visit of every grid node in a step.
#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>

#include "dreampm/backend/common.h"
#include "dreampm/backend/flush_to_zero.h"
#include "dreampm/base/crew.h"
#include "dreampm/state/force_fields.h"

namespace dreampm {
namespace {

constexpr std::size_t blocks_at_once = 8, blocks_a_sum = 32;

template <class R>
BoxWalls<R> box_walls(const World<R>& world) {
  BoxWalls<R> w;
  for (int a = 0; a < 3; ++a) w.low[a] = world.low[a], w.high[a] = world.high[a];
  for (int s = 0; s < 6; ++s) w.type[s] = world.walls[s].type, w.friction[s] = static_cast<R>(world.walls[s].friction);
  return w;
}

template <class R>
Vec3<R> velocity(const Node<R>& node) {
  return {node.x, node.y, node.z};
}
/// Leaves the mass alone: other blocks may be reading it.
template <class R>
void set_velocity(Node<R>& node, const Vec3<R>& v) {
  node.x = v.x, node.y = v.y, node.z = v.z;
}

/// The solid mass around the nodes of one block, and its images in the walls of the box: without them a normal beside a
/// wall would lean on it, and liquid would leak along the wall past a solid that fills the box.
template <class R>
class SolidMass {
 public:
  SolidMass(const World<R>& world, std::size_t block)
      : grid_(world.grid), around_(neighbours_of(world, world.grid.blocks[block])) {
    const Vec3i first = world.grid.blocks[block] * block_width;
    for (int side = 0; side < 6; ++side) {
      const int a = side / 2;
      const bool mirrors = world.settings.keep_inside && !world.periodic[static_cast<std::size_t>(a)] &&
                           world.walls[static_cast<std::size_t>(side)].type != WallType::open;
      plane_[side] = mirrors ? (side % 2 == 0 ? world.low[a] : world.high[a]) - first[a] : far;
    }
  }

  /// The unit normal out of the solid: down the gradient of its mass over the 27 nodes around, the differences smoothed
  /// across by 1 2 1; zero where the mass has no clear slope.
  Vec3<R> normal_at(int n) const {
    const int i = n / 16, j = n / 4 % 4, k = n % 4;
    constexpr int smooth[3] = {1, 2, 1};
    Vec3<R> uphill{};
    R sum(0);
    for (int x = 0; x < 3; ++x)
      for (int y = 0; y < 3; ++y)
        for (int z = 0; z < 3; ++z) {
          const R m = mass({i + x - 1, j + y - 1, k + z - 1});
          uphill += Vec3<R>{R((x - 1) * smooth[y] * smooth[z]), R((y - 1) * smooth[z] * smooth[x]),
                            R((z - 1) * smooth[x] * smooth[y])} *
                    m;
          sum += m * R(smooth[x] * smooth[y] * smooth[z]);
        }
    const R steep = length(uphill);
    return steep > R(1e-3) * sum ? uphill * (R(-1) / steep) : Vec3<R>{};
  }

 private:
  static constexpr int far = 1 << 20;

  /// At a node of the block or next to it, with the images across the axes from `axis` on.
  R mass(const Vec3i& at, int axis = 0) const {
    if (axis == 3) return own_mass(at.x, at.y, at.z);
    R sum = mass(at, axis + 1);
    for (const int plane : {plane_[2 * axis], plane_[2 * axis + 1]}) {
      if (std::abs(at[axis] - plane) > 1) continue;
      Vec3i image = at;
      image[axis] = 2 * plane - at[axis];
      sum += mass(image, axis + 1);
    }
    return sum;
  }
  R own_mass(int i, int j, int k) const {
    const int side = (((i + 4) / 4) * 3 + (j + 4) / 4) * 3 + (k + 4) / 4;
    const std::int32_t block = around_[static_cast<std::size_t>(side)];
    if (block == BlockList::none) return R(0);
    const std::size_t first = static_cast<std::size_t>(block) * block_nodes;
    return grid_.solids[first + static_cast<std::size_t>(node_index(i & 3, j & 3, k & 3))].m;
  }

  const Carried<R>& grid_;
  Neighbours around_;
  int plane_[6];  ///< of the walls, in nodes of the block
};

/// What the visit of one block found.
struct BlockFound {
  NodeSums sums;
  double arrived2 = 0;       ///< twice GridStats::arrived [J]
  double driven = 0;         ///< J: what gravity and stress did in a stage
  std::vector<Push> pushes;  ///< by Giver, then the colliders; empty where none of them can act

  void clear() {
    sums = {};
    arrived2 = driven = 0;
    pushes.clear();
  }
};
enum Giver : std::size_t { first_wall = 0, damping = 6, fields = 7, first_collider = 8 };

/// What is the same for all nodes in one step.
template <class R>
struct NodeStep {
  const World<R>& world;
  FieldSteps<R> fields;
  BoxWalls<R> walls;
  Vec3<R> kick;
  R keep;       ///< of the velocity, by damping
  R diffusion;  ///< dt/dx^2 [s/m^2], of the part of the step in which contact is viscous
  R dx;         ///< m
  bool skin;    ///< whether a wall slows liquids by its boundary layer

  /// `part`: of dt in which gravity acts and contact is viscous.
  NodeStep(const World<R>& w, double dt, double part)
      : world(w),
        fields(w, dt),
        walls(box_walls(w)),
        kick(static_cast<Vec3<R>>(w.gravity_over(dt) * (part * dt))),
        keep(static_cast<R>(std::exp(-w.settings.damping * dt))),
        diffusion(static_cast<R>(part * dt / (w.dx * w.dx))),
        dx(static_cast<R>(w.dx)),
        skin(part > 0 && w.has_skin_friction() && !w.grid.liquid.empty()) {}
};

/// One of the stages of a sub-cycled step: y_j = y_(j-1) + keep (y_(j-1) - y_(j-2)) + gain (f + L(y_(j-1))), f and L of
/// the whole step. Differences are kept and not y_(j-2), so that rounding does not grow from stage to stage.
template <class R>
struct Stage {
  R keep, gain;
  double part;                                       ///< of the step, that this stage adds
  Vec3<R> kick;                                      ///< m/s, of gravity in the whole step
  const Carried<R>& momenta;                         ///< L: of viscosity
  std::array<std::vector<Node<R>>, 2>&old, &change;  ///< by field: y_(j-1), and the difference in all stages
};

/// Nodes of a block with coordinate `i` along an axis, a bit each.
constexpr std::uint64_t plane_of(int axis, int i) {
  constexpr std::uint64_t first[3] = {0xffff, 0x000f000f000f000f, 0x1111111111111111};
  constexpr int apart[3] = {16, 4, 1};
  return first[axis] << (apart[axis] * i);
}

/// Those on walls or behind.
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
 public:
  /// `at_walls`: nodes on walls or behind, a bit each.
  BlockVisit(const NodeStep<R>& step, const NodeLoops<R>& loops, World<R>& world, const Obstacles& obstacles,
             std::size_t block, std::uint64_t at_walls, BlockFound& found)
      : step_(step),
        loops_(loops),
        world_(world),
        block_(block),
        first_(world.grid.blocks[block] * block_width),
        at_walls_(at_walls),
        near_(obstacles.at(block)),
        found_(found) {}

  /// Momentum to velocity, damping, gravity, force fields.
  void release() {
    found_.clear();
    const bool damped = step_.keep != R(1), fielded = step_.fields.any();
    if (damped || fielded || at_walls_ || !near_.empty())
      found_.pushes.resize(first_collider + world_.colliders.size());
    for (std::size_t f = 0; f < 2; ++f) {
      Node<R>* const nodes = field(f);
      if (!nodes) continue;
      if (Node<R>* const before = in_block(world_.grid.before[f]))
        keep_before(before, static_cast<R>(1 / world_.kept_share(f)));
      if (damped)
        for_matter(nodes, [&](Node<R>& node, int n) {
          const Vec3<R> v = velocity(node) * (R(1) / node.m);
          note(given(damping), n, node, v, v * step_.keep);
        });
      loops_.release(nodes, step_.keep, step_.kick, found_.sums);
      if (fielded)
        for_matter(nodes, [&](Node<R>& node, int n) {
          const Vec3<R> free = velocity(node), v = step_.fields.apply(free, place(n));
          note(given(fields), n, node, free, v);
          set_velocity(node, v);
        });
    }
  }

  /// Instead of release, in a stage of viscosity.
  void spread(const Stage<R>& stage) {
    found_.clear();
    if (at_walls_ || !near_.empty()) found_.pushes.resize(first_collider + world_.colliders.size());
    for (std::size_t f = 0; f < 2; ++f) {
      Node<R>* const nodes = field(f);
      if (!nodes) continue;
      const Node<R>* const momenta = in_block(f == 0 ? stage.momenta.nodes : stage.momenta.solids);
      const Node<R>* const stress = in_block(world_.grid.stress[f]);
      Node<R>* const old = in_block(stage.old[f]);
      Node<R>* const change = in_block(stage.change[f]);
      for_matter(nodes, [&](Node<R>& node, int n) {
        old[n] = node;
        Vec3<R> given = velocity(momenta[n]);
        if (stress) given += velocity(stress[n]);
        set_velocity(change[n],
                     velocity(change[n]) * stage.keep + given * (stage.gain / node.m) + stage.kick * stage.gain);
        set_velocity(node, velocity(node) + velocity(change[n]));
        found_.sums.mass += static_cast<double>(node.m);
      });
    }
  }
  /// What contact made of the change.
  void keep_change(const Stage<R>& stage) {
    for (std::size_t f = 0; f < 2; ++f) {
      Node<R>* const nodes = field(f);
      if (!nodes) continue;
      const Node<R>* const old = in_block(stage.old[f]);
      const Node<R>* const stress = in_block(world_.grid.stress[f]);
      Node<R>* const change = in_block(stage.change[f]);
      for_matter(nodes, [&](Node<R>& node, int n) {
        const Vec3<R> before = velocity(old[n]), now = velocity(node);
        Vec3<R> driven = stage.kick * node.m;
        if (stress) driven += velocity(stress[n]);
        found_.driven += 0.5 * stage.part * static_cast<double>(dot(driven, before + now));
        if (!(now == before + velocity(change[n]))) set_velocity(change[n], now - before);
      });
    }
  }

  /// Solid against liquid, colliders, walls; then sums.
  void constrain() {
    if (!(found_.sums.mass > 0)) return;
    Node<R>* const solids = field(1);
    if (solids) meet_solids(field(0), solids);
    for (Node<R>* const nodes : {field(0), solids}) {
      if (!nodes) continue;
      touch_colliders(nodes);
      touch_walls(nodes);
      loops_.measure(nodes, found_.sums);
    }
  }

 private:
  template <class T>
  T* in_block(std::vector<T>& all) const {
    return all.empty() ? nullptr : all.data() + block_ * block_nodes;
  }
  template <class T>
  const T* in_block(const std::vector<T>& all) const {
    return all.empty() ? nullptr : all.data() + block_ * block_nodes;
  }
  /// Momenta of the particles that keep a velocity become velocities; `unweigh` makes mass of their weight.
  void keep_before(Node<R>* before, R unweigh) {
    for (int n = 0; n < block_nodes; ++n) {
      const R weight = before[n].m;
      before[n] = there(before[n]) ? before[n] * (R(1) / weight) : Node<R>{};
      found_.arrived2 += static_cast<double>(weight * unweigh * dot(velocity(before[n]), velocity(before[n])));
    }
  }
  Node<R>* field(std::size_t f) const { return in_block(f == 0 ? world_.grid.nodes : world_.grid.solids); }
  static bool there(const Node<R>& node) { return node.m > R(least_mass); }
  template <class Body>
  void for_matter(Node<R>* nodes, const Body& body) const {
    for (int n = 0; n < block_nodes; ++n)
      if (there(nodes[n])) body(nodes[n], n);
  }

  void meet_solids(Node<R>* nodes, Node<R>* solids) const {
    const LiquidNode<R>* const liquid = in_block(world_.grid.liquid);
    std::optional<SolidMass<R>> solid_mass;
    for_matter(nodes, [&](Node<R>& node, int n) {
      if (!there(solids[n])) return;
      if (!solid_mass) solid_mass.emplace(world_, block_);
      Vec3<R> v = velocity(node), w = velocity(solids[n]);
      meet(v, node.m, w, solids[n].m, solid_mass->normal_at(n), step_.diffusion * liquid[n].viscosity / node.m);
      set_velocity(node, v);
      set_velocity(solids[n], w);
    });
  }
  void touch_colliders(Node<R>* nodes) {
    for (const ObstacleNode& o : near_) {
      Node<R>& node = nodes[o.node];
      if (!o.inside || !there(node)) continue;
      const Collider& collider = world_.colliders[o.collider];
      const Vec3<R> before = velocity(node);
      set_velocity(node,
                   contact(before, static_cast<Vec3<R>>(o.normal), collider.type, static_cast<R>(collider.friction)));
      touched(given(first_collider + o.collider), place(o.node), node, before, velocity(node));
    }
  }
  void touch_walls(Node<R>* nodes) {
    if (!at_walls_) return;
    Push walls[6];
    for (std::uint64_t left = at_walls_; left; left &= left - 1) {
      const int n = std::countr_zero(left);
      Node<R>& node = nodes[n];
      if (!there(node)) continue;
      const Vec3i at = first_ + node_offset(n);
      const int position[3] = {at.x, at.y, at.z};
      set_velocity(node, box_contact(velocity(node), position, step_.walls,
                                     [&](int side, const Vec3<R>& before, const Vec3<R>& after) {
                                       touched(walls[side], place_in_block(n), node, before, after);
                                     }));
      if (step_.skin && nodes == field(0)) rub(node, n, at, walls);
    }
    for (std::size_t side = 0; side < 6; ++side)
      given(first_wall + side) += walls[side].from_cells(place(0), world_.dx);
  }

  /// The boundary layers of walls on which a liquid's node `n` at `at` lies, unless it leaves them.
  void rub(Node<R>& node, int n, const Vec3i& at, Push (&walls)[6]) const {
    for (int a = 0; a < 3; ++a)
      for (const int side : {2 * a, 2 * a + 1}) {
        const int plane = side % 2 == 0 ? step_.walls.low[a] : step_.walls.high[a];
        if (!world_.walls[static_cast<std::size_t>(side)].skin_friction || at[a] != plane) continue;
        const Vec3<R> before = velocity(node);
        if (side % 2 == 0 ? before[a] > R(0) : before[a] < R(0)) continue;
        Vec3<R> along = before;
        along[a] = R(0);
        const R speed = sqrt(dot(along, along)), viscosity = in_block(world_.grid.liquid)[n].viscosity / node.m;
        if (!(speed > R(0)) || !(viscosity > R(0))) continue;
        const R kept = skin_kept(speed, viscosity, step_.dx, step_.diffusion * step_.dx);
        set_velocity(node, before - along * (R(1) - kept));
        touched(walls[side], place_in_block(n), node, before, velocity(node));
      }
  }

  Vec3d place(int n) const { return world_.node_position(first_ + node_offset(n)); }
  void note(Push& push, int n, const Node<R>& node, const Vec3<R>& before, const Vec3<R>& after) const {
    if (before == after) return;
    const Vec3d from = static_cast<Vec3d>(before), to = static_cast<Vec3d>(after);
    push.add(place(n), static_cast<double>(node.m), from, to, (from + to) * 0.5);
  }
  static void touched(Push& push, const Vec3d& at, const Node<R>& node, const Vec3<R>& before, const Vec3<R>& after) {
    if (before == after) return;
    const Vec3d to = static_cast<Vec3d>(after);
    push.add(at, static_cast<double>(node.m), static_cast<Vec3d>(before), to, to);
  }
  Push& given(std::size_t giver) {
    if (found_.pushes.empty()) found_.pushes.resize(first_collider + world_.colliders.size());
    return found_.pushes[giver];
  }

  const NodeStep<R>& step_;
  const NodeLoops<R>& loops_;
  World<R>& world_;
  std::size_t block_;
  Vec3i first_;
  std::uint64_t at_walls_;
  const std::vector<ObstacleNode>& near_;
  BlockFound& found_;
};

}  // namespace

Push GridStats::contact() const {
  Push all;
  for (const Push& p : walls) all += p;
  for (const Push& p : colliders) all += p;
  return all;
}

template <class R>
struct GridUpdate<R>::Work {
  explicit Work(const NodeLoops<R>& with) : loops(with) {}

  NodeLoops<R> loops;
  MirrorWalls<R> images;
  std::vector<std::uint32_t> late;  ///< blocks whose contact has to wait for what others do
  // By block.
  std::vector<std::uint64_t> at_walls;
  std::vector<BlockFound> found;
  std::vector<GridStats> sums;  ///< of so many blocks each
  // Of the stages of viscosity.
  std::array<std::vector<Node<R>>, 2> old, change;  ///< as of Stage
  GridStats newest;                                 ///< what the last one found,
  GridStats moved;                                  ///< what contact gave in it, with what is kept of those before,
  GridStats all;                                    ///< and in all of them
  double before = 0, driven = 0;                    ///< J: kinetic energy, and what gravity and stress did

  /// Visits every block: first(visit of a block), contact, last(visit of a block).
  template <class First, class Last>
  GridStats visit(World<R>& world, const Obstacles& obstacles, const NodeStep<R>& step, const First& first,
                  const Last& last);
  /// In the order of the blocks.
  void add_up(const World<R>& world, std::size_t some);
  GridStats total(const World<R>& world);
};

template <class R>
template <class First, class Last>
GridStats GridUpdate<R>::Work::visit(World<R>& world, const Obstacles& obstacles, const NodeStep<R>& step,
                                     const First& first, const Last& last) {
  const std::size_t blocks = world.grid.blocks.size();
  const bool all_late = late.size() == blocks;
  work_together([&](Crew& crew) {
    const FlushToZero mode;
    const auto block = [&](std::size_t b) {
      return BlockVisit<R>(step, loops, world, obstacles, b, at_walls[b], found[b]);
    };
    crew.loop(blocks, blocks_at_once, [&](std::size_t b) {
      BlockVisit<R> one = block(b);
      first(one);
      if (!all_late && !images.changes(b)) one.constrain();
    });
    images.fold(crew, world);
    crew.loop(late.size(), blocks_at_once, [&](std::size_t i) { block(late[i]).constrain(); });
    images.reflect(crew, world);
    crew.loop(sums.size(), 1, [&](std::size_t some) { add_up(world, some); });
    last(crew, block);
  });
  return total(world);
}

template <class R>
void GridUpdate<R>::Work::add_up(const World<R>& world, std::size_t some) {
  GridStats& total = sums[some];
  std::vector<Push> room = std::move(total.colliders);
  total = {};
  room.assign(world.colliders.size(), {});
  total.colliders = std::move(room);
  const std::size_t begin = some * blocks_a_sum, end = std::min(world.grid.blocks.size(), begin + blocks_a_sum);
  for (std::size_t b = begin; b < end; ++b) {
    const NodeSums& s = found[b].sums;
    total.max_speed = std::max(total.max_speed, std::sqrt(s.fastest2));
    total.mass += s.mass;
    total.kinetic += 0.5 * s.kinetic2;
    total.arrived += 0.5 * found[b].arrived2;
    total.moment += world.node_position(world.grid.blocks[b] * block_width) * s.mass + s.moment * world.dx;
    total.finite = total.finite && s.finite;
    const std::vector<Push>& pushes = found[b].pushes;
    if (pushes.empty()) continue;
    for (std::size_t side = 0; side < 6; ++side) total.walls[side] += pushes[first_wall + side];
    total.damping += pushes[damping];
    total.fields += pushes[fields];
    for (std::size_t c = 0; c < world.colliders.size(); ++c) total.colliders[c] += pushes[first_collider + c];
  }
}

template <class R>
GridUpdate<R>::GridUpdate(const NodeLoops<R>& loops) : work_(std::make_unique<Work>(loops)) {}
template <class R>
GridUpdate<R>::~GridUpdate() = default;

template <class R>
const MirrorWalls<R>& GridUpdate<R>::images() const {
  return work_->images;
}

template <class R>
void GridUpdate<R>::prepare(const World<R>& world) {
  const std::size_t blocks = world.grid.blocks.size();
  work_->images.prepare(world);
  work_->found.resize(std::max(work_->found.size(), blocks));
  work_->sums.resize((blocks + blocks_a_sum - 1) / blocks_a_sum);
  // Where solids have a field of their own a block looks at the masses of those around it.
  const bool all = !world.grid.solids.empty();
  work_->late.clear();
  work_->at_walls.clear();
  for (std::size_t b = 0; b < blocks; ++b) {
    work_->at_walls.push_back(nodes_at_walls(world, world.grid.blocks[b]));
    if (all || work_->images.changes(b)) work_->late.push_back(static_cast<std::uint32_t>(b));
  }
}

template <class R>
GridStats GridUpdate<R>::operator()(World<R>& world, const Obstacles& obstacles, double dt) {
  const NodeStep<R> step(world, dt, world.viscous_stages == 0);
  return work_->visit(world, obstacles, step, [](BlockVisit<R>& block) { block.release(); }, [](Crew&, const auto&) {});
}

template <class R>
void GridUpdate<R>::begin_stages(const World<R>& world, const GridStats& found) {
  Work& w = *work_;
  w.before = found.kinetic, w.driven = 0;
  w.moved = w.all = {};
  w.moved.colliders.resize(world.colliders.size()), w.all.colliders.resize(world.colliders.size());
  for (std::size_t f = 0; f < 2; ++f) {
    const std::size_t nodes = (f == 0 ? world.grid.nodes : world.grid.solids).size();
    w.old[f].resize(nodes), w.change[f].assign(nodes, {});
  }
}

template <class R>
void GridUpdate<R>::run_stage(World<R>& world, const Obstacles& obstacles, double dt, int stage,
                              const Carried<R>& momenta) {
  Work& w = *work_;
  // RKL1: mu_j = (2 j - 1)/j, nu_j = (1 - j)/j = 1 - mu_j, and all of it 2/(s^2 + s) of the step; a stage ends at
  // (j^2 + j)/(s^2 + s) of it.
  const double stages = world.viscous_stages, unit = 2 / (stages * (stages + 1)), kept = (stage - 1.0) / stage;
  const double gain = (2.0 * stage - 1) / stage * unit;
  // What a stage gives is kept on in part by those after it: gains are what adds up to the whole step.
  const NodeStep<R> step(world, dt, gain);
  const Stage<R> now{static_cast<R>(kept),
                     static_cast<R>(gain),
                     stage * unit,
                     static_cast<Vec3<R>>(world.gravity_over(dt) * dt),
                     momenta,
                     w.old,
                     w.change};
  w.newest = w.visit(
      world, obstacles, step, [&](BlockVisit<R>& block) { block.spread(now); },
      [&](Crew& crew, const auto& block) {
        crew.loop(world.grid.blocks.size(), blocks_at_once, [&](std::size_t b) { block(b).keep_change(now); });
      });
  for (std::size_t b = 0; b < world.grid.blocks.size(); ++b) w.driven += w.found[b].driven;
  // What contact gives in a stage is part of the change that those after it go on with.
  const auto add = [&](Push& moved, Push& all, const Push& given) {
    moved = {moved.impulse * kept + given.impulse, moved.angular * kept + given.angular,
             moved.work * kept + given.work};
    all += moved;
  };
  for (std::size_t side = 0; side < 6; ++side) add(w.moved.walls[side], w.all.walls[side], w.newest.walls[side]);
  for (std::size_t c = 0; c < w.newest.colliders.size(); ++c)
    add(w.moved.colliders[c], w.all.colliders[c], w.newest.colliders[c]);
}

template <class R>
double GridUpdate<R>::end_stages(GridStats& found) {
  const Work& w = *work_;
  found.kinetic = w.newest.kinetic;
  found.finite = found.finite && w.newest.finite;
  for (std::size_t side = 0; side < 6; ++side) found.walls[side] += w.all.walls[side];
  for (std::size_t c = 0; c < found.colliders.size(); ++c) found.colliders[c] += w.all.colliders[c];
  return w.before - w.newest.kinetic + w.driven + w.all.contact().work;
}

template <class R>
GridStats GridUpdate<R>::Work::total(const World<R>& world) {
  GridStats total;
  total.kinetic = images.add_pushes(total.walls);
  total.colliders.resize(world.colliders.size());
  for (const GridStats& some : sums) {
    total.max_speed = std::max(total.max_speed, some.max_speed);
    total.mass += some.mass;
    total.kinetic += some.kinetic;
    total.arrived += some.arrived;
    total.moment += some.moment;
    total.damping += some.damping;
    total.fields += some.fields;
    total.finite = total.finite && some.finite;
    for (std::size_t side = 0; side < 6; ++side) total.walls[side] += some.walls[side];
    for (std::size_t c = 0; c < total.colliders.size(); ++c) total.colliders[c] += some.colliders[c];
  }
  return total;
}

template class GridUpdate<float>;
template class GridUpdate<double>;

}  // namespace dreampm

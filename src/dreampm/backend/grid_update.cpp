// The one visit of every grid node in a step.
#include <algorithm>
#include <cmath>
#include <optional>

#include "dreampm/backend/common.h"
#include "dreampm/backend/mirror_walls.h"
#include "dreampm/base/parallel.h"
#include "dreampm/state/force_fields.h"

namespace dreampm {
namespace {

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

/// What the nodes of one block found.
struct NodeSums {
  double max_speed = 0, mass = 0, kinetic = 0;
  Vec3d moment{};
  Push damping, fields;
  std::vector<Push> pushes;  ///< the six walls, then the colliders; empty where there are none
  bool finite = true;

  /// Keeps the room of `pushes`.
  void clear() {
    std::vector<Push> room = std::move(pushes);
    room.clear();
    *this = {};
    pushes = std::move(room);
  }
};

/// What is the same for all nodes in one step.
template <class R>
struct NodeStep {
  const World<R>& world;
  FieldSteps<R> fields;
  BoxWalls<R> walls;
  Vec3<R> kick;
  R keep;       ///< of the velocity, by damping
  R diffusion;  ///< dt/dx^2 [s/m^2]

  NodeStep(const World<R>& w, double dt)
      : world(w),
        fields(w, dt),
        walls(box_walls(w)),
        kick(static_cast<Vec3<R>>(w.gravity_over(dt) * dt)),
        keep(static_cast<R>(std::exp(-w.settings.damping * dt))),
        diffusion(static_cast<R>(dt / (w.dx * w.dx))) {}
};

/// The nodes of one block, of one field or two.
template <class R>
class BlockVisit {
 public:
  BlockVisit(const NodeStep<R>& step, const Vec3i& first, const std::vector<ObstacleNode>& near, NodeSums& sums)
      : step_(step), first_(first), near_(near), sums_(sums), touches_(!near.empty()) {
    for (int a = 0; a < 3; ++a)
      touches_ = touches_ || first[a] <= step.walls.low[a] || first[a] + block_width > step.walls.high[a];
    if (touches_) sums.pushes.resize(6 + step.world.colliders.size());
  }

  /// Momentum to velocity, damping, gravity, force fields. `before`: the momentum without the step's forces, which
  /// becomes a velocity; or null.
  void accelerate(Node<R>& node, Node<R>* before, int n) const {
    if (!(node.m > R(least_mass))) {
      // NaN mass must not hide as an empty node.
      if (!(node.m >= R(0))) sums_.finite = false;
      set_velocity(node, {});
      if (before) *before = {};
      return;
    }
    sums_.mass += static_cast<double>(node.m);
    sums_.moment += place(n) * static_cast<double>(node.m);
    Vec3<R> v = velocity(node) * (R(1) / node.m);
    if (before) *before = *before * (R(1) / node.m);
    if (step_.keep != R(1)) note(sums_.damping, n, node, v, v * step_.keep);
    v = v * step_.keep + step_.kick;
    if (step_.fields.any()) {
      const Vec3<R> free = v;
      v = step_.fields.apply(v, place(n));
      note(sums_.fields, n, node, free, v);
    }
    set_velocity(node, v);
  }

  void meet_at(Node<R>& liquid, Node<R>& solid, const LiquidNode<R>& channel, const Vec3<R>& normal) const {
    Vec3<R> v = velocity(liquid), w = velocity(solid);
    meet(v, liquid.m, w, solid.m, normal, step_.diffusion * channel.viscosity / liquid.m);
    set_velocity(liquid, v);
    set_velocity(solid, w);
  }

  /// Colliders, then walls.
  void constrain(Node<R>& node, int n) {
    Vec3<R> v = velocity(node);
    if (touches_) {
      for (const ObstacleNode& o : near_)
        if (o.node == n && o.inside) {
          const Vec3<R> before = v;
          const Collider& collider = step_.world.colliders[o.collider];
          v = contact(v, static_cast<Vec3<R>>(o.normal), collider.type, static_cast<R>(collider.friction));
          touch(sums_.pushes[6 + static_cast<std::size_t>(o.collider)], n, node, before, v);
        }
      const Vec3i at = first_ + node_offset(n);
      const int position[3] = {at.x, at.y, at.z};
      v = box_contact(v, position, step_.walls, [&](int side, const Vec3<R>& before, const Vec3<R>& after) {
        touch(sums_.pushes[static_cast<std::size_t>(side)], n, node, before, after);
      });
      set_velocity(node, v);
    }
    const R speed2 = dot(v, v);
    if (!(speed2 < R(1e30))) sums_.finite = false;
    sums_.kinetic += 0.5 * static_cast<double>(node.m) * static_cast<double>(speed2);
    fastest2_ = max(speed2, fastest2_);
  }

  double fastest() const { return std::sqrt(static_cast<double>(fastest2_)); }

 private:
  Vec3d place(int n) const { return step_.world.node_position(first_ + node_offset(n)); }
  void note(Push& push, int n, const Node<R>& node, const Vec3<R>& before, const Vec3<R>& after) const {
    if (before == after) return;
    const Vec3d from = static_cast<Vec3d>(before), to = static_cast<Vec3d>(after);
    push.add(place(n), static_cast<double>(node.m), from, to, (from + to) * 0.5);
  }
  void touch(Push& push, int n, const Node<R>& node, const Vec3<R>& before, const Vec3<R>& after) const {
    if (before == after) return;
    const Vec3d to = static_cast<Vec3d>(after);
    push.add(place(n), static_cast<double>(node.m), static_cast<Vec3d>(before), to, to);
  }

  const NodeStep<R>& step_;
  Vec3i first_;
  const std::vector<ObstacleNode>& near_;
  NodeSums& sums_;
  bool touches_;
  R fastest2_{0};
};

}  // namespace

void Push::add(const Vec3d& at, double mass, const Vec3d& before, const Vec3d& after, const Vec3d& moved_at) {
  const Vec3d received = (after - before) * mass;
  impulse += received;
  angular += cross(at, received);
  work += dot(received, moved_at);
}

Push& Push::operator+=(const Push& b) {
  impulse += b.impulse;
  angular += b.angular;
  work += b.work;
  return *this;
}

Push GridStats::contact() const {
  Push all;
  for (const Push& p : walls) all += p;
  for (const Push& p : colliders) all += p;
  return all;
}

template <class R>
struct GridUpdate<R>::Work {
  std::vector<NodeSums> partial;
  MirrorWalls<R> images, solid_images;
};

template <class R>
GridUpdate<R>::GridUpdate() : work_(std::make_unique<Work>()) {}
template <class R>
GridUpdate<R>::~GridUpdate() = default;

template <class R>
GridStats GridUpdate<R>::operator()(World<R>& world, const Obstacles& obstacles, double dt) {
  const NodeStep<R> step(world, dt);
  const std::size_t blocks = world.grid.blocks.size();
  const bool two_fields = !world.grid.solids.empty();
  auto& [partial, images, solid_images] = *work_;
  partial.resize(blocks);
  for (NodeSums& s : partial) s.clear();
  const auto in_block = [](auto& field, std::size_t b) {
    return field.empty() ? nullptr : field.data() + b * block_nodes;
  };
  parallel_for(blocks, 32, [&](std::size_t b) {
    const BlockVisit<R> visit(step, world.grid.blocks[b] * block_width, obstacles.at(b), partial[b]);
    for (std::size_t f = 0; f < 2; ++f) {
      Node<R>* nodes = in_block(f == 0 ? world.grid.nodes : world.grid.solids, b);
      Node<R>* before = in_block(world.grid.before[f], b);
      for (int n = 0; nodes && n < block_nodes; ++n) visit.accelerate(nodes[n], before ? before + n : nullptr, n);
    }
  });
  GridStats total;
  images.find(world);
  if (two_fields) solid_images = images;
  images.fold(world, world.grid.nodes, total.walls);
  if (two_fields) solid_images.fold(world, world.grid.solids, total.walls);
  parallel_for(blocks, 32, [&](std::size_t b) {
    Node<R>* nodes = in_block(world.grid.nodes, b);
    Node<R>* solids = in_block(world.grid.solids, b);
    const LiquidNode<R>* liquid = in_block(world.grid.liquid, b);
    BlockVisit<R> visit(step, world.grid.blocks[b] * block_width, obstacles.at(b), partial[b]);
    std::optional<SolidMass<R>> solid_mass;
    for (int n = 0; n < block_nodes; ++n) {
      const bool main = nodes[n].m > R(least_mass), solid = solids && solids[n].m > R(least_mass);
      if (main && solid) {
        if (!solid_mass) solid_mass.emplace(world, b);
        visit.meet_at(nodes[n], solids[n], liquid[n], solid_mass->normal_at(n));
      }
      if (main) visit.constrain(nodes[n], n);
      if (solid) visit.constrain(solids[n], n);
    }
    partial[b].max_speed = visit.fastest();
  });
  total.kinetic += images.reflect(world, world.grid.nodes, total.walls);
  if (two_fields) total.kinetic += solid_images.reflect(world, world.grid.solids, total.walls);
  total.colliders.resize(world.colliders.size());
  for (const NodeSums& s : partial) {
    total.max_speed = std::max(total.max_speed, s.max_speed);
    total.mass += s.mass;
    total.kinetic += s.kinetic;
    total.moment += s.moment;
    total.damping += s.damping;
    total.fields += s.fields;
    total.finite = total.finite && s.finite;
    for (std::size_t i = 0; i < s.pushes.size(); ++i) (i < 6 ? total.walls[i] : total.colliders[i - 6]) += s.pushes[i];
  }
  return total;
}

template class GridUpdate<float>;
template class GridUpdate<double>;

}  // namespace dreampm

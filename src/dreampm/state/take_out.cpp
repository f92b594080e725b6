#include "dreampm/state/take_out.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "dreampm/base/parallel.h"
#include "dreampm/physics/transfer.h"
#include "dreampm/state/block_bounds.h"
#include "dreampm/state/mechanics.h"

namespace dreampm {
namespace {

/// Returns velocity [m/s] and velocity gradient C [1/s] of a particle of block `b`: its own if it
/// carries them, else those that it will gather from the grid.
template <class R>
std::pair<Vec3d, Mat3d> gathered(const World<R>& world, const ParticleSet<R>& set, std::size_t b, std::size_t p) {
  if (set.carries_motion) {
    Mat3d c{};
    for (int n = 0; n < 9; ++n) c(n / 3, n % 3) = static_cast<double>(set.gradient[static_cast<std::size_t>(n)][p]);
    return {static_cast<Vec3d>(Vec3<R>{set.own_velocity[0][p], set.own_velocity[1][p], set.own_velocity[2][p]}), c};
  }
  const Stencil<R> stencil = make_stencil(Vec3<R>{set.u[0][p], set.u[1][p], set.u[2][p]});
  const Vec3i first =
      first_stencil(world.particle_blocks[b]) + Vec3i{stencil.node(0), stencil.node(1), stencil.node(2)};
  const Nodes<R>& nodes = world.grid.field(world.field_of(set));
  const auto node = [&](int i, int j, int k) {
    const Vec3i at = first + Vec3i{i, j, k};
    const std::int32_t block = world.grid.blocks.find(world.wrapped(block_of(at)));
    return block == BlockList::none ? Node<R>{}
                                    : nodes[static_cast<std::size_t>(block) * block_nodes +
                                            static_cast<std::size_t>(node_index(at.x & 3, at.y & 3, at.z & 3))];
  };
  const Moments<Node<R>> found = gather<Node<R>, no_bends>(
      stencil, [&](int i, int j) { return NodeRow<Node<R>>{{node(i, j, 0), node(i, j, 1), node(i, j, 2)}}; });
  Mat3d c{};
  for (int row = 0; row < 3; ++row)
    for (int a = 0; a < 3; ++a) {
      const Node<R>& moment = found.first_moment[a];
      const R rows[3] = {moment.x, moment.y, moment.z};
      c(row, a) = static_cast<double>(rows[row]) * apic_inertia / world.dx;
    }
  return {static_cast<Vec3d>(Vec3<R>{found.value.x, found.value.y, found.value.z}), c};
}

/// The region in which a sink takes matter now.
class Mouth {
 public:
  template <class R>
  Mouth(const World<R>& world, const Sink& sink)
      : shape_(sink.shape.get()),
        collider_(sink.collider ? &world.colliders[*sink.collider] : nullptr),
        // Matter feels a collider, and may turn away from it, about a cell before it is there.
        reach_(sink.collider ? world.dx : 0),
        moves_(sink.path != nullptr),
        pose_(sink.path ? sink.path->pose_at(world.time) : Pose{}) {
    const Box3d own = collider_ ? collider_->bounds() : shape_->bounds();
    const Vec3d reach{reach_, reach_, reach_};
    bounds_ = {own.min - reach, own.max + reach};
  }
  bool holds(const Vec3d& place) const {
    const Vec3d x = moves_ ? pose_.inverse(place) : place;
    return bounds_.contains(x) && (collider_ ? collider_->distance(x) : shape_->distance(x)) < reach_;
  }
  bool may_reach(const Box3d& box) const {
    if (!moves_) return meet(box, bounds_);
    Box3d its;
    for (int c = 0; c < 8; ++c)
      its.add(
          pose_.inverse({c & 4 ? box.max.x : box.min.x, c & 2 ? box.max.y : box.min.y, c & 1 ? box.max.z : box.min.z}));
    return meet(its, bounds_);
  }

 private:
  const Region* shape_;
  const Collider* collider_;
  double reach_;
  bool moves_;
  Pose pose_;
  Box3d bounds_;
};

/// Calls body(block) for the blocks of particles that a sink reaches, in their order.
template <class R, class Body>
void each_block_at(const World<R>& world, const Mouth& mouth, bool far, const Body& body) {
  for (std::size_t b = 0; b < world.particle_blocks.size(); ++b)
    if (mouth.may_reach(bounds_of_block(world, world.particle_blocks[b], (far ? 2 : 1) * block_width))) body(b);
}

/// A particle that a sink takes, and what it takes along.
struct Taken {
  std::uint32_t number;
  Vec3d momentum, angular;
};

/// Returns the particles of one block that the sink takes, in their order; `gone` are taken
/// already.
template <class R>
std::vector<Taken> taken_of(const World<R>& world, const ParticleSet<R>& set, std::size_t b, const Mouth& mouth,
                            const std::vector<std::uint32_t>& gone) {
  std::vector<Taken> taken;
  for (std::uint32_t p = set.block_start[b]; p < set.block_start[b + 1]; ++p) {
    const Vec3d x = world.position(world.particle_blocks[b], {set.u[0][p], set.u[1][p], set.u[2][p]});
    if (!mouth.holds(x) || std::binary_search(gone.begin(), gone.end(), p)) continue;
    const auto [v, c] = gathered(world, set, b, p);
    taken.push_back({p, v * set.mass, angular_momentum(set, world.dx, x, v, c)});
  }
  return taken;
}

}  // namespace

template <class R>
bool sinks_take(const World<R>& world) {
  return world.step > 0 && !world.sinks.empty();
}

template <class R>
std::vector<std::uint32_t> blocks_at_sinks(const World<R>& world, bool far) {
  std::vector<bool> reached(world.particle_blocks.size());
  for (const Sink& sink : world.sinks)
    each_block_at(world, Mouth(world, sink), far, [&](std::size_t b) { reached[b] = true; });
  std::vector<std::uint32_t> blocks;
  for (std::size_t b = 0; b < reached.size(); ++b)
    if (reached[b]) blocks.push_back(static_cast<std::uint32_t>(b));
  return blocks;
}

template <class R>
std::vector<std::vector<std::uint32_t>> take_out(World<R>& world, bool far) {
  std::vector<std::vector<std::uint32_t>> all(world.sets.size());
  std::vector<std::size_t> near;
  std::vector<std::vector<Taken>> found;
  for (Sink& sink : world.sinks) {
    const Mouth mouth(world, sink);
    near.clear();
    each_block_at(world, mouth, far, [&](std::size_t b) { near.push_back(b); });
    for (std::size_t s = 0; s < world.sets.size(); ++s) {
      const ParticleSet<R>& set = world.sets[s];
      if (set.size() == 0) continue;
      std::vector<std::uint32_t>& gone = all[s];
      found.assign(near.size(), {});
      parallel_for(near.size(), 1, [&](std::size_t i) { found[i] = taken_of(world, set, near[i], mouth, gone); });
      const std::size_t before = gone.size();
      for (const std::vector<Taken>& some : found)
        for (const Taken& one : some) {
          gone.push_back(one.number);
          sink.momentum += one.momentum, sink.angular += one.angular;
        }
      sink.taken += gone.size() - before;
      std::sort(gone.begin(), gone.end());
    }
  }
  return all;
}

#define DM_INSTANTIATE(R)                                                     \
  template bool sinks_take(const World<R>&);                                  \
  template std::vector<std::uint32_t> blocks_at_sinks(const World<R>&, bool); \
  template std::vector<std::vector<std::uint32_t>> take_out(World<R>&, bool);
DM_INSTANTIATE(float)
DM_INSTANTIATE(double)
#undef DM_INSTANTIATE

}  // namespace dreampm

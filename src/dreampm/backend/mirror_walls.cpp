#include "dreampm/backend/mirror_walls.h"

#include <algorithm>

#include "dreampm/physics/materials.h"
#include "dreampm/physics/particle.h"
#include "dreampm/state/resize_for_overwrite.h"
#include "dreampm/state/volume_relaxation.h"

namespace dreampm {
namespace {

constexpr std::size_t layers_at_once = 4;

/// The sum about the scene's origin, of one about node number `at` of the grid, in cells.
template <class R>
ImpulseSum about_origin(const ImpulseSum& impulses, const World<R>& world, std::size_t at) {
  const Vec3i node =
      world.grid.blocks[at / block_nodes] * block_width + node_offset(static_cast<int>(at % block_nodes));
  return impulses.from_cells(world.node_position(node), world.dx);
}

/// The plane of nodes behind a side.
template <class R>
std::int32_t behind(const World<R>& world, int side) {
  return side % 2 == 0 ? world.low[axis_of(side)] - 1 : world.high[axis_of(side)] + 1;
}

template <class R>
std::int32_t inward_block(const World<R>& world, std::size_t block, int side) {
  Vec3i step{};
  step[axis_of(side)] = inward_of(side);
  return world.grid.blocks.find(world.wrapped(world.grid.blocks[block] + step));
}

}  // namespace

template <class R>
bool measures_density(const World<R>& world, double dt) {
  const double volume_relaxation = volume_relaxation_time(world, dt);
  return std::any_of(world.sets.begin(), world.sets.end(), [&](const ParticleSet<R>& set) {
    bool wants = false;
    Materials::with(set.material, [&]<class M>() { wants = measures<M>(volume_relaxation); });
    return wants;
  });
}

template <class R>
bool has_image_mass(const World<R>& world, int side) {
  const int a = axis_of(side);
  return world.settings.keep_inside && world.walls[static_cast<std::size_t>(side)].type != WallType::open &&
         !world.periodic[static_cast<std::size_t>(a)] && world.high[a] - world.low[a] >= 3;
}

template <class R>
R without_images(const World<R>& world, const Vec3i& node, R blocked) {
  for (int side = 0; side < 6; ++side) {
    if (!has_image_mass(world, side)) continue;
    const std::int32_t depth = (node[axis_of(side)] - behind(world, side)) * inward_of(side);
    if (depth <= 0) return R(0);
    if (depth == 1) blocked *= R(0.5);
  }
  return blocked;
}

template <class R>
void MirrorWalls<R>::prepare(const World<R>& world) {
  layers_.clear();
  const BlockList& blocks = world.grid.blocks;
  resize_for_overwrite(changes_, blocks.size());
  std::fill(changes_.begin(), changes_.end(), std::uint8_t{0});
  folds_ = false;
  for (int a = 0; a < 3; ++a) {
    axes_[static_cast<std::size_t>(a)] = layers_.size();
    for (const int side : {2 * a, 2 * a + 1}) {
      if (!has_image_mass(world, side)) continue;
      const Wall& wall = world.walls[static_cast<std::size_t>(side)];
      std::array<bool, 2> folds;
      for (std::size_t f = 0; f < 2; ++f)
        folds[f] = wall.type == WallType::stick || !(wall.friction > 0) || world.holds_liquid(f);
      const std::int32_t plane = behind(world, side);
      for (std::size_t b = 0; b < blocks.size(); ++b) {
        if (blocks[b][a] != plane >> 2) continue;
        const std::int32_t next = inward_block(world, b, side);
        // The first node of the plane `inward` cells inward.
        const auto first = [&](int inward) {
          const int along = (plane & 3) + inward * inward_of(side);
          const std::size_t holder = along == (along & 3) ? b : static_cast<std::size_t>(next);
          return holder * block_nodes + static_cast<std::size_t>((along & 3) * node_step[a]);
        };
        const int deepest = (plane & 3) + 2 * inward_of(side);
        if (next == BlockList::none && deepest != (deepest & 3)) continue;
        layers_.push_back({first(0), first(1), first(2), side, folds});
        if (!folds[0] && !folds[1]) continue;
        folds_ = true;
        changes_[b] = true;
        if (next != BlockList::none) changes_[static_cast<std::size_t>(next)] = true;
      }
    }
    // In the order of the blocks, so that a thread meets those that it visits in other loops.
    std::sort(layers_.begin() + static_cast<std::ptrdiff_t>(axes_[static_cast<std::size_t>(a)]), layers_.end(),
              [](const Layer& x, const Layer& y) { return x.ghosts < y.ghosts; });
  }
  axes_[3] = layers_.size();
  for (auto& done : done_) done.assign(layers_.size(), {});
}

/// Two walls across an axis are three cells apart: their layers share no node. An edge has the
/// image of an image, so that axes go one after the other.
template <class R>
template <class Body>
void MirrorWalls<R>::for_axis(ThreadTeam& team, int axis, const Body& body) const {
  const std::size_t begin = axes_[static_cast<std::size_t>(axis)], end = axes_[static_cast<std::size_t>(axis) + 1];
  team.loop(end - begin, layers_at_once, [&](std::size_t l) { body(begin + l); });
}

template <class R>
void MirrorWalls<R>::add_image_mass(ThreadTeam& team, World<R>& world, double dt) const {
  if (layers_.empty() || !measures_density(world, dt)) return;
  auto& [blocks, nodes, solids, mixed, before, stress] = world.grid;
  for (int axis = 0; axis < 3; ++axis)
    for_axis(team, axis, [&](std::size_t l) {
      const Layer& layer = layers_[l];
      for (int n = 0; n < plane_nodes; ++n) {
        const auto from = static_cast<std::size_t>(node_in_plane(axis, n));
        const std::size_t ghost = layer.ghosts + from, wall = layer.walls + from, inner = layer.inners + from;
        add_image(nodes[ghost].m, nodes[wall].m, nodes[inner].m);
        if (!solids.empty()) add_image(solids[ghost].m, solids[wall].m, solids[inner].m);
        if (mixed.empty()) continue;
        Node<R>&behind = mixed[ghost], &on = mixed[wall], &before_it = mixed[inner];
        add_image(mixture::blocked(behind), mixture::blocked(on), mixture::blocked(before_it));
        for (std::size_t f = 0; f < 2; ++f)
          add_image(mixture::filled(behind, f), mixture::filled(on, f), mixture::filled(before_it, f));
      }
    });
}

template <class R>
template <class Body>
void MirrorWalls<R>::for_fields(World<R>& world, std::size_t l, const Body& body) {
  const Layer& layer = layers_[l];
  for (std::size_t f = 0; f < 2; ++f) {
    Nodes<R>& nodes = world.grid.field(f);
    if (!layer.folds[f] || nodes.empty()) continue;
    body(f,
         MirrorPlanes<R>{&nodes[layer.ghosts], &nodes[layer.walls], &nodes[layer.inners], layer.side,
                         world.walls[static_cast<std::size_t>(layer.side)].type},
         done_[f][l]);
  }
}

template <class R>
void MirrorWalls<R>::fold_ghosts(ThreadTeam& team, World<R>& world, const NodeLoops<R>& loops,
                                 const ContactGaps& gaps) {
  if (!folds_) return;
  for (int axis = 2; axis >= 0; --axis)
    for_axis(team, axis, [&](std::size_t l) {
      for_fields(world, l, [&](std::size_t f, MirrorPlanes<R> planes, Done& done) {
        ImpulseSum impulses;
        done = {};
        if (gaps.has(world, f)) planes.closed = gaps.closed(layers_[l].ghosts / block_nodes, planes.side);
        done.folded = loops.fold_ghosts(planes, impulses);
        if (done.folded) done.impulses = about_origin(impulses, world, layers_[l].inners);
      });
    });
}

template <class R>
void MirrorWalls<R>::reflect_ghosts(ThreadTeam& team, World<R>& world, const NodeLoops<R>& loops) {
  if (!folds_) return;
  for (int axis = 0; axis < 3; ++axis)
    for_axis(team, axis, [&](std::size_t l) {
      for_fields(world, l, [&](std::size_t, const MirrorPlanes<R>& planes, Done& done) {
        if (!done.folded) return;
        ImpulseSum impulses;
        done.gained = loops.reflect_ghosts(planes, done.folded, impulses);
        done.impulses += about_origin(impulses, world, layers_[l].ghosts);
      });
    });
}

template <class R>
double MirrorWalls<R>::add_impulses(std::array<ImpulseSum, 6>& walls) const {
  double gained = 0;
  for (const auto& done : done_)
    for (std::size_t l = 0; l < layers_.size(); ++l) {
      if (!done[l].folded) continue;
      walls[static_cast<std::size_t>(layers_[l].side)] += done[l].impulses;
      gained += done[l].gained;
    }
  return gained;
}

#define DM_INSTANTIATE(R)                                      \
  template bool has_image_mass(const World<R>&, int);          \
  template bool measures_density(const World<R>&, double);     \
  template R without_images(const World<R>&, const Vec3i&, R); \
  template class MirrorWalls<R>;
DM_INSTANTIATE(float)
DM_INSTANTIATE(double)
#undef DM_INSTANTIATE

}  // namespace dreampm

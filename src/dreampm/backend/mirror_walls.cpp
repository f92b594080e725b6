#include "dreampm/backend/mirror_walls.h"

#include <algorithm>

#include "dreampm/backend/node_loops.h"
#include "dreampm/physics/materials.h"
#include "dreampm/physics/particle.h"
#include "dreampm/state/anchoring.h"
#include "dreampm/state/refit.h"

namespace dreampm {
namespace {

constexpr std::size_t layers_at_once = 4;

constexpr int axis_of(int side) { return side / 2; }
constexpr int inward_of(int side) { return side % 2 == 0 ? 1 : -1; }

/// The velocity of a node's image in a wall across `axis`. Where matter sticks all of it is reversed, so that the
/// velocity passes through zero at the wall itself.
template <class R>
Vec3<R> image_of(const Node<R>& node, int axis, WallType wall) {
  Vec3<R> v{node.x, node.y, node.z};
  if (wall == WallType::stick) return -v;
  v[axis] = -v[axis];
  return v;
}

template <class R>
double kinetic_energy(const Node<R>& node) {
  const Vec3d v{static_cast<double>(node.x), static_cast<double>(node.y), static_cast<double>(node.z)};
  return 0.5 * static_cast<double>(node.m) * dot(v, v);
}

/// The wall does not move: its push does no work. `push` is about the first node of the block, in cells.
template <class R>
void give(std::vector<Node<R>>& nodes, std::size_t at, const Vec3<R>& v, Push& push) {
  Node<R>& node = nodes[at];
  push.add(place_in_block(at % block_nodes), static_cast<double>(node.m),
           static_cast<Vec3d>(Vec3<R>{node.x, node.y, node.z}), static_cast<Vec3d>(v), Vec3d{});
  node.x = v.x, node.y = v.y, node.z = v.z;
}
template <class R>
Push about_origin(const Push& push, const World<R>& world, std::size_t block) {
  return push.from_cells(world.node_position(world.grid.blocks[block] * block_width), world.dx);
}

/// A node behind a wall, the one on it and the one that the first mirrors.
struct Triple {
  std::size_t ghost, wall, inner;
};

/// Calls body(n, triple) for the 16 nodes of a layer behind a wall, number `local` of its block along the axis; `next`
/// is the block inward of it (-1: there is none).
template <class Body>
void for_layer(int side, std::size_t block, std::int32_t next, int local, const Body& body) {
  constexpr std::size_t apart[3] = {16, 4, 1};
  const int a = axis_of(side), inward = inward_of(side);
  const auto holder = [&](int along) { return along == (along & 3) ? block : static_cast<std::size_t>(next); };
  const auto plane = [&](int along) {
    return holder(along) * block_nodes + static_cast<std::size_t>(along & 3) * apart[a];
  };
  if (holder(local + 2 * inward) != block && next == BlockList::none) return;
  const std::size_t ghosts = plane(local), walls = plane(local + inward), inners = plane(local + 2 * inward);
  const std::size_t rows = apart[(a + 1) % 3], columns = apart[(a + 2) % 3];
  for (std::size_t n = 0; n < 16; ++n) {
    const std::size_t at = n / 4 * rows + n % 4 * columns;
    body(n, Triple{ghosts + at, walls + at, inners + at});
  }
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

template <class R>
bool measures_density(const World<R>& world, double dt) {
  const double anchoring = anchoring_time(world, dt);
  return std::any_of(world.sets.begin(), world.sets.end(), [&](const ParticleSet<R>& set) {
    bool wants = false;
    Materials::with(set.material, [&]<class M>() { wants = measures<M>(anchoring); });
    return wants;
  });
}

/// Makes `behind` and `inner` the same, and counts what lies on the wall twice.
template <class R>
void add_image(R& behind, R& wall, R& inner) {
  wall += wall;
  inner += behind;
  behind = inner;
}

}  // namespace

template <class R>
bool image_weighs(const World<R>& world, int side) {
  const int a = axis_of(side);
  return world.settings.keep_inside && world.walls[static_cast<std::size_t>(side)].type != WallType::open &&
         !world.periodic[static_cast<std::size_t>(a)] && world.high[a] - world.low[a] >= 3;
}

template <class R>
R before_images(const World<R>& world, const Vec3i& node, R blocked) {
  for (int side = 0; side < 6; ++side) {
    if (!image_weighs(world, side)) continue;
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
  refit(changes_, blocks.size());
  std::fill(changes_.begin(), changes_.end(), std::uint8_t{0});
  folds_ = false;
  for (int a = 0; a < 3; ++a) {
    axes_[static_cast<std::size_t>(a)] = layers_.size();
    for (const int side : {2 * a, 2 * a + 1}) {
      if (!image_weighs(world, side)) continue;
      const Wall& wall = world.walls[static_cast<std::size_t>(side)];
      std::array<bool, 2> folds;
      for (std::size_t f = 0; f < 2; ++f)
        folds[f] = wall.type == WallType::stick || !(wall.friction > 0) || world.holds_liquid(f);
      const std::int32_t plane = behind(world, side);
      for (std::size_t b = 0; b < blocks.size(); ++b) {
        if (blocks[b][a] != plane >> 2) continue;
        const std::int32_t inward = inward_block(world, b, side);
        layers_.push_back({b, inward, static_cast<std::uint8_t>(side), static_cast<std::uint8_t>(plane & 3), folds});
        if (!folds[0] && !folds[1]) continue;
        folds_ = true;
        changes_[b] = true;
        if (inward != BlockList::none) changes_[static_cast<std::size_t>(inward)] = true;
      }
    }
    // In the order of the blocks, so that a thread meets those that it visits in other loops.
    std::sort(layers_.begin() + static_cast<std::ptrdiff_t>(axes_[static_cast<std::size_t>(a)]), layers_.end(),
              [](const Layer& x, const Layer& y) { return x.block != y.block ? x.block < y.block : x.side < y.side; });
  }
  axes_[3] = layers_.size();
  for (auto& done : done_) done.assign(layers_.size(), {});
}

/// Two walls across an axis are three cells apart: their layers share no node. An edge has the image of an image, so
/// that axes go one after the other.
template <class R>
template <class Body>
void MirrorWalls<R>::for_axis(Crew& crew, int axis, const Body& body) const {
  const std::size_t begin = axes_[static_cast<std::size_t>(axis)], end = axes_[static_cast<std::size_t>(axis) + 1];
  crew.loop(end - begin, layers_at_once, [&](std::size_t l) { body(begin + l); });
}

template <class R>
void MirrorWalls<R>::weigh(Crew& crew, World<R>& world, double dt) const {
  if (layers_.empty() || !measures_density(world, dt)) return;
  auto& [blocks, nodes, solids, mixed, before, stress] = world.grid;
  for (int axis = 0; axis < 3; ++axis)
    for_axis(crew, axis, [&](std::size_t l) {
      const Layer& layer = layers_[l];
      for_layer(layer.side, layer.block, layer.inward, layer.local, [&](std::size_t, const Triple& t) {
        add_image(nodes[t.ghost].m, nodes[t.wall].m, nodes[t.inner].m);
        if (!solids.empty()) add_image(solids[t.ghost].m, solids[t.wall].m, solids[t.inner].m);
        if (mixed.empty()) return;
        Node<R>&ghost = mixed[t.ghost], &wall = mixed[t.wall], &inner = mixed[t.inner];
        add_image(mixture::blocked(ghost), mixture::blocked(wall), mixture::blocked(inner));
        for (std::size_t f = 0; f < 2; ++f)
          add_image(mixture::filled(ghost, f), mixture::filled(wall, f), mixture::filled(inner, f));
      });
    });
}

template <class R>
void MirrorWalls<R>::fold_layer(const World<R>& world, const Layer& layer, std::vector<Node<R>>& nodes,
                                Done& done) const {
  const int a = axis_of(layer.side);
  const WallType type = world.walls[layer.side].type;
  done = {};
  Push push;
  std::size_t last = 0;
  for_layer(layer.side, layer.block, layer.inward, layer.local, [&](std::size_t n, const Triple& t) {
    const Node<R>& ghost = nodes[t.ghost];
    const Node<R>& inner = nodes[t.inner];
    if (!(ghost.m > R(least_mass)) || !(inner.m > R(least_mass))) return;
    const Node<R>& wall = nodes[t.wall];
    const R out = (a == 0 ? wall.x : a == 1 ? wall.y : wall.z) * R(inward_of(layer.side));
    if (type == WallType::separate && !(out < R(0))) return;
    const Vec3<R> v{inner.x, inner.y, inner.z};
    give(nodes, t.inner, v + (image_of(ghost, a, type) - v) * (ghost.m / (ghost.m + inner.m)), push);
    done.folded = static_cast<std::uint16_t>(done.folded | 1u << n);
    last = t.inner;
  });
  if (done.folded) done.push = about_origin(push, world, last / block_nodes);
}

template <class R>
void MirrorWalls<R>::reflect_layer(const World<R>& world, const Layer& layer, std::vector<Node<R>>& nodes,
                                   Done& done) const {
  if (!done.folded) return;
  const WallType type = world.walls[layer.side].type;
  Push push;
  for_layer(layer.side, layer.block, layer.inward, layer.local, [&](std::size_t n, const Triple& t) {
    if (!(done.folded >> n & 1)) return;
    const double before = kinetic_energy(nodes[t.ghost]);
    give(nodes, t.ghost, image_of(nodes[t.inner], axis_of(layer.side), type), push);
    done.gained += kinetic_energy(nodes[t.ghost]) - before;
  });
  done.push += about_origin(push, world, layer.block);
}

template <class R>
void MirrorWalls<R>::fold(Crew& crew, World<R>& world) {
  if (!folds_) return;
  for (int axis = 2; axis >= 0; --axis)
    for_axis(crew, axis, [&](std::size_t l) {
      const Layer& layer = layers_[l];
      if (layer.folds[0]) fold_layer(world, layer, world.grid.nodes, done_[0][l]);
      if (layer.folds[1] && !world.grid.solids.empty()) fold_layer(world, layer, world.grid.solids, done_[1][l]);
    });
}

template <class R>
void MirrorWalls<R>::reflect(Crew& crew, World<R>& world) {
  if (!folds_) return;
  for (int axis = 0; axis < 3; ++axis)
    for_axis(crew, axis, [&](std::size_t l) {
      reflect_layer(world, layers_[l], world.grid.nodes, done_[0][l]);
      if (!world.grid.solids.empty()) reflect_layer(world, layers_[l], world.grid.solids, done_[1][l]);
    });
}

template <class R>
double MirrorWalls<R>::add_pushes(std::array<Push, 6>& walls) const {
  double gained = 0;
  for (const auto& done : done_)
    for (std::size_t l = 0; l < layers_.size(); ++l) {
      if (!done[l].folded) continue;
      walls[layers_[l].side] += done[l].push;
      gained += done[l].gained;
    }
  return gained;
}

#define DM_INSTANTIATE(R)                                     \
  template bool image_weighs(const World<R>&, int);           \
  template R before_images(const World<R>&, const Vec3i&, R); \
  template class MirrorWalls<R>;
DM_INSTANTIATE(float)
DM_INSTANTIATE(double)
#undef DM_INSTANTIATE

}  // namespace dreampm

#include "dreampm/backend/mirror_walls.h"

#include "dreampm/base/parallel.h"

namespace dreampm {
namespace {

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

/// The wall does not move: its push does no work.
template <class R>
void give(const World<R>& world, std::size_t at, Node<R>& node, const Vec3<R>& v, Push& push) {
  const Vec3i place =
      world.grid.blocks[at / block_nodes] * block_width + node_offset(static_cast<int>(at % block_nodes));
  push.add(world.node_position(place), static_cast<double>(node.m),
           Vec3d{double(node.x), double(node.y), double(node.z)}, static_cast<Vec3d>(v), Vec3d{});
  node.x = v.x, node.y = v.y, node.z = v.z;
}

}  // namespace

template <class R>
void MirrorWalls<R>::find(const World<R>& world) {
  for (auto& layers : layers_) layers.clear();
  if (!world.settings.keep_inside) return;
  for (int side = 0; side < 6; ++side) {
    const Wall& wall = world.walls[static_cast<std::size_t>(side)];
    const int a = axis_of(side), inward = inward_of(side);
    if (wall.type == WallType::open || (wall.type != WallType::stick && wall.friction > 0) ||
        world.periodic[static_cast<std::size_t>(a)] || world.high[a] - world.low[a] < 3)
      continue;
    const std::int32_t plane = inward > 0 ? world.low[a] - 1 : world.high[a] + 1;
    Vec3i step{};
    step[a] = inward;
    for (std::size_t b = 0; b < world.grid.blocks.size(); ++b)
      if (world.grid.blocks[b][a] == plane >> 2)
        layers_[static_cast<std::size_t>(side)].push_back(
            {b, world.grid.blocks.find(world.wrapped(world.grid.blocks[b] + step)), plane & 3, 0});
  }
}

template <class R>
template <class Body>
void MirrorWalls<R>::for_layer(int side, const Layer& layer, const Body& body) const {
  const int a = axis_of(side), inward = inward_of(side);
  for (int n = 0; n < 16; ++n) {
    int at[3];
    at[(a + 1) % 3] = n / 4, at[(a + 2) % 3] = n % 4;
    const auto node = [&](int along) {
      at[a] = along & 3;
      const std::size_t block = along == (along & 3) ? layer.block : static_cast<std::size_t>(layer.inward);
      return block * block_nodes + static_cast<std::size_t>(node_index(at[0], at[1], at[2]));
    };
    const int last = layer.local + 2 * inward;
    if (last != (last & 3) && layer.inward == BlockList::none) continue;
    body(n, Triple{node(layer.local), node(layer.local + inward), node(last)});
  }
}

template <class R>
void MirrorWalls<R>::fold(const World<R>& world, std::vector<Node<R>>& nodes, std::array<Push, 6>& walls) {
  for (int side = 5; side >= 0; --side) {
    auto& layers = layers_[static_cast<std::size_t>(side)];
    const int a = axis_of(side);
    const WallType type = world.walls[static_cast<std::size_t>(side)].type;
    pushes_.assign(layers.size(), {});
    parallel_for(layers.size(), 16, [&](std::size_t l) {
      layers[l].folded = 0;
      for_layer(side, layers[l], [&](int n, const Triple& t) {
        const Node<R>& ghost = nodes[t.ghost];
        Node<R>& inner = nodes[t.inner];
        if (!(ghost.m > R(least_mass)) || !(inner.m > R(least_mass))) return;
        const Node<R>& wall = nodes[t.wall];
        const R out = (a == 0 ? wall.x : a == 1 ? wall.y : wall.z) * R(inward_of(side));
        if (type == WallType::separate && !(out < R(0))) return;
        const Vec3<R> v{inner.x, inner.y, inner.z};
        give(world, t.inner, inner, v + (image_of(ghost, a, type) - v) * (ghost.m / (ghost.m + inner.m)), pushes_[l]);
        layers[l].folded = static_cast<std::uint16_t>(layers[l].folded | 1u << n);
      });
    });
    for (const Push& p : pushes_) walls[static_cast<std::size_t>(side)] += p;
  }
}

template <class R>
double MirrorWalls<R>::reflect(const World<R>& world, std::vector<Node<R>>& nodes, std::array<Push, 6>& walls) {
  double gained = 0;
  for (int side = 0; side < 6; ++side) {
    const auto& layers = layers_[static_cast<std::size_t>(side)];
    const WallType type = world.walls[static_cast<std::size_t>(side)].type;
    pushes_.assign(layers.size(), {});
    energy_.assign(layers.size(), 0);
    parallel_for(layers.size(), 16, [&](std::size_t l) {
      for_layer(side, layers[l], [&](int n, const Triple& t) {
        if (!(layers[l].folded >> n & 1)) return;
        const double before = kinetic_energy(nodes[t.ghost]);
        give(world, t.ghost, nodes[t.ghost], image_of(nodes[t.inner], axis_of(side), type), pushes_[l]);
        energy_[l] += kinetic_energy(nodes[t.ghost]) - before;
      });
    });
    for (std::size_t l = 0; l < layers.size(); ++l)
      walls[static_cast<std::size_t>(side)] += pushes_[l], gained += energy_[l];
  }
  return gained;
}

template class MirrorWalls<float>;
template class MirrorWalls<double>;

}  // namespace dreampm

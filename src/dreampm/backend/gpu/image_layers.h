// The images behind the walls of the box on a device, as MirrorWalls.
#pragma once
#include <cstdint>

#include "dreampm/backend/gpu/node_visit.h"

namespace dreampm::gpu {

/// A block's nodes behind a wall, as MirrorWalls::Layer.
struct ImageLayer {
  std::uint32_t ghosts, walls, inners;  ///< the planes' first nodes
  std::int32_t side, entry;             ///< `entry`: in VisitInput::given
  bool folds[2];                        ///< by field
  Vec3i ghost_node, inner_node;         ///< the places of the planes' first nodes
};

/// What the kernels of images have in common: the layers across one axis. A block of threads takes
/// four.
struct LayersInput {
  static constexpr int threads = 64, at_once = threads / plane_nodes;
  const ImageLayer* layers;
  std::int32_t count;

  /// The layer of a thread; null where there is none.
  DM_FN const ImageLayer* of(int block, int thread) const {
    const int l = block * at_once + thread / plane_nodes;
    return l < count ? layers + l : nullptr;
  }
  /// The place of node `n` in its plane [cells].
  static DM_FN Vec3<float> place(int axis, int n) {
    Vec3<float> at{0, 0, 0};
    at[(axis + 1) % 3] = static_cast<float>(n / block_width), at[(axis + 2) % 3] = static_cast<float>(n % block_width);
    return at;
  }
  /// Calls body(layer, field, node of its plane) for the fields that layers fold, one after the
  /// other, and adds what it returns to the layer's entry in VisitInput::given, about the origin
  /// from the plane that `first` is the place of. `fresh`: what is there does not count.
  template <class Block, class Body>
  DM_FN void each_folded(const VisitInput& in, Block& block, ImpulseTerms<float>* given, Vec3i ImageLayer::* first,
                         bool fresh, const Body& body) const {
    for (int f = 0; f < 2 && in.grid.field[f]; ++f) {
      block.each_thread([&](int t) {
        const ImageLayer* const layer = of(block.index(), t);
        given[t] = layer && layer->folds[f] ? body(*layer, f, t % plane_nodes) : ImpulseTerms<float>::none();
      });
      add_up_threads<threads, plane_nodes>(block, given);
      block.each_thread([&](int t) {
        const ImageLayer* const layer = of(block.index(), t);
        if (t % plane_nodes != 0 || !layer) return;
        SourceTerms sum = fresh && f == 0 ? SourceTerms::none() : in.given[layer->entry];
        sum.add(in.places.about_origin(given[t], layer->*first));
        in.given[layer->entry] = sum;
      });
    }
  }
};

/// Mixes the images of nodes behind walls into the nodes that they mirror.
struct FoldImages {
  static constexpr int threads = LayersInput::threads;
  struct Shared {
    ImpulseTerms<float> given[threads];
  };
  VisitInput in;
  LayersInput layers;
  std::uint8_t* folded;  ///< by layer, field and node

  template <class Block>
  DM_FN void operator()(Block& block, Shared& shared) const {
    layers.each_folded(in, block, shared.given, &ImageLayer::inner_node, true,
                       [&](const ImageLayer& layer, int f, int n) { return fold(layer, f, n); });
  }

 private:
  DM_FN ImpulseTerms<float> fold(const ImageLayer& layer, int f, int n) const {
    const int axis = axis_of(layer.side), from = node_in_plane(axis, n);
    const WallType type = in.step.walls[f].type[layer.side];
    Node<float>* const nodes = in.grid.field[f];
    const Node<float> ghost = nodes[layer.ghosts + from], wall = nodes[layer.walls + from];
    Node<float>& inner = nodes[layer.inners + from];
    const bool folds =
        image_folds(layer.side, type, ghost.m, inner.m, velocity(wall)) &&
        (!in.gaps[f].walls_of || in.gaps[f].closed(static_cast<int>(layer.ghosts / block_nodes), layer.side, n));
    folded[((&layer - layers.layers) * 2 + f) * plane_nodes + n] = folds;
    ImpulseSumOf<float> given;
    if (folds) {
      const Vec3<float> before = velocity(inner),
                        after = dreampm::folded(layer.side, type, folds, velocity(ghost), ghost.m, before, inner.m);
      set_velocity(inner, after);
      given.add(LayersInput::place(axis, n), inner.m, before, after, {0, 0, 0});
    }
    return ImpulseTerms<float>::of(given);
  }
};

/// Gives those nodes behind walls the velocity of their image.
struct ReflectImages {
  static constexpr int threads = LayersInput::threads;
  using Shared = FoldImages::Shared;
  VisitInput in;
  LayersInput layers;
  const std::uint8_t* folded;

  template <class Block>
  DM_FN void operator()(Block& block, Shared& shared) const {
    layers.each_folded(in, block, shared.given, &ImageLayer::ghost_node, false,
                       [&](const ImageLayer& layer, int f, int n) { return reflect(layer, f, n); });
  }

 private:
  DM_FN ImpulseTerms<float> reflect(const ImageLayer& layer, int f, int n) const {
    if (!folded[((&layer - layers.layers) * 2 + f) * plane_nodes + n]) return ImpulseTerms<float>::none();
    const int axis = axis_of(layer.side), from = node_in_plane(axis, n);
    Node<float>* const nodes = in.grid.field[f];
    Node<float>& ghost = nodes[layer.ghosts + from];
    const Vec3<float> before = velocity(ghost),
                      after = image_of(velocity(nodes[layer.inners + from]), axis, in.step.walls[f].type[layer.side]);
    set_velocity(ghost, after);
    ImpulseSumOf<float> given;
    given.add(LayersInput::place(axis, n), ghost.m, before, after, {0, 0, 0});
    return ImpulseTerms<float>::of(given, 0.5f * ghost.m * (dot(after, after) - dot(before, before)));
  }
};

/// Adds the masses of images, as MirrorWalls::add_image_mass.
struct AddImageMass {
  static constexpr int threads = LayersInput::threads;
  struct Shared {};
  GridPointers grid;
  LayersInput layers;

  template <class Block>
  DM_FN void operator()(Block& block, Shared&) const {
    block.each_thread([&](int t) {
      const ImageLayer* const layer = layers.of(block.index(), t);
      if (!layer) return;
      const int from = node_in_plane(axis_of(layer->side), t % plane_nodes);
      const std::int64_t behind = layer->ghosts + from, on = layer->walls + from, before = layer->inners + from;
      for (int f = 0; f < 2; ++f)
        if (Node<float>* const nodes = grid.field[f]) add_image(nodes[behind].m, nodes[on].m, nodes[before].m);
      Node<float>* const mixed = grid.mixture;
      if (!mixed) return;
      add_image(mixture::blocked(mixed[behind]), mixture::blocked(mixed[on]), mixture::blocked(mixed[before]));
      for (std::size_t f = 0; f < 2; ++f)
        add_image(mixture::filled(mixed[behind], f), mixture::filled(mixed[on], f), mixture::filled(mixed[before], f));
    });
  }
};

}  // namespace dreampm::gpu

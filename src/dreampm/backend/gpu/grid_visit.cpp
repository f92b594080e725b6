#include "dreampm/backend/gpu/grid_visit.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "dreampm/backend/block_visit.h"
#include "dreampm/backend/gpu/kernels.h"
#include "dreampm/backend/gpu/launch.h"
#include "dreampm/base/parallel.h"

namespace dreampm::gpu {
namespace {

/// Nodes lighter than this part of a particle do not count for the largest speed.
constexpr double light_part = 1e-6;
/// Nor do those of this part of the heaviest node, some 50 counts of mass.
constexpr double light_counts = 1e-7;

/// The sides whose walls a block has nodes on or behind, a bit each.
std::uint32_t walls_reached(const World<float>& world, const Vec3i& first) {
  const BoxWalls<float> felt = box_walls(world, 0).from(first);
  std::uint32_t walls = 0;
  for (int side = 0; side < 6; ++side)
    if (felt.type[side] != WallType::open && felt.reaches(side, block_width)) walls |= 1u << side;
  return walls;
}

std::size_t blocks_of(const LayersInput& layers) {
  return (static_cast<std::size_t>(layers.count) + LayersInput::at_once - 1) / LayersInput::at_once;
}

}  // namespace

GridVisit::GridVisit(Device& device)
    : device_(&device),
      shared_(device),
      around_(device),
      blocks_(device),
      entries_(device),
      waiting_(device),
      layers_(device),
      folded_(device),
      sums_(device),
      given_(device),
      dragged_(device),
      damped_(device),
      block_ranges_(device),
      wall_ranges_(device),
      parts_(device),
      fields_(device),
      deep_blocks_(device),
      deep_groups_(device),
      deep_nodes_(device),
      deep_surfaces_(device),
      gaps_(device),
      surfaces_(device) {}

void GridVisit::prepare(const World<float>& world, const Obstacles& obstacles, GridUpdate<float>& host,
                        const std::vector<StencilBlocks>& reached) {
  find_shared(world, reached);
  find_entries(world, obstacles, host);
  find_deep(world, obstacles);
  gaps_.prepare(world, obstacles, host.gaps());
  surfaces_.prepare(world, obstacles, host.surfaces(), host.gaps());
}

void GridVisit::colliders_moved(const World<float>& world, const Obstacles& obstacles, GridUpdate<float>& host) {
  find_deep(world, obstacles);
  if (!obstacles.changed()) return surfaces_.set_velocities(world, obstacles, host.surfaces());
  gaps_.prepare(world, obstacles, host.gaps());
  surfaces_.prepare(world, obstacles, host.surfaces(), host.gaps());
}

/// Finds the blocks that matter of both fields reaches, and what lies around them.
void GridVisit::find_shared(const World<float>& world, const std::vector<StencilBlocks>& reached) {
  is_shared_.assign(world.grid.blocks.size(), 0);
  std::vector<std::uint32_t> shared;
  std::vector<std::int32_t> around;
  if (world.needs_solid_field()) {
    constexpr std::uint8_t both = 3;
    for (std::size_t b = 0; b < reached.size(); ++b) {
      std::uint8_t fields = 0;
      for (const ParticleSet<float>& set : world.sets)
        if (set.size() > 0 && set.block_start[b] < set.block_start[b + 1])
          fields = static_cast<std::uint8_t>(fields | 1 << world.field_of(set));
      for (const std::int32_t at : reached[b])
        if (at != BlockList::none)
          is_shared_[static_cast<std::size_t>(at)] =
              static_cast<std::uint8_t>(is_shared_[static_cast<std::size_t>(at)] | fields);
    }
    for (std::size_t b = 0; b < is_shared_.size(); ++b)
      if (is_shared_[b] == both) shared.push_back(static_cast<std::uint32_t>(b));
    around.resize(shared.size() * 27);
    parallel_for(shared.size(), 64, [&](std::size_t i) {
      const Neighbors near = neighbors_in(world.grid.blocks, world, world.grid.blocks[shared[i]]);
      std::copy(near.begin(), near.end(), around.begin() + static_cast<std::ptrdiff_t>(27 * i));
    });
    for (std::uint8_t& fields : is_shared_) fields = fields == both;
  }
  images_ = solid_images(world);
  shared_.upload(shared), around_.upload(around);
}

void GridVisit::find_deep(const World<float>& world, const Obstacles& obstacles) {
  std::vector<DeepBlock> blocks;
  std::vector<DeepNodes> groups;
  std::vector<DeepNode> nodes;
  collider_of_group_.clear();
  const auto size = [](const auto& all) { return static_cast<std::uint32_t>(all.size()); };
  for (std::size_t b = 0; obstacles.any() && b < world.grid.blocks.size(); ++b) {
    const std::vector<ObstacleNode>& near = obstacles.at(b);
    const std::uint32_t begin = size(groups);
    for (std::size_t c = 0; !near.empty() && c < world.colliders.size(); ++c) {
      const std::uint32_t first = size(nodes);
      for (const ObstacleNode& o : near)
        if (o.collider == c && acts_within(world, o))
          nodes.push_back({o.node, static_cast<Vec3<float>>(o.normal), static_cast<Vec3<float>>(o.velocity)});
      if (size(nodes) == first) continue;
      groups.push_back({first, size(nodes), static_cast<std::int32_t>(c)});
      collider_of_group_.push_back(groups.back().collider);
    }
    if (size(groups) > begin) blocks.push_back({static_cast<std::uint32_t>(b), begin, size(groups)});
  }
  std::vector<ColliderSurface> surfaces;
  for (const Collider& c : world.colliders) {
    const auto friction = [&](std::size_t f) { return world.holds_liquid(f) ? 0.0f : static_cast<float>(c.friction); };
    surfaces.push_back({c.contact(), {friction(0), friction(1)}});
  }
  deep_blocks_.upload(blocks), deep_groups_.upload(groups), deep_nodes_.upload(nodes), deep_surfaces_.upload(surfaces);
}

/// Every block at a wall and every layer of images writes its impulses to a place of its own; those
/// of one side lie together.
void GridVisit::find_entries(const World<float>& world, const Obstacles& obstacles, const GridUpdate<float>& host) {
  const MirrorWalls<float>& images = host.images();
  // Where colliders move they may come anywhere until the next sort.
  all_wait_ = std::any_of(world.colliders.begin(), world.colliders.end(),
                          [](const Collider& c) { return c.path || c.changing || !c.stands(); });
  const BlockList& list = world.grid.blocks;
  std::vector<VisitBlock> blocks(list.size());
  std::vector<std::uint32_t> waiting;
  std::vector<std::int32_t> entries;
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    const Vec3i first = list[b] * block_width;
    const std::uint32_t walls = walls_reached(world, first);
    const bool waits =
        is_shared_[b] || images.changes(b) || host.surfaces().changes(b) || (obstacles.any() && obstacles.near(b));
    blocks[b] = {first, walls, waits, walls ? static_cast<std::int32_t>(entries.size()) : -1};
    if (waits) waiting.push_back(static_cast<std::uint32_t>(b));
    if (walls) entries.resize(entries.size() + 6, -1);
  }
  std::vector<ImageLayer> layers = find_layers(list, images);

  std::vector<Range> ranges;
  side_of_range_.clear();
  std::uint32_t count = 0;
  for (int side = 0; side < 6; ++side) {
    const std::uint32_t begin = count;
    for (const VisitBlock& b : blocks)
      if (b.walls >> side & 1) entries[static_cast<std::size_t>(b.entries + side)] = static_cast<std::int32_t>(count++);
    if (folds_)
      for (ImageLayer& l : layers)
        if (l.side == side) l.entry = static_cast<std::int32_t>(count++);
    add_ranges(begin, count, ranges);
    side_of_range_.resize(ranges.size(), side);
  }
  wall_ranges_.upload(ranges);
  ranges.clear();
  add_ranges(0, static_cast<std::uint32_t>(blocks.size()), ranges);
  block_ranges_.upload(ranges);
  blocks_.upload(blocks), waiting_.upload(waiting), entries_.upload(entries), layers_.upload(layers);
  folded_.resize(layers.size() * 2 * plane_nodes);
  sums_.resize(blocks.size()), given_.resize(count);
  // Entries of layers stay as they are.
  dragged_.upload(std::vector<SourceTerms>(world.has_skin_friction() ? count : 0, SourceTerms::none()));
}

std::vector<ImageLayer> GridVisit::find_layers(const BlockList& list, const MirrorWalls<float>& images) {
  const auto node = [&](std::size_t at) {
    return list[at / block_nodes] * block_width + node_offset(static_cast<int>(at % block_nodes));
  };
  std::vector<ImageLayer> layers;
  for (int axis = 0; axis < 3; ++axis) {
    axes_[static_cast<std::size_t>(axis)] = static_cast<std::uint32_t>(layers.size());
    for (const auto& l : images.layers(axis))
      layers.push_back({static_cast<std::uint32_t>(l.ghosts),
                        static_cast<std::uint32_t>(l.walls),
                        static_cast<std::uint32_t>(l.inners),
                        l.side,
                        -1,
                        {l.folds[0], l.folds[1]},
                        node(l.ghosts),
                        node(l.inners)});
  }
  axes_[3] = static_cast<std::uint32_t>(layers.size());
  folds_ = images.folds();
  return layers;
}

GridStats GridVisit::operator()(const World<float>& world, Memory& memory, double dt, bool thin) {
  GridStats total;
  total.colliders.resize(world.colliders.size());
  gaps_.measure(world, memory, thin);
  VisitInput in = input(world, memory, dt, world.viscous_stages == 0 ? 1 : 0);
  in.all_wait = fields_.begin(world, dt) || in.all_wait;
  launch(*device_, BeginVisit{in}, blocks_.size());
  fields_.apply(in);
  contact(in, nullptr, world, dt);
  fields_.find_work(in);
  add_results(in, nullptr, total);
  return total;
}

void GridVisit::contact(const VisitInput& in, const StageInput* stage, const World<float>& world, double dt) {
  lay_parts(in, stage);
  surfaces_(in, world, gaps_, dt, !stage);
  const auto folded = [&](int axis) {
    return folded_.data() + axes_[static_cast<std::size_t>(axis)] * 2 * plane_nodes;
  };
  for (int axis = 2; folds_ && axis >= 0; --axis)
    launch(*device_, FoldImages{in, layers(axis), folded(axis)}, blocks_of(layers(axis)));
  launch(*device_, MeetSolids{shared_nodes(in)}, shared_count());
  launch(*device_,
         MeetDeep{in, deep_blocks_.data(), deep_groups_.data(), deep_nodes_.data(), deep_surfaces_.data(),
                  there<SourceTerms>(of_deep)},
         deep_blocks_.size());
  if (in.all_wait)
    launch(*device_, FinishVisit{in, nullptr}, blocks_.size());
  else
    launch(*device_, FinishVisit{in, waiting_.data()}, waiting_.size());
  for (int axis = 0; folds_ && axis < 3; ++axis)
    launch(*device_, ReflectImages{in, layers(axis), folded(axis)}, blocks_of(layers(axis)));
}

VisitInput GridVisit::input(const World<float>& world, Memory& memory, double dt, double part) {
  VisitInput in{};
  in.step = node_constants(world, dt, part);
  in.grid = memory.grid_pointers();
  for (std::size_t f = 0; f < 2; ++f) {
    double lightest = 1e30, heaviest = 0;  // particle
    for (const ParticleSet<float>& set : world.sets)
      if (world.field_of(set) == f) lightest = std::min(lightest, set.mass), heaviest = std::max(heaviest, set.mass);
    // A node of the field is no heavier than a few hundred of its particles.
    const double counted = std::min(world.scatter_bounds[1], 256 * heaviest);
    in.light[f] = static_cast<float>(std::max(light_part * lightest, light_counts * counted));
  }
  for (std::size_t f = 0; f < 2; ++f) {
    const double share = in.grid.velocity_old[f] ? world.kept_share(f) : 0;
    in.unweigh[f] = static_cast<float>(1 / share);
    in.gaps[f] = gaps_.pointers(f);
  }
  in.places = {world.origin, world.dx, world.low};
  in.blocks = blocks_.data(), in.entries = entries_.data();
  in.sums = sums_.data(), in.given = given_.data();
  in.all_wait = all_wait_;
  if (in.step.keep != 1) damped_.resize(blocks_.size()), in.damped = damped_.data();
  return in;
}

LayersInput GridVisit::layers(int axis) const {
  const std::uint32_t begin = axes_[static_cast<std::size_t>(axis)], end = axes_[static_cast<std::size_t>(axis) + 1];
  return {layers_.data() + begin, static_cast<std::int32_t>(end - begin)};
}

void GridVisit::lay_parts(const VisitInput& in, const StageInput* stage) {
  const std::size_t blocks = block_ranges_.size(), walls = wall_ranges_.size();
  const std::array<std::size_t, parts> sizes{blocks,
                                             walls,
                                             stage && stage->dragged ? walls : 0,
                                             in.damped ? blocks : 0,
                                             !stage && fields_.given() ? blocks : 0,
                                             stage ? blocks : 0,
                                             surfaces_.ranges().size(),
                                             collider_of_group_.size()};
  for (std::size_t p = 0; p < parts; ++p) parts_at_[p + 1] = parts_at_[p] + sizes[p];
  static_assert(sizeof(GridTerms) == sizeof(SourceTerms));
  parts_.resize(parts_at_[parts] * sizeof(SourceTerms));
}

template <class T>
T GridVisit::at_home(std::size_t number) const {
  T one;
  std::memcpy(&one, home_.data() + number * sizeof(T), sizeof(T));
  return one;
}

double GridVisit::add_results(const VisitInput& in, const StageInput* stage, GridStats& total) {
  launch(*device_, AddUp<GridTerms>{in.sums, block_ranges_.data(), there<GridTerms>(of_grid)}, size_of(of_grid));
  const auto add_up = [&](Part part, const SourceTerms* from, const Buffer<Range>& ranges) {
    launch(*device_, AddUp<SourceTerms>{from, ranges.data(), there<SourceTerms>(part)}, size_of(part));
  };
  add_up(of_walls, in.given, wall_ranges_);
  add_up(of_damping, in.damped, block_ranges_);
  add_up(of_fields, fields_.given(), block_ranges_);
  add_up(of_surfaces, surfaces_.given(), surfaces_.ranges());
  if (stage) add_up(of_layers, stage->dragged, wall_ranges_), add_up(of_forces, stage->driven, block_ranges_);
  home_.resize(parts_.size());
  parts_.download(home_);

  GridTerms sum = GridTerms::none();
  for (std::size_t i = 0; i < size_of(of_grid); ++i) sum.add(at_home<GridTerms>(i));
  total.max_speed = std::sqrt(sum.fastest2);
  total.mass = sum.mass;
  total.moment = {sum.moment[0], sum.moment[1], sum.moment[2]};
  total.kinetic = 0.5 * sum.kinetic2;
  total.arrived = 0.5 * sum.arrived2;
  total.finite = sum.finite;
  double work = 0;
  const auto each = [&](Part part, auto&& add) {
    for (std::size_t i = 0; i < size_of(part); ++i) add(i, at_home<SourceTerms>(parts_at_[part] + i));
  };
  for (const Part part : {of_walls, of_layers})
    each(part, [&](std::size_t i, const SourceTerms& one) {
      total.walls[static_cast<std::size_t>(side_of_range_[i])] += one.sum();
      total.kinetic += one.gained;
    });
  each(of_damping, [&](std::size_t, const SourceTerms& one) { total.damping += one.sum(); });
  each(of_fields, [&](std::size_t, const SourceTerms& one) { total.fields += one.sum(); });
  each(of_forces, [&](std::size_t, const SourceTerms& one) { work += one.work; });
  each(of_surfaces,
       [&](std::size_t i, const SourceTerms& one) { total.colliders[surfaces_.collider_of(i)] += one.sum(); });
  each(of_deep, [&](std::size_t i, const SourceTerms& one) {
    total.colliders[static_cast<std::size_t>(collider_of_group_[i])] += one.sum();
  });
  return work;
}

void GridVisit::add_image_mass(const World<float>& world, Memory& memory, double dt) {
  if (layers_.size() == 0 || !measures_density(world, dt)) return;
  for (int axis = 0; axis < 3; ++axis)
    launch(*device_, AddImageMass{memory.grid_pointers(), layers(axis)}, blocks_of(layers(axis)));
}

}  // namespace dreampm::gpu

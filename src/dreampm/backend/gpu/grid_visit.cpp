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
      fielded_(device),
      block_ranges_(device),
      wall_ranges_(device),
      parts_(device),
      block_parts_(device),
      fields_(device),
      field_impulses_{Buffer<Vec3<float>>(device), Buffer<Vec3<float>>(device)},
      deep_blocks_(device),
      deep_groups_(device),
      deep_nodes_(device),
      surfaces_(device),
      deep_given_(device),
      surface_blocks_(device),
      copies_(device),
      near_(device),
      near_colliders_(device),
      planes_(device),
      gaps_of_(device),
      walls_of_(device),
      gaps_(device),
      gap_(device),
      asked_(device),
      asked_gaps_(device) {}

void GridVisit::prepare(const World<float>& world, const Obstacles& obstacles, GridUpdate<float>& host,
                        const std::vector<StencilBlocks>& reached) {
  find_shared(world, reached);
  find_entries(world, obstacles, host);
  colliders_moved(world, obstacles, host);
}

void GridVisit::colliders_moved(const World<float>& world, const Obstacles& obstacles, GridUpdate<float>& host) {
  find_gaps(world, obstacles, host);
  find_deep(world, obstacles);
  surface_blocks_.upload(host.surface_blocks());
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
  deep_blocks_.upload(blocks), deep_groups_.upload(groups), deep_nodes_.upload(nodes), surfaces_.upload(surfaces);
  deep_given_.resize(groups.size());
}

void GridVisit::find_gaps(const World<float>& world, const Obstacles& obstacles, GridUpdate<float>& host) {
  const ContactGaps& gaps = host.gaps();
  for (std::size_t f = 0; f < 2; ++f) gapped_[f] = gaps.has(world, f);
  std::vector<NearWalls> near;
  std::vector<std::uint32_t> colliders;
  for (const ContactGaps::NearBlock& b : gaps.near_blocks()) {
    if (gaps.reaches_colliders(b, obstacles)) colliders.push_back(b.block);
    if (std::all_of(b.plane.begin(), b.plane.end(), [](std::int8_t plane) { return plane < 0; })) continue;
    NearWalls& one = near.emplace_back(NearWalls{b.block, {}});
    std::copy(b.plane.begin(), b.plane.end(), one.plane);
  }
  std::vector<WallPlane> planes;
  for (const ContactGaps::WallNodes& w : gaps.wall_nodes()) {
    WallPlane& one = planes.emplace_back(WallPlane{{}, w.side, w.plane});
    std::copy(w.from.begin(), w.from.end(), one.from);
  }
  std::vector<std::int32_t> walls_of;
  for (const auto& of_block : gaps.walls_of()) walls_of.insert(walls_of.end(), of_block.begin(), of_block.end());
  asked_home_.clear();
  if (!colliders.empty()) {
    std::vector<std::uint32_t> blocks;
    host.find_gap_blocks(blocks);
    for (const std::uint32_t b : blocks)
      if (gaps.gaps_of()[b] >= 0) asked_home_.push_back(gaps.gaps_of()[b]);
  }
  near_.upload(near), near_colliders_.upload(colliders), planes_.upload(planes);
  gaps_of_.upload(gaps.gaps_of()), walls_of_.upload(walls_of), asked_.upload(asked_home_);
  gaps_.resize(gaps.gap_count() * block_gaps);
  gap_.resize(planes.size() * plane_nodes);
}

/// Every block at a wall and every layer of images writes its impulses to a place of its own; those
/// of one side lie together.
void GridVisit::find_entries(const World<float>& world, const Obstacles& obstacles, const GridUpdate<float>& host) {
  const MirrorWalls<float>& images = host.images();
  // Where colliders move they may come anywhere until the next sort.
  const bool all_wait = std::any_of(world.colliders.begin(), world.colliders.end(),
                                    [](const Collider& c) { return c.path || c.changing || !c.stands(); });
  const BlockList& list = world.grid.blocks;
  std::vector<VisitBlock> blocks(list.size());
  std::vector<std::uint32_t> waiting;
  std::vector<std::int32_t> entries;
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    const Vec3i first = list[b] * block_width;
    const std::uint32_t walls = walls_reached(world, first);
    const bool waits = all_wait || is_shared_[b] || images.changes(b) || (obstacles.any() && obstacles.near(b));
    blocks[b] = {first, walls, waits, walls ? static_cast<std::int32_t>(entries.size()) : -1};
    if (blocks[b].waits) waiting.push_back(static_cast<std::uint32_t>(b));
    if (walls) entries.resize(entries.size() + 6, -1);
  }
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

GridStats GridVisit::operator()(World<float>& world, Memory& memory, const Obstacles& obstacles,
                                GridUpdate<float>& host, double dt, bool thin) {
  GridStats total;
  total.colliders.resize(world.colliders.size());
  if (gapped()) measure_gaps(world, memory, host.gaps(), thin);
  VisitInput in = input(world, memory, dt, world.viscous_stages == 0 ? 1 : 0);
  in.all_wait = !world.fields.empty();
  launch(*device_, BeginVisit{in}, blocks_.size());
  apply_fields(in, world, dt);
  contact(in, world, memory, obstacles, host, dt, true, total);
  if (in.all_wait) launch(*device_, FieldWork{in, fields()}, blocks_.size());
  add_results(in, false, total);
  return total;
}

void GridVisit::contact(const VisitInput& in, World<float>& world, Memory& memory, const Obstacles& obstacles,
                        GridUpdate<float>& host, double dt, bool bodies, GridStats& found) {
  meet_surfaces(world, memory, obstacles, host, dt, bodies, found);
  const auto folded = [&](int axis) {
    return folded_.data() + axes_[static_cast<std::size_t>(axis)] * 2 * plane_nodes;
  };
  for (int axis = 2; folds_ && axis >= 0; --axis)
    launch(*device_, FoldImages{in, layers(axis), folded(axis)}, blocks_of(layers(axis)));
  launch(*device_, MeetSolids{shared_nodes(in)}, shared_count());
  launch(
      *device_,
      MeetDeep{in, deep_blocks_.data(), deep_groups_.data(), deep_nodes_.data(), surfaces_.data(), deep_given_.data()},
      deep_blocks_.size());
  if (in.all_wait)
    launch(*device_, FinishVisit{in, nullptr}, blocks_.size());
  else
    launch(*device_, FinishVisit{in, waiting_.data()}, waiting_.size());
  for (int axis = 0; folds_ && axis < 3; ++axis)
    launch(*device_, ReflectImages{in, layers(axis), folded(axis)}, blocks_of(layers(axis)));
}

void GridVisit::apply_fields(const VisitInput& in, const World<float>& world, double dt) {
  std::vector<FieldStep> steps;
  for (const auto& one : FieldSteps<float>(world, dt)) steps.emplace_back(one.step, one.box);
  fields_.upload(steps);
  if (steps.empty()) return;
  fielded_.resize(blocks_.size());
  for (std::size_t f = 0; f < 2; ++f) field_impulses_[f].resize(world.grid.field(f).size());
  launch(*device_, ApplyFields{in, fields()}, blocks_.size());
}

FieldInput GridVisit::fields() const {
  return {fields_.data(),
          static_cast<std::int32_t>(fields_.size()),
          {field_impulses_[0].data(), field_impulses_[1].data()},
          fielded_.data()};
}

double GridVisit::field_work(const VisitInput& in) {
  if (fields_.size() == 0) return 0;
  launch(*device_, FieldWork{in, fields()}, blocks_.size());
  return sum_of_blocks(fielded_).work;
}

void GridVisit::meet_surfaces(World<float>& world, Memory& memory, const Obstacles& obstacles, GridUpdate<float>& host,
                              double dt, bool bodies, GridStats& found) {
  const std::vector<std::uint32_t>& blocks = host.surface_blocks();
  if (blocks.empty()) return;
  const std::size_t size = blocks.size() * block_nodes, fields = world.grid.solids.empty() ? 1 : 2;
  copies_.resize(fields * size), copies_home_.resize(copies_.size());
  const auto copy_there = [&](bool back) {
    for (std::size_t f = 0; f < fields; ++f)
      launch(
          *device_,
          CopyBlocks{surface_blocks_.data(), memory.nodes[of_field(nodes, f)].data(), copies_.data() + f * size, back},
          blocks.size());
  };
  const auto copy_here = [&](auto&& one) {
    for (std::size_t f = 0; f < fields; ++f)
      for (std::size_t i = 0; i < blocks.size(); ++i)
        one(world.grid.field(f).data() + std::size_t{blocks[i]} * block_nodes,
            copies_home_.data() + f * size + i * block_nodes);
  };
  copy_there(false);
  copies_.download(copies_home_);
  copy_here([](Node<float>* here, const Node<float>* there) { std::copy_n(there, block_nodes, here); });
  host.meet_surfaces(world, obstacles, dt, bodies, found);
  copy_here([](const Node<float>* here, Node<float>* there) { std::copy_n(here, block_nodes, there); });
  copies_.upload(copies_home_);
  copy_there(true);
}

void GridVisit::measure_gaps(const World<float>& world, Memory& memory, ContactGaps& gaps, bool thin) {
  launch(*device_, ClearGaps{gaps_.data(), ContactGaps::none}, gaps_.size() / block_gaps);
  for (std::size_t s = 0; s < world.sets.size(); ++s) {
    const ParticleSet<float>& set = world.sets[s];
    if (set.liquid || set.size() == 0) continue;
    const SetMemory& m = memory.sets[s];
    const GapInput in{{m.now.u[0].data(), m.now.u[1].data(), m.now.u[2].data()},
                      m.block_start.data(),
                      memory.stencil_blocks.data(),
                      gaps_of_.data(),
                      gaps_.data(),
                      static_cast<float>(ColliderContact::contact_gap * set.spacing() / world.dx)};
    launch(*device_, MeasureGaps{in, near_.data()}, near_.size());
    MeasureColliderGaps before{in, near_colliders_.data(), memory.clearance.data(), {}};
    for (std::size_t c = 0; thin && c < 4; ++c) before.distance[c] = m.distance[c].data();
    launch(*device_, before, near_colliders_.size());
  }
  launch(*device_,
         FindWallGaps{planes_.data(), static_cast<std::int32_t>(planes_.size()), gaps_.data(), ContactGaps::none,
                      gap_.data()},
         (planes_.size() + FindWallGaps::at_once - 1) / FindWallGaps::at_once);
  if (asked_home_.empty()) return;
  asked_gaps_.resize(asked_home_.size() * block_gaps), asked_gaps_home_.resize(asked_gaps_.size());
  launch(*device_, CopyGaps{asked_.data(), gaps_.data(), asked_gaps_.data()}, asked_home_.size());
  asked_gaps_.download(asked_gaps_home_);
  for (std::size_t i = 0; i < asked_home_.size(); ++i)
    gaps.set_gaps(asked_home_[i], asked_gaps_home_.data() + i * block_gaps);
}

VisitInput GridVisit::input(const World<float>& world, Memory& memory, double dt, double part) {
  VisitInput in{};
  in.step = node_constants(world, dt, part);
  in.grid = memory.grid_pointers();
  double lightest = 1e30;
  for (const ParticleSet<float>& set : world.sets) lightest = std::min(lightest, set.mass);
  in.light = static_cast<float>(std::max(light_part * lightest, light_counts * world.scatter_bounds[1]));
  for (std::size_t f = 0; f < 2; ++f) {
    const double share = in.grid.velocity_old[f] ? world.kept_share(f) : 0;
    in.unweigh[f] = static_cast<float>(1 / share);
    if (gapped_[f]) in.gaps[f] = {walls_of_.data(), gap_.data()};
  }
  in.places = {world.origin, world.dx, world.low};
  in.blocks = blocks_.data(), in.entries = entries_.data();
  in.sums = sums_.data(), in.given = given_.data();
  if (in.step.keep != 1) damped_.resize(blocks_.size()), in.damped = damped_.data();
  return in;
}

LayersInput GridVisit::layers(int axis) const {
  const std::uint32_t begin = axes_[static_cast<std::size_t>(axis)], end = axes_[static_cast<std::size_t>(axis) + 1];
  return {layers_.data() + begin, static_cast<std::int32_t>(end - begin)};
}

void GridVisit::add_results(const VisitInput& in, bool dragged, GridStats& total) {
  // All sums come home at once.
  const std::size_t blocks = block_ranges_.size(), walls = wall_ranges_.size(), deep = deep_given_.size(),
                    damping = in.damped ? blocks : 0, drag = dragged ? walls : 0, fields = in.all_wait ? blocks : 0;
  static_assert(sizeof(GridTerms) == sizeof(SourceTerms));
  parts_.resize((blocks + walls + drag + damping + fields) * sizeof(GridTerms));
  auto* const grid = reinterpret_cast<GridTerms*>(parts_.data());
  auto* const given = reinterpret_cast<SourceTerms*>(grid + blocks);
  launch(*device_, AddUp<GridTerms>{sums_.data(), block_ranges_.data(), grid}, blocks);
  launch(*device_, AddUp<SourceTerms>{given_.data(), wall_ranges_.data(), given}, walls);
  launch(*device_, AddUp<SourceTerms>{dragged_.data(), wall_ranges_.data(), given + walls}, drag);
  launch(*device_, AddUp<SourceTerms>{damped_.data(), block_ranges_.data(), given + walls + drag}, damping);
  launch(*device_, AddUp<SourceTerms>{fielded_.data(), block_ranges_.data(), given + walls + drag + damping}, fields);
  home_.resize(parts_.size());
  parts_.download(home_);
  const auto part = [&]<class T>(std::size_t i, T) {
    T one;
    std::memcpy(&one, home_.data() + i * sizeof(T), sizeof(T));
    return one;
  };

  GridTerms sum = GridTerms::none();
  for (std::size_t i = 0; i < blocks; ++i) sum.add(part(i, GridTerms{}));
  total.max_speed = std::sqrt(sum.fastest2);
  total.mass = sum.mass;
  total.moment = {sum.moment[0], sum.moment[1], sum.moment[2]};
  total.kinetic = 0.5 * sum.kinetic2;
  total.arrived = 0.5 * sum.arrived2;
  total.finite = sum.finite;
  for (std::size_t i = 0; i < walls + drag; ++i) {
    const SourceTerms one = part(blocks + i, SourceTerms{});
    total.walls[static_cast<std::size_t>(side_of_range_[i % walls])] += one.sum();
    total.kinetic += one.gained;
  }
  for (std::size_t i = 0; i < damping; ++i) total.damping += part(blocks + walls + drag + i, SourceTerms{}).sum();
  for (std::size_t i = 0; i < fields; ++i)
    total.fields += part(blocks + walls + drag + damping + i, SourceTerms{}).sum();
  if (deep == 0) return;
  deep_home_.resize(deep, SourceTerms::none());
  deep_given_.download(deep_home_);
  for (std::size_t i = 0; i < deep; ++i)
    total.colliders[static_cast<std::size_t>(collider_of_group_[i])] += deep_home_[i].sum();
}

SourceTerms GridVisit::sum_of_blocks(const Buffer<SourceTerms>& numbers) {
  block_parts_.resize(block_ranges_.size()), block_parts_home_.resize(block_ranges_.size(), SourceTerms::none());
  launch(*device_, AddUp<SourceTerms>{numbers.data(), block_ranges_.data(), block_parts_.data()}, block_ranges_.size());
  block_parts_.download(block_parts_home_);
  SourceTerms sum = SourceTerms::none();
  for (const SourceTerms& part : block_parts_home_) sum.add(part);
  return sum;
}

void GridVisit::add_image_mass(const World<float>& world, Memory& memory, double dt) {
  if (layers_.size() == 0 || !measures_density(world, dt)) return;
  for (int axis = 0; axis < 3; ++axis)
    launch(*device_, AddImageMass{memory.grid_pointers(), layers(axis)}, blocks_of(layers(axis)));
}

}  // namespace dreampm::gpu

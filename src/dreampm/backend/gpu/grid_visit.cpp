#include "dreampm/backend/gpu/grid_visit.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "dreampm/backend/block_visit.h"
#include "dreampm/backend/gpu/kernels.h"
#include "dreampm/backend/gpu/launch.h"

namespace dreampm::gpu {
namespace {

/// Nodes lighter than this part of a particle do not count for the largest speed.
constexpr double light_part = 1e-6;

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
      blocks_(device),
      entries_(device),
      waiting_(device),
      layers_(device),
      folded_(device),
      sums_(device),
      given_(device),
      damped_(device),
      block_ranges_(device),
      wall_ranges_(device),
      parts_(device),
      near_(device),
      planes_(device),
      gaps_of_(device),
      walls_of_(device),
      gaps_(device),
      gap_(device) {}

bool GridVisit::takes(const World<float>& world, const Obstacles& obstacles) {
  return !obstacles.any() && world.rigid.empty() && world.fields.empty() && world.viscous_stages == 0 &&
         !world.needs_solid_field();
}

void GridVisit::prepare(const World<float>& world, const MirrorWalls<float>& images, const ContactGaps& gaps) {
  find_entries(world, images);
  for (std::size_t f = 0; f < 2; ++f) gapped_[f] = gaps.has(world, f);
  std::vector<NearWalls> near;
  for (const ContactGaps::NearBlock& b : gaps.near_blocks()) {
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
  near_.upload(near), planes_.upload(planes), gaps_of_.upload(gaps.gaps_of()), walls_of_.upload(walls_of);
  gaps_.resize(gaps.gap_count() * block_gaps);
  gap_.resize(planes.size() * plane_nodes);
}

/// Every block at a wall and every layer of images writes its impulses to a place of its own; those
/// of one side lie together.
void GridVisit::find_entries(const World<float>& world, const MirrorWalls<float>& images) {
  const BlockList& list = world.grid.blocks;
  std::vector<VisitBlock> blocks(list.size());
  std::vector<std::uint32_t> waiting;
  std::vector<std::int32_t> entries;
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    const Vec3i first = list[b] * block_width;
    const std::uint32_t walls = walls_reached(world, first);
    blocks[b] = {first, walls, images.changes(b), walls ? static_cast<std::int32_t>(entries.size()) : -1};
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
      layers.push_back({static_cast<std::uint32_t>(l.ghosts), static_cast<std::uint32_t>(l.walls),
                        static_cast<std::uint32_t>(l.inners), l.side, -1, {l.folds[0], l.folds[1]}, node(l.ghosts),
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
}

GridStats GridVisit::operator()(const World<float>& world, Memory& memory, double dt) {
  if (gapped_[0] || gapped_[1]) measure_gaps(world, memory);
  const VisitInput in = input(world, memory, dt);
  launch(BeginVisit{in}, blocks_.size());
  for (int axis = 2; folds_ && axis >= 0; --axis)
    launch(FoldImages{in, layers(axis), folded_.data() + axes_[static_cast<std::size_t>(axis)] * 2 * plane_nodes},
           blocks_of(layers(axis)));
  launch(FinishVisit{in, waiting_.data()}, waiting_.size());
  for (int axis = 0; folds_ && axis < 3; ++axis)
    launch(ReflectImages{in, layers(axis), folded_.data() + axes_[static_cast<std::size_t>(axis)] * 2 * plane_nodes},
           blocks_of(layers(axis)));
  return results(world, in.damped != nullptr);
}

void GridVisit::measure_gaps(const World<float>& world, Memory& memory) {
  launch(ClearGaps{gaps_.data(), ContactGaps::none}, gaps_.size() / block_gaps);
  for (std::size_t s = 0; s < world.sets.size(); ++s) {
    const ParticleSet<float>& set = world.sets[s];
    if (set.liquid || set.size() == 0) continue;
    const SetMemory& m = memory.sets[s];
    launch(MeasureGaps{near_.data(),
                       {m.now.u[0].data(), m.now.u[1].data(), m.now.u[2].data()},
                       m.block_start.data(),
                       memory.stencil_blocks.data(),
                       gaps_of_.data(),
                       gaps_.data(),
                       static_cast<float>(ColliderContact::contact_gap * set.spacing() / world.dx)},
           near_.size());
  }
  launch(FindWallGaps{planes_.data(), static_cast<std::int32_t>(planes_.size()), gaps_.data(), ContactGaps::none,
                      gap_.data()},
         (planes_.size() + FindWallGaps::at_once - 1) / FindWallGaps::at_once);
}

VisitInput GridVisit::input(const World<float>& world, Memory& memory, double dt) {
  VisitInput in{};
  in.step = node_constants(world, dt, 1);
  in.grid = memory.grid_pointers();
  double lightest = 1e30;
  for (const ParticleSet<float>& set : world.sets) lightest = std::min(lightest, set.mass);
  in.light = static_cast<float>(light_part * lightest);
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

GridStats GridVisit::results(const World<float>& world, bool damped) {
  // All sums come home at once.
  const std::size_t blocks = block_ranges_.size(), walls = wall_ranges_.size();
  static_assert(sizeof(GridTerms) == sizeof(SourceTerms));
  parts_.resize((2 * blocks + walls) * sizeof(GridTerms));
  auto* const grid = reinterpret_cast<GridTerms*>(parts_.data());
  auto* const given = reinterpret_cast<SourceTerms*>(grid + blocks);
  launch(AddUp<GridTerms>{sums_.data(), block_ranges_.data(), grid}, blocks);
  launch(AddUp<SourceTerms>{given_.data(), wall_ranges_.data(), given}, walls);
  if (damped) launch(AddUp<SourceTerms>{damped_.data(), block_ranges_.data(), given + walls}, blocks);
  home_.resize(parts_.size());
  parts_.download(home_);
  const auto part = [&]<class T>(std::size_t i, T) {
    T one;
    std::memcpy(&one, home_.data() + i * sizeof(T), sizeof(T));
    return one;
  };

  GridStats total;
  total.colliders.resize(world.colliders.size());
  GridTerms sum = GridTerms::none();
  for (std::size_t i = 0; i < blocks; ++i) sum.add(part(i, GridTerms{}));
  total.max_speed = std::sqrt(sum.fastest2);
  total.mass = sum.mass;
  total.moment = {sum.moment[0], sum.moment[1], sum.moment[2]};
  total.kinetic = 0.5 * sum.kinetic2;
  total.arrived = 0.5 * sum.arrived2;
  total.finite = sum.finite;
  for (std::size_t i = 0; i < walls; ++i) {
    const SourceTerms one = part(blocks + i, SourceTerms{});
    total.walls[static_cast<std::size_t>(side_of_range_[i])] += one.sum();
    total.kinetic += one.gained;
  }
  for (std::size_t i = 0; damped && i < blocks; ++i) total.damping += part(blocks + walls + i, SourceTerms{}).sum();
  return total;
}

void GridVisit::add_image_mass(const World<float>& world, Memory& memory, double dt) {
  if (layers_.size() == 0 || !measures_density(world, dt)) return;
  for (int axis = 0; axis < 3; ++axis)
    launch(AddImageMass{memory.grid_pointers(), layers(axis)}, blocks_of(layers(axis)));
}

}  // namespace dreampm::gpu

#include "dreampm/backend/gpu/gap_measure.h"

#include <algorithm>

namespace dreampm::gpu {

void GapMeasure::prepare(const World<float>& world, const Obstacles& obstacles, const ContactGaps& gaps) {
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
  near_.upload(near), near_colliders_.upload(colliders), planes_.upload(planes);
  gaps_of_.upload(gaps.gaps_of()), walls_of_.upload(walls_of);
  gaps_.resize(gaps.gap_count() * block_gaps);
  gap_.resize(planes.size() * plane_nodes);
}

void GapMeasure::measure(const World<float>& world, Memory& memory, bool thin) {
  if (!any()) return;
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
}

}  // namespace dreampm::gpu

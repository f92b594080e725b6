#include "dreampm/backend/gpu/thin_distances.h"

#include "dreampm/base/parallel.h"

namespace dreampm::gpu {

void ThinDistances::prepare(const World<float>& world, Memory& memory, const Obstacles& obstacles,
                            const std::vector<StencilBlocks>& reached) {
  measured_ = false;
  near_.clear();
  for (std::size_t b = 0; obstacles.any_thin() && b < reached.size(); ++b)
    if (ThinWalls(obstacles, reached[b]).any()) near_.push_back(static_cast<std::uint32_t>(b));
  if (near_.empty()) return;
  blocks_.upload(near_);
  starts_home_.assign(world.sets.size(), {});
  while (starts_.size() < world.sets.size()) starts_.emplace_back(*device_);
  for (std::size_t s = 0; s < world.sets.size(); ++s) {
    const ParticleSet<float>& set = world.sets[s];
    std::vector<std::uint32_t>& starts = starts_home_[s];
    starts.push_back(0);
    for (const std::uint32_t b : near_)
      starts.push_back(starts.back() + (set.size() == 0 ? 0 : set.block_start[b + 1] - set.block_start[b]));
    starts_[s].upload(starts);
    std::vector<Buffer<float>>& columns = memory.sets[s].distance;
    for (Buffer<float>& column : columns) column.resize(set.size());
    launch(*device_, Fill<float>{columns[3].data(), static_cast<std::int64_t>(set.size()), no_distance},
           blocks_for<Fill<float>>(set.size()));
  }
}

void ThinDistances::measure(const World<float>& world, Memory& memory, const Obstacles& obstacles,
                            const std::vector<StencilBlocks>& reached) {
  if (measured_ || near_.empty()) return;
  measured_ = true;
  for (std::size_t s = 0; s < world.sets.size(); ++s) {
    const std::vector<std::uint32_t>& starts = starts_home_[s];
    if (starts.back() == 0) continue;
    SetMemory& set = memory.sets[s];
    places_.resize(starts.back()), places_home_.resize(starts.back()), distances_home_.resize(starts.back());
    const NearParticles near{blocks_.data(), set.block_start.data(), starts_[s].data()};
    const auto columns = [](std::vector<Buffer<float>>& all, auto& to) {
      for (std::size_t c = 0; c < all.size(); ++c) to[c] = all[c].data();
    };
    CopyPlaces copy{near, {}, places_.data()};
    columns(set.now.u, copy.u);
    launch(*device_, copy, near_.size());
    places_.download(places_home_);
    parallel_for(near_.size(), 1, [&](std::size_t i) {
      const ThinWalls thin(obstacles, reached[near_[i]]);
      for (std::uint32_t p = starts[i]; p < starts[i + 1]; ++p) distances_home_[p] = thin.or_none(places_home_[p]);
    });
    distances_.upload(distances_home_);
    SpreadDistances spread{near, distances_.data(), {}};
    columns(set.distance, spread.to);
    launch(*device_, spread, near_.size());
  }
}

}  // namespace dreampm::gpu

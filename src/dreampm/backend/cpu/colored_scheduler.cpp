#include "dreampm/backend/cpu/colored_scheduler.h"

#include <algorithm>
#include <array>
#include <numeric>

#include "dreampm/base/parallel.h"
#include "dreampm/state/resize_for_overwrite.h"

namespace dreampm {
namespace {

/// Colors follow absolute numbers, so that the order of sums does not depend on what else is in the
/// scene. Round a periodic axis of an odd number of blocks two colors do not go: its last block has
/// a third.
std::uint8_t color_of(const World<float>& world, const Vec3i& place) {
  int color = 0;
  for (int a = 0; a < 3; ++a) {
    const std::int32_t count = (world.high[a] - world.low[a]) / block_width;
    const bool last = place[a] - world.low[a] / block_width == count - 1;
    color = color * 3 + (world.periodic[static_cast<std::size_t>(a)] && last && count % 2 ? 2 : place[a] & 1);
  }
  return static_cast<std::uint8_t>(color);
}

constexpr std::size_t color_count = 27;
constexpr std::size_t many_tasks = 512;

}  // namespace

void ColoredScheduler::prepare(const World<float>& world, const std::vector<Vec3i>& places,
                               const std::vector<std::uint32_t>& work) {
  // A place may lie outside of the domain on a periodic axis that all tasks reach through.
  wrapped_.clear();
  for (const Vec3i& place : places) wrapped_.push_back(world.wrapped(place));
  places_.exchange(wrapped_);
  const std::size_t tasks = places.size();
  colors_.clear();
  for (const Vec3i& place : places_.all()) colors_.push_back(color_of(world, place));
  std::array<std::uint32_t, color_count + 1> next{};
  for (const std::uint8_t color : colors_) ++next[color + 1u];
  std::partial_sum(next.begin(), next.end(), next.begin());
  by_color_.resize(tasks);
  for (std::size_t task = 0; task < tasks; ++task) by_color_[next[colors_[task]]++] = static_cast<std::uint32_t>(task);
  order_.resize(tasks);
  std::iota(order_.begin(), order_.end(), 0u);
  // Few: of one color the longest first, so that threads end together. Many: in the order of space,
  // each after what it waits for, so that nodes are still near when the next task needs them.
  if (tasks < many_tasks)
    std::sort(order_.begin(), order_.end(), [&](std::uint32_t a, std::uint32_t b) {
      return colors_[a] != colors_[b] ? colors_[a] < colors_[b] : work[a] != work[b] ? work[a] > work[b] : a < b;
    });
  resize_for_overwrite(around_, tasks);
  parallel_for(tasks, 32, [&](std::size_t task) { around_[task] = neighbors_in(places_, world, places_[task]); });
  first_wait_.clear();
  waits_for_.clear();
  for (std::size_t task = 0; task < tasks; ++task) {
    first_wait_.push_back(static_cast<std::uint32_t>(waits_for_.size()));
    for (const std::int32_t other : around_[task])
      if (other != BlockList::none && colors_[static_cast<std::size_t>(other)] < colors_[task])
        waits_for_.push_back(static_cast<std::uint32_t>(other));
  }
  first_wait_.push_back(static_cast<std::uint32_t>(waits_for_.size()));
  work_before_.assign(1, 0);
  for (const std::uint32_t w : work) work_before_.push_back(work_before_.back() + w);
}

void ColoredScheduler::begin() { states_.assign(order_.size(), waiting); }

std::uint32_t ColoredScheduler::task_at(double share) const {
  const auto wanted = static_cast<std::uint64_t>(share * static_cast<double>(work_before_.back()));
  return static_cast<std::uint32_t>(std::lower_bound(work_before_.begin(), work_before_.end(), wanted) -
                                    work_before_.begin());
}

}  // namespace dreampm

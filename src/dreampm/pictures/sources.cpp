#include "dreampm/pictures/sources.h"

#include <algorithm>

namespace dreampm {

template <class R>
Sources::Sources(const World<R>& world, const std::vector<BodyRange>& bodies) {
  for (const Emitter& e : world.emitters) names_.push_back(e.name), colors_.push_back(e.color);
  for (const Arrival& a : world.arrivals)
    ranges_.push_back({a.first_id, std::uint64_t{a.first_id} + a.count, {static_cast<int>(a.emitter), a.time}});
  for (const BodyRange& b : bodies) {
    ranges_.push_back({b.first_id, std::uint64_t{b.first_id} + b.count, {static_cast<int>(names_.size()), b.time}});
    names_.push_back(b.name), colors_.push_back(b.color);
  }
  std::sort(ranges_.begin(), ranges_.end(), [](const Range& a, const Range& b) { return a.first < b.first; });
}

Sources::Source Sources::of(std::uint32_t particle) const {
  const auto range = std::upper_bound(ranges_.begin(), ranges_.end(), std::uint64_t{particle},
                                      [](std::uint64_t id, const Range& r) { return id < r.end; });
  return range != ranges_.end() && particle >= range->first ? range->source : Source{};
}

template Sources::Sources(const World<float>&, const std::vector<BodyRange>&);
template Sources::Sources(const World<double>&, const std::vector<BodyRange>&);

}  // namespace dreampm

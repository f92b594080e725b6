#include "dreampm/surface/resting_drops.h"

#include <algorithm>
#include <cmath>

#include "dreampm/base/parallel.h"
#include "dreampm/surface/cells.h"

namespace dreampm::surface {
namespace {

constexpr int few = 8;
constexpr float apart_spacings = 2.5f;
constexpr double slow = 24;  // spacings a second

/// Returns for each point 1 if it is with few others.
std::vector<std::uint8_t> with_few(const std::vector<Vec3f>& points, float reach) {
  const CellGrid cells(points, reach);
  std::vector<std::uint8_t> is(points.size());
  const Vec3f box{reach, reach, reach};
  parallel_for(points.size(), 4096, [&](std::size_t i) {
    int others = -1;  // less the point itself
    for_cells(cells, points[i] - box, points[i] + box, [&](std::size_t c) {
      for (std::uint32_t k = cells.first[c]; k < cells.first[c + 1] && others < few; ++k)
        others += length2(points[cells.order[k]] - points[i]) < reach * reach;
    });
    is[i] = others < few;
  });
  return is;
}

}  // namespace

const RestingDrops::Lonely& RestingDrops::lonely(int number) {
  if (const auto found = known_.find(number); found != known_.end()) return found->second;
  const LiquidFrame frame = frame_(number);
  Lonely& out = known_[number];
  out.time = frame.time, out.all = frame.ids.size();
  if (frame.ids.empty()) return out;
  const std::vector<std::uint8_t> is = with_few(frame.positions, apart_spacings * spacing_);
  for (std::size_t i = 0; i < is.size(); ++i) {
    if (is[i] == 0) continue;
    out.place.push_back(static_cast<std::uint32_t>(i));
    out.ids.push_back(frame.ids[i]), out.positions.push_back(frame.positions[i]);
  }
  return out;
}

std::vector<float> RestingDrops::remaining(int number) {
  const Lonely& now = lonely(number);
  std::vector<float> left(now.all, 1);
  struct Resting {
    std::size_t of;  ///< in `now`
    Vec3f position;  ///< in the frame after
  };
  std::vector<Resting> resting;
  for (std::size_t i = 0; i < now.ids.size(); ++i) resting.push_back({i, now.positions[i]});
  double after = now.time;
  for (int f = number - 1; f >= first_ && !resting.empty() && now.time - after < life_; --f) {
    const Lonely& before = lonely(f);
    const auto most = static_cast<float>(slow * (after - before.time)) * spacing_;
    std::vector<Resting> still;
    for (const Resting& r : resting) {
      const auto id = std::lower_bound(before.ids.begin(), before.ids.end(), now.ids[r.of]);
      if (id == before.ids.end() || *id != now.ids[r.of]) continue;
      const Vec3f& x = before.positions[static_cast<std::size_t>(id - before.ids.begin())];
      if (length2(x - r.position) > most * most) continue;
      left[now.place[r.of]] = static_cast<float>(std::pow(std::max(0.0, 1 - (now.time - before.time) / life_), 1.5));
      still.push_back({r.of, x});
    }
    resting.swap(still);
    after = before.time;
  }
  std::erase_if(known_, [&](const auto& k) { return k.second.time < now.time - 2 * life_; });
  return left;
}

}  // namespace dreampm::surface

#include "dreampm/foam/foam.h"

#include <algorithm>
#include <numeric>

#include "dreampm/base/error.h"
#include "dreampm/foam/birth.h"

namespace dreampm {
namespace {
using namespace foam;

/// For each particle of `to` its place in `from`, or -1.
std::vector<std::int32_t> matched(const FoamMatter& from, const FoamMatter& to) {
  std::vector<std::int32_t> earlier(to.id.size(), -1);
  const auto number = [](std::span<const std::int32_t> ids) {
    std::vector<std::uint32_t> order(ids.size());
    std::iota(order.begin(), order.end(), 0u);
    if (!std::is_sorted(ids.begin(), ids.end()))
      std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return ids[a] < ids[b]; });
    return order;
  };
  const std::vector<std::uint32_t> a = number(from.id), b = number(to.id);
  std::size_t i = 0;
  for (const std::uint32_t t : b) {
    while (i < a.size() && from.id[a[i]] < to.id[t]) ++i;
    if (i < a.size() && from.id[a[i]] == to.id[t]) earlier[t] = static_cast<std::int32_t>(a[i]);
  }
  return earlier;
}

/// The way of each particle of `from` to the next frame.
WayField ways(const FoamMatter& from, const FoamMatter& to, std::span<const std::int32_t> earlier,
              const FoamRules& rules) {
  std::vector<Vec3f> way(from.position.size());
  std::vector<std::uint8_t> known(from.position.size(), 0);
  for (std::size_t t = 0; t < earlier.size(); ++t) {
    if (earlier[t] < 0) continue;
    const auto e = static_cast<std::size_t>(earlier[t]);
    way[e] = rules.room.way(from.position[e], to.position[t]), known[e] = 1;
  }
  return WayField(from, way, known, rules);
}

void add(FoamParticles& to, const One& one, std::int32_t id, const FoamRules& rules) {
  to.position.push_back(one.position), to.velocity.push_back(one.velocity), to.type.push_back(one.type);
  to.age.push_back(one.age), to.life.push_back(one.life), to.radius.push_back(drawn_radius(one, rules));
  to.id.push_back(id);
}

}  // namespace

FoamStep advance_foam(const FoamParticles& before, const FoamMatter& from, const FoamMatter& to,
                      std::span<const Obstacle> obstacles, float dt, int frame, const FoamRules& rules) {
  const std::vector<std::int32_t> earlier = matched(from, to);
  const MotionField was(from, obstacles, rules), now(to, obstacles, rules);
  const WayField way = ways(from, to, earlier, rules);
  const Between between{rules, was, now, way, obstacles, dt};
  std::vector<One> moved(before.size());
  std::vector<End> ends(before.size());
  parallel_for(before.size(), 64, [&](std::size_t i) {
    moved[i] = {before.position[i], before.velocity[i], before.type[i],
                before.age[i],      before.life[i],     full_radius(before.id[i], rules)};
    ends[i] = move(moved[i], dt, between);
  });
  FoamStep out;
  FoamParticles& all = out.particles;
  for (std::size_t i = 0; i < moved.size(); ++i) {
    if (ends[i] == End::aged) ++out.counts.aged;
    if (ends[i] == End::wall) ++out.counts.at_walls;
    if (ends[i] == End::outside) ++out.counts.outside;
    if (moved[i].life > 0) add(all, moved[i], before.id[i], rules);
  }
  const FoamCounts ended = out.counts;
  Born born = births(from, to, earlier, between, frame, before.next_id, rules.most - std::min(rules.most, all.size()));
  out.counts = born.counts;
  out.counts.aged = ended.aged, out.counts.at_walls = ended.at_walls, out.counts.outside = ended.outside;
  if (born.all.size() > 0x7fffffffu - before.next_id)
    fail_run("foam: more than {} particles have been born, which files cannot number", 0x7fffffff);
  all.next_id = before.next_id;
  for (const One& one : born.all) add(all, one, static_cast<std::int32_t>(all.next_id++), rules);
  return out;
}

}  // namespace dreampm

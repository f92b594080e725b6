#include "dreampm/contact/collider_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

namespace dreampm {
namespace {

constexpr double endless = std::numeric_limits<double>::infinity();
/// Cells from a place inside within which its nearest surface is looked for.
constexpr double depth_reach = 3;
/// Cells between a block's middle and what a look from its nodes can meet.
constexpr double view_reach = 2.6 + 2 + block_width + depth_reach;

/// A distance changes by no more than the way, of meshes by a little more.
constexpr double steepest = 1.25;

/// The 26 ways to the neighbors of a cell.
std::array<Vec3d, 26> ways() {
  std::array<Vec3d, 26> all;
  std::size_t n = 0;
  for (int i = -1; i <= 1; ++i)
    for (int j = -1; j <= 1; ++j)
      for (int k = -1; k <= 1; ++k)
        if (i != 0 || j != 0 || k != 0)
          all[n++] = normalized(Vec3d{static_cast<double>(i), static_cast<double>(j), static_cast<double>(k)});
  return all;
}

/// The point as the nearest copy of the collider sees it.
Vec3d seen_from(const PlacedCollider& c, const Vec3d& p) {
  if (c.shifts.size() == 1) return p - c.shifts.front();
  Vec3d best = p - c.shifts.front();
  for (const Vec3d& s : c.shifts)
    if (c.distance(p - s) < c.distance(best)) best = p - s;
  return best;
}

}  // namespace

template <class R>
std::vector<Vec3d> periodic_copies(const World<R>& world, const Collider& collider) {
  std::vector<Vec3d> shifts{{}};
  const Box3d bounds = collider.bounds();
  for (int a = 0; a < 3; ++a) {
    if (!world.periodic[static_cast<std::size_t>(a)] || !is_finite(bounds.min) || !is_finite(bounds.max)) continue;
    const double length = (world.high[a] - world.low[a]) * world.dx;
    // Colliders that move may have gone round a periodic axis.
    if (collider.moves())
      for (Vec3d& s : shifts) s[a] = -length * std::floor((bounds.center()[a] - world.domain().min[a]) / length);
    for (std::size_t i = 0, n = shifts.size(); i < n; ++i)
      for (const double side : {-length, length}) {
        Vec3d s = shifts[i];
        s[a] += side;
        shifts.push_back(s);
      }
  }
  return shifts;
}

template <class R>
void ColliderView::set_walls(const World<R>& world, const Vec3i& block) {
  const Vec3d low = world.node_position(world.low), high = world.node_position(world.high);
  for (int a = 0; a < 3; ++a) {
    const auto closed = [&](int side) {
      return !world.periodic[static_cast<std::size_t>(a)] &&
             world.walls[static_cast<std::size_t>(side)].type != WallType::open;
    };
    low_[a] = closed(2 * a) ? low[a] : -endless;
    high_[a] = closed(2 * a + 1) ? high[a] : endless;
    const bool ends = !world.periodic[static_cast<std::size_t>(a)];
    domain_low_[a] = ends ? world.low[a] - block[a] * block_width : -endless;
    domain_high_[a] = ends ? world.high[a] - block[a] * block_width : endless;
  }
}

template <class R>
ColliderView::ColliderView(const World<R>& world, const Vec3i& block, const std::vector<PlacedCollider>& colliders,
                           See see)
    : first_(world.node_position(block * block_width)), dx_(world.dx), colliders_(&colliders), see_(see) {
  set_walls(world, block);
  for (std::size_t c = 0; c < colliders.size(); ++c) {
    if (!sees(colliders[c].collider)) continue;
    const auto number = static_cast<std::uint16_t>(c);
    const double d = distance(number, middle);
    if (!(d <= view_reach)) continue;
    if (!near_.empty() && d < middle_distances_[middle_first_]) middle_first_ = near_.size();
    near_.push_back(number), middle_distances_.push_back(d);
    if (!colliders[c].collider.holds) near_closed_.push_back(number);
  }
}

template <class R>
ColliderView::ColliderView(const World<R>& world, const Vec3i& block, const std::vector<PlacedCollider>& colliders,
                           SinglesOnly)
    : first_(world.node_position(block * block_width)), dx_(world.dx), colliders_(&colliders), see_(See::all) {
  set_walls(world, block);
}

ColliderView::ColliderView(const std::vector<PlacedCollider>& colliders, const Vec3d& first, double dx)
    : first_(first), dx_(dx), colliders_(&colliders), see_(See::all) {
  for (int a = 0; a < 3; ++a) low_[a] = domain_low_[a] = -endless, high_[a] = domain_high_[a] = endless;
  near_.resize(colliders.size());
  std::iota(near_.begin(), near_.end(), std::uint16_t{0});
  near_closed_ = near_;
}

bool ColliderView::within_domain(const Vec3d& at) const {
  for (int a = 0; a < 3; ++a)
    if (at[a] < domain_low_[a] + 1e-6 || at[a] > domain_high_[a] - 1e-6) return false;
  return true;
}

std::vector<std::uint16_t> ColliderView::within(double reach) const {
  std::vector<std::uint16_t> all;
  if (!middle_distances_.empty() && reach <= view_reach) {
    for (std::size_t i = 0; i < near_.size(); ++i)
      if (middle_distances_[i] <= reach) all.push_back(near_[i]);
    return all;
  }
  for (std::size_t c = 0; c < colliders_->size(); ++c)
    if (sees((*colliders_)[c].collider) && is_within(static_cast<std::uint16_t>(c), reach))
      all.push_back(static_cast<std::uint16_t>(c));
  return all;
}

Vec3d ColliderView::before_walls(const Vec3d& at, bool (&turned)[3]) const {
  Vec3d p = first_ + at * dx_;
  turned[0] = turned[1] = turned[2] = false;
  if (p.x >= low_[0] && p.x <= high_[0] && p.y >= low_[1] && p.y <= high_[1] && p.z >= low_[2] && p.z <= high_[2])
    return p;
  for (int a = 0; a < 3; ++a) {
    // In a narrow box an image lies behind the other wall, and is mirrored again.
    while (p[a] < low_[a] || p[a] > high_[a]) {
      p[a] = 2 * (p[a] < low_[a] ? low_[a] : high_[a]) - p[a];
      turned[a] = !turned[a];
    }
  }
  return p;
}

PointColumns ColliderView::before_walls(std::span<const Vec3d> at, Meters& meters) const {
  const auto along = [&](int a, double Vec3d::* part) {
    double* const p = meters[static_cast<std::size_t>(a)].data();
    const double first = first_.*part, low = low_[a], high = high_[a];
    bool outside = false;
    for (std::size_t i = 0; i < at.size(); ++i) {
      p[i] = first + at[i].*part * dx_;
      outside |= (p[i] < low) | (p[i] > high);
    }
    for (std::size_t i = 0; outside && i < at.size(); ++i)
      while (p[i] < low || p[i] > high) p[i] = 2 * (p[i] < low ? low : high) - p[i];
  };
  along(0, &Vec3d::x), along(1, &Vec3d::y), along(2, &Vec3d::z);
  return {{meters[0].data(), meters[1].data(), meters[2].data()}, at.size()};
}

double ColliderView::distance_at(std::uint16_t collider, const Vec3d& meters) const {
  const PlacedCollider& c = (*colliders_)[collider];
  return c.distance(seen_from(c, meters)) / dx_;
}

void ColliderView::distances_at(std::uint16_t collider, const PointColumns& meters, double* to) const {
  const PlacedCollider& c = (*colliders_)[collider];
  if (c.shifts.size() > 1) {
    for (std::size_t i = 0; i < meters.count; ++i)
      to[i] = distance_at(collider, {meters.at[0][i], meters.at[1][i], meters.at[2][i]});
    return;
  }
  Meters own;
  const Vec3d shift = c.shifts.front();
  const Pose& pose = c.collider.surface_pose;
  const auto place = [&](const auto& in_frame) {
    for (std::size_t i = 0; i < meters.count; ++i) {
      const Vec3d p = in_frame(Vec3d{meters.at[0][i], meters.at[1][i], meters.at[2][i]} - shift);
      own[0][i] = p.x, own[1][i] = p.y, own[2][i] = p.z;
    }
  };
  // A stored transform: PlacedCollider::in_frame asks anew for each point.
  if (!c.moves)
    place([](const Vec3d& p) { return p; });
  else if (!c.turned)
    place([&](const Vec3d& p) { return p - pose.position; });
  else
    place([&](const Vec3d& p) { return pose.inverse(p); });
  c.collider.shape->distances({{own[0].data(), own[1].data(), own[2].data()}, meters.count}, to);
  for (std::size_t i = 0; i < meters.count; ++i) to[i] /= dx_;
}

void ColliderView::distances(std::uint16_t collider, std::span<const Vec3d> at, double* to) const {
  Meters meters;
  for (; !at.empty(); at = at.subspan(std::min(places_at_once, at.size()))) {
    const std::span<const Vec3d> some = at.first(std::min(places_at_once, at.size()));
    distances_at(collider, before_walls(some, meters), to);
    to += some.size();
  }
}

double ColliderView::distance(std::uint16_t collider, const Vec3d& at) const {
  bool turned[3];
  return distance_at(collider, before_walls(at, turned));
}

Vec3d ColliderView::in_frame(std::uint16_t collider, const Vec3d& at) const {
  bool turned[3];
  const PlacedCollider& c = (*colliders_)[collider];
  return c.collider.surface_pose.inverse(seen_from(c, before_walls(at, turned)));
}

double ColliderView::before_wall(const Vec3d& at) const {
  const Vec3d p = first_ + at * dx_;
  double d = endless;
  for (int a = 0; a < 3; ++a) d = std::min({d, p[a] - low_[a], high_[a] - p[a]});
  return d / dx_;
}

Vec3d ColliderView::normal(std::uint16_t collider, const Vec3d& at) const {
  bool turned[3];
  const Vec3d p = before_walls(at, turned);
  const PlacedCollider& c = (*colliders_)[collider];
  Vec3d n = c.collider.normal(seen_from(c, p));
  for (int a = 0; a < 3; ++a)
    if (turned[a]) n[a] = -n[a];
  return n;
}

Vec3d ColliderView::velocity(std::uint16_t collider, const Vec3d& at) const {
  const PlacedCollider& c = (*colliders_)[collider];
  if (c.collider.stands()) return {};
  bool turned[3];
  Vec3d v = c.collider.velocity(seen_from(c, before_walls(at, turned)));
  for (int a = 0; a < 3; ++a)
    if (turned[a]) v[a] = -v[a];
  return v;
}

Vec3d ColliderView::arm(std::uint16_t collider, const Vec3d& at) const {
  const PlacedCollider& c = (*colliders_)[collider];
  bool turned[3];
  return seen_from(c, before_walls(at, turned)) - c.collider.twist.center;
}

double ColliderView::nearest(const Vec3d& at) const {
  bool turned[3];
  const Vec3d p = before_walls(at, turned);
  if (near_.size() == 1) return distance_at(near_.front(), p);
  double d = std::numeric_limits<double>::infinity();
  if (middle_distances_.empty()) {
    for (const std::uint16_t c : near_) d = std::min(d, distance_at(c, p));
    return d;
  }
  // Most are too far away to be the nearest.
  const double way = steepest * length(at - middle);
  if (!near_.empty()) d = distance_at(near_[middle_first_], p);
  for (std::size_t i = 0; i < near_.size(); ++i)
    if (i != middle_first_ && middle_distances_[i] - way <= d) d = std::min(d, distance_at(near_[i], p));
  return d;
}

void ColliderView::nearest(std::span<const Vec3d> at, double* to) const {
  Meters meters;
  std::array<double, places_at_once> own;
  for (std::size_t begin = 0; begin < at.size(); begin += places_at_once, to += places_at_once) {
    const std::span<const Vec3d> places = at.subspan(begin, std::min(places_at_once, at.size() - begin));
    const PointColumns columns = before_walls(places, meters);
    double way = 0;
    for (std::size_t i = 0; near_.size() > 1 && i < places.size(); ++i)
      way = std::max(way, length2(places[i] - middle));
    way = steepest * std::sqrt(way);
    std::fill_n(to, places.size(), std::numeric_limits<double>::infinity());
    const auto add = [&](std::uint16_t collider) {
      distances_at(collider, columns, own.data());
      for (std::size_t i = 0; i < places.size(); ++i) to[i] = std::min(to[i], own[i]);
    };
    if (middle_distances_.empty()) {
      for (const std::uint16_t c : near_) add(c);
      continue;
    }
    if (!near_.empty()) add(near_[middle_first_]);
    for (std::size_t i = 0; i < near_.size(); ++i)
      if (i != middle_first_ && middle_distances_[i] - way <= *std::max_element(to, to + places.size())) add(near_[i]);
  }
}

double ColliderView::filled(const Vec3d& at, double width) const {
  const double d = nearest(at), part = std::clamp(0.5 - d / width, 0.0, 1.0);
  if (part <= 0 || part >= 1) return part;
  // At a seam between colliders distances are 0 as well.
  const Vec3d n = normal(nearest_collider(at), at);
  return is_exposed(at - n * d, n) ? part : 1;
}

std::uint16_t ColliderView::nearest_of(const std::vector<std::uint16_t>& some, const Vec3d& at) const {
  if (some.size() == 1) return some.front();
  bool turned[3];
  const Vec3d p = before_walls(at, turned);
  std::uint16_t found = some.front();
  double d = distance_at(found, p);
  for (std::size_t i = 1; i < some.size(); ++i)
    if (const double next = distance_at(some[i], p); next < d) d = next, found = some[i];
  return found;
}

ColliderDistance ColliderView::nearest_exposed(const Vec3d& at, double reach) const {
  if (near_closed_.empty()) return {reach, {}};
  const double d = nearest(at);
  if (!(d <= reach)) return {reach, {}};
  const std::uint16_t collider = nearest_of(near_closed_, at);
  const ColliderDistance found = near_.size() == 1 ? exposed(collider, at, d) : exposed(collider, at);
  return {found.distance, found.distance > slit ? normal(collider, at) : found.normal};
}

ColliderDistance ColliderView::exposed(std::uint16_t collider, const Vec3d& at, double d) const {
  if (d > slit) return {d, {}};
  const Vec3d n = normal(collider, at);
  if (d < -depth_reach) return {d, n};
  // Midway between two faces the normal is that of neither.
  const Vec3d face = at - n * d;
  return std::abs(distance(collider, face)) < slit && is_exposed(face, n) ? ColliderDistance{d, n} : depth(at, n);
}

ColliderDistance ColliderView::depth(const Vec3d& at, const Vec3d& hidden) const {
  static const std::array<Vec3d, 26> all_ways = ways();
  constexpr std::size_t count = std::tuple_size_v<decltype(all_ways)>;
  constexpr double step = 0.25;
  // Slits between colliders are closed: all surfaces are moved outward by half of one's width.
  // Where each way is out of them at first: all ways are looked along at once.
  std::array<double, count> outside, from_outside;
  outside.fill(step);
  std::array<std::size_t, count> going;
  std::iota(going.begin(), going.end(), std::size_t{0});
  for (std::size_t left = count; left > 0;) {
    std::array<Vec3d, count> places;
    std::array<double, count> distances;
    for (std::size_t i = 0; i < left; ++i) places[i] = at + all_ways[going[i]] * outside[going[i]];
    nearest({places.data(), left}, distances.data());
    std::size_t go_on = 0;
    for (std::size_t i = 0; i < left; ++i) {
      from_outside[going[i]] = distances[i];
      if (distances[i] > slit) continue;
      // The surface is no nearer than it says.
      double& t = outside[going[i]];
      t += step * std::max(1.0, std::floor(-distances[i] / step));
      if (t <= depth_reach) going[go_on++] = going[i];
    }
    left = go_on;
  }
  double found = depth_reach;
  Vec3d exit = at;
  for (std::size_t k = 0; k < count; ++k) {
    if (outside[k] > found) continue;
    const Vec3d in = at + all_ways[k] * (outside[k] - step), out = at + all_ways[k] * outside[k];
    const Vec3d there = crossing(in, out, nearest(in) - slit, from_outside[k] - slit, slit);
    if (const double way = dot(there - at, all_ways[k]); way < found) found = way, exit = there;
  }
  if (found >= depth_reach) return {-depth_reach, hidden};
  // The normal of the plane at the exit, as a path rarely leaves along the normal. Differences over
  // more than a slit do not see the plane.
  Vec3d n;
  for (int a = 0; a < 3; ++a) {
    Vec3d h;
    h[a] = 2 * slit;
    n[a] = nearest(exit + h) - nearest(exit - h);
  }
  n = normalized(n);
  return {std::min(0.0, slit - dot(exit - at, n)), n};
}

Vec3d ColliderView::crossing(const Vec3d& from, const Vec3d& to, double begin, double end, double out) const {
  double low = 0, high = 1;
  Vec3d at = from;
  // Halving in turn with the secant: distances have kinks.
  for (int k = 0; k < 40; ++k) {
    const double part =
        k % 2 == 0 ? low + (high - low) * std::clamp(begin / (begin - end), 0.0, 1.0) : 0.5 * (low + high);
    at = from + (to - from) * part;
    const double d = nearest(at) - out;
    if (std::abs(d) < 1e-6) break;
    (inside(d) == inside(begin) ? low : high) = part;
    (inside(d) == inside(begin) ? begin : end) = d;
  }
  return at;
}

#define DM_INSTANTIATE(R)                                                                                      \
  template std::vector<Vec3d> periodic_copies(const World<R>&, const Collider&);                               \
  template ColliderView::ColliderView(const World<R>&, const Vec3i&, const std::vector<PlacedCollider>&, See); \
  template ColliderView::ColliderView(const World<R>&, const Vec3i&, const std::vector<PlacedCollider>&, SinglesOnly);
DM_INSTANTIATE(float)
DM_INSTANTIATE(double)
#undef DM_INSTANTIATE

}  // namespace dreampm

#include "dreampm/foam/lattice_field.h"

namespace dreampm::foam {

Vec3f Room::wrapped(Vec3f p) const {
  for (int a = 0; a < 3; ++a)
    if (periodic[static_cast<std::size_t>(a)]) {
      const float length = box.max[a] - box.min[a];
      p[a] -= length * std::floor((p[a] - box.min[a]) / length);
    }
  return p;
}

Vec3f Room::way(const Vec3f& a, const Vec3f& b) const {
  Vec3f d = b - a;
  for (int k = 0; k < 3; ++k)
    if (periodic[static_cast<std::size_t>(k)]) {
      const float length = box.max[k] - box.min[k];
      d[k] -= length * std::round(d[k] / length);
    }
  return d;
}

NodeAxis NodeAxis::over(const Room& room, int axis, float width) {
  const auto a = static_cast<std::size_t>(axis);
  const float from = room.box.min[axis], length = room.box.max[axis] - from;
  NodeAxis made;
  made.periodic = room.periodic[a];
  made.low = room.wall(axis, false), made.high = room.wall(axis, true);
  if (made.periodic) {  // by whole bricks
    made.cells = 4 * std::max(1, static_cast<int>(std::lround(length / (4 * width))));
    width = length / static_cast<float>(made.cells);
  } else if (made.low && made.high) {
    made.cells = std::max(1, static_cast<int>(std::lround(length / width)));
    width = length / static_cast<float>(made.cells);
  } else {
    made.cells = std::max(1, static_cast<int>(std::ceil(length / width)));
  }
  made.per_cell = 1 / width;
  made.origin = made.high && !made.low ? room.box.max[axis] - static_cast<float>(made.cells) * width : from;
  return made;
}

NodeAxes node_axes(const Room& room, float width) {
  return {NodeAxis::over(room, 0, width), NodeAxis::over(room, 1, width), NodeAxis::over(room, 2, width)};
}

BrickOrder::BrickOrder(std::span<const Vec3f> points, const NodeAxes& axes) {
  const std::size_t n = points.size();
  std::vector<std::uint64_t> key(n), keys;
  parallel_for(n, 8192, [&](std::size_t i) {
    const Vec3i c = cell_of(axes, points[i]);
    key[i] = surface::LatticeMap::key({c.x >> 2, c.y >> 2, c.z >> 2});
  });
  std::vector<std::int32_t> brick(n);
  surface::LatticeMap seen(n / 128);
  for (std::size_t i = 0; i < n; ++i) {
    brick[i] = seen.insert(surface::LatticeMap::place(key[i]), static_cast<std::int32_t>(keys.size()));
    if (static_cast<std::size_t>(brick[i]) == keys.size()) keys.push_back(key[i]);
  }
  std::vector<std::uint32_t> by_place(keys.size()), rank(keys.size());
  std::iota(by_place.begin(), by_place.end(), 0u);
  std::sort(by_place.begin(), by_place.end(), [&](std::uint32_t a, std::uint32_t b) { return keys[a] < keys[b]; });
  for (std::size_t r = 0; r < keys.size(); ++r) {
    rank[by_place[r]] = static_cast<std::uint32_t>(r);
    bricks.push_back(surface::LatticeMap::place(keys[by_place[r]]));
  }
  first.assign(keys.size() + 1, 0);
  for (std::size_t i = 0; i < n; ++i) ++first[rank[static_cast<std::size_t>(brick[i])] + 1];
  std::partial_sum(first.begin(), first.end(), first.begin());
  order.resize(n);
  std::vector<std::uint32_t> at(first.begin(), first.end() - 1);
  for (std::size_t i = 0; i < n; ++i)
    order[at[rank[static_cast<std::size_t>(brick[i])]]++] = static_cast<std::uint32_t>(i);
}

}  // namespace dreampm::foam

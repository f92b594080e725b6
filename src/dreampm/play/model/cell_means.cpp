#include "dreampm/play/model/cell_means.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <unordered_map>

#include "dreampm/math/vec_hash.h"

namespace dreampm::play {
namespace {

struct CellSum {
  double sum = 0, weight = 0;
};
using CellSums = std::unordered_map<Vec3i, CellSum, Vec3iHash>;

/// Calls body(node, weight) for the eight nodes around a place.
template <class Body>
void for_cell_nodes(const Vec3f& at, double cell, const Body& body) {
  std::array<std::int32_t, 3> low{};
  std::array<double, 3> part{};
  for (int a = 0; a < 3; ++a) {
    const double x = static_cast<double>(at[a]) / cell;
    low[std::size_t(a)] = static_cast<std::int32_t>(std::floor(x));
    part[std::size_t(a)] = x - std::floor(x);
  }
  for (int n = 0; n < 8; ++n) {
    double weight = 1;
    Vec3i node;
    for (int a = 0; a < 3; ++a) {
      const int up = n >> a & 1;
      weight *= up ? part[std::size_t(a)] : 1 - part[std::size_t(a)];
      node[a] = low[std::size_t(a)] + up;
    }
    body(node, weight);
  }
}

}  // namespace

void average_over_cells(std::span<const Vec3f> position, double cell, std::vector<float>& value) {
  CellSums grid;
  for (std::size_t i = 0; i < position.size(); ++i)
    for_cell_nodes(position[i], cell, [&](const Vec3i& node, double weight) {
      CellSum& n = grid[node];
      n.sum += weight * static_cast<double>(value[i]), n.weight += weight;
    });
  for (std::size_t i = 0; i < position.size(); ++i) {
    double mean = 0;
    for_cell_nodes(position[i], cell, [&](const Vec3i& node, double weight) {
      if (const CellSum& n = grid[node]; n.weight > 0) mean += weight * n.sum / n.weight;
    });
    value[i] = static_cast<float>(mean);
  }
}

}  // namespace dreampm::play

#include "dreampm/level_set/vdb_distance.h"

#include <openvdb/tools/MeshToVolume.h>
#include <openvdb/tools/VolumeToMesh.h>

#include <limits>
#include <mutex>

#include "dreampm/import/vdb_grids.h"
#include "dreampm/import/vdb_mesh.h"

namespace dreampm {
namespace {

using openvdb::Coord;
using openvdb::FloatGrid;

void initialize() {
  static std::once_flag once;
  std::call_once(once, [] { openvdb::initialize(); });
}

/// Copies leaves, clamped to +-band, into a grid over `low`..`high` [bricks].
BrickGrid to_bricks(const FloatGrid& grid, const Vec3i& low, const Vec3i& high, float band) {
  BrickGrid bricks(low, high, band);
  for (auto leaf = grid.tree().cbeginLeaf(); leaf; ++leaf) {
    const Coord& o = leaf->origin();
    const Vec3i brick{o.x() >> 3, o.y() >> 3, o.z() >> 3};
    if (!bricks.covers(brick)) continue;
    auto& values = bricks.open(bricks.slot_index(brick), band);
    const float* from = leaf->buffer().data();
    for (std::size_t i = 0; i < BrickGrid::volume; ++i) values[i] = std::clamp(from[i], -band, band);
  }
  return bricks;
}

}  // namespace

BrickGrid unsigned_distance(const TriMesh& mesh, float band) {
  initialize();
  const auto unit = openvdb::math::Transform::createLinearTransform(1.0);
  const FloatGrid::Ptr grid = openvdb::tools::meshToUnsignedDistanceField<FloatGrid>(
      *unit, vdb_points(mesh), vdb_triangles(mesh), std::vector<openvdb::Vec4I>(), band);

  constexpr std::int32_t most = std::numeric_limits<std::int32_t>::max();
  Vec3i low{most, most, most}, high{-most, -most, -most};
  for (auto leaf = grid->tree().cbeginLeaf(); leaf; ++leaf) {
    const Coord& o = leaf->origin();
    const Vec3i brick{o.x() >> 3, o.y() >> 3, o.z() >> 3};
    low = min(low, brick), high = max(high, brick);
  }
  if (high.x < low.x) return {};
  return to_bricks(*grid, low - Vec3i{1, 1, 1}, high + Vec3i{1, 1, 1}, band);
}

BrickGrid closed_distance(const BrickGrid& field) {
  initialize();
  if (field.size() == 0) return {};
  const float band = field.band();
  const FloatGrid::Ptr grid = FloatGrid::create(band);
  grid->setGridClass(openvdb::GRID_LEVEL_SET);
  for (std::size_t i = 0; i < field.size(); ++i) {
    const std::int32_t slot = field.slot(i);
    if (slot == BrickGrid::outside) continue;
    const Vec3i b = field.brick(i);
    const Coord origin(b.x * 8, b.y * 8, b.z * 8);
    if (slot == BrickGrid::inside) {
      grid->tree().addTile(1, origin, -band, false);
      continue;
    }
    auto* leaf = grid->tree().touchLeaf(origin);
    const auto& values = field.values()[std::size_t(slot)];
    for (std::size_t v = 0; v < BrickGrid::volume; ++v) leaf->setValueOn(openvdb::Index(v), values[v]);
  }
  // An unsigned distance, since OpenVDB's own signs would fill closed hollows.
  std::vector<openvdb::Vec3s> points;
  std::vector<openvdb::Vec4I> quads;
  openvdb::tools::volumeToMesh(*grid, points, quads, 0.0);
  if (points.empty()) return BrickGrid(field.brick(0), field.brick(field.size() - 1), band);
  const auto unit = openvdb::math::Transform::createLinearTransform(1.0);
  const FloatGrid::Ptr distance =
      openvdb::tools::meshToUnsignedDistanceField<FloatGrid>(*unit, points, std::vector<openvdb::Vec3I>(), quads, band);
  return to_bricks(*distance, field.brick(0), field.brick(field.size() - 1), band);
}

}  // namespace dreampm

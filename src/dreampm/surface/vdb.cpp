#include "dreampm/surface/vdb.h"

#include "dreampm/import/vdb_file.h"
#include "dreampm/import/vdb_grids.h"
#include "dreampm/import/vdb_level_set.h"

namespace dreampm {

void write_fog_vdb(const std::filesystem::path& path, const SparseField& field, const Vec3d& shift) {
  constexpr int kW = SparseField::kWidth;
  openvdb::initialize();
  const openvdb::FloatGrid::Ptr grid = openvdb::FloatGrid::create(0.0f);
  grid->setName("density");
  grid->setGridClass(openvdb::GRID_FOG_VOLUME);
  grid->insertMeta("iso", openvdb::FloatMetadata(field.iso));
  grid->setTransform(vdb_transform(static_cast<double>(field.voxel), static_cast<Vec3d>(field.origin) + shift));
  static_assert(openvdb::FloatTree::LeafNodeType::DIM == kW);
  for (std::size_t l = 0; l < field.leaves.size(); ++l) {
    const Vec3i at = field.leaves[l];
    auto* leaf = grid->tree().touchLeaf(openvdb::Coord(kW * at.x, kW * at.y, kW * at.z));
    const auto values = field.leaf(l);
    for (int i = 0; i < SparseField::kPoints; ++i) {
      const float v = values[static_cast<std::size_t>(i)];
      if (v > 0) leaf->setValueOn(openvdb::Coord(i % kW, i / kW % kW, i / (kW * kW)), v);
    }
  }
  for (const Vec3i& at : field.inside)
    grid->tree().addTile(1, openvdb::Coord(kW * at.x, kW * at.y, kW * at.z), 1.0f, true);
  write_vdb_file(path, {grid});
}

void write_level_set_vdb(const std::filesystem::path& path, const TriMesh& mesh, float voxel, const Vec3d& shift) {
  openvdb::initialize();
  const openvdb::FloatGrid::Ptr grid = vdb_level_set(mesh, static_cast<double>(voxel), shift);
  grid->setName("surface");
  write_vdb_file(path, {grid});
}

}  // namespace dreampm

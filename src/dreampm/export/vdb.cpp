// OpenVDB: a level set of each mesh, collider and rigid body, and a grid of velocities, a file a
// frame. The only file of this module that includes OpenVDB.
#include <cmath>

#include "dreampm/export/formats.h"
#include "dreampm/import/vdb_file.h"
#include "dreampm/import/vdb_grids.h"
#include "dreampm/import/vdb_level_set.h"
#include "dreampm/io/numbered.h"

namespace dreampm::exchange {
namespace fs = std::filesystem;
namespace {

/// Momentum over mass of the particles about each node, trilinear, as a grid of the simulation has
/// it: nodes are two spacings apart.
openvdb::Vec3SGrid::Ptr velocity_grid(const ParticleFrame& frame, double spacing, const Vec3d& shift) {
  const double voxel = 2 * spacing;
  auto grid = openvdb::Vec3SGrid::create(openvdb::Vec3s(0.0f));
  const auto weights = openvdb::FloatGrid::create(0.0f);
  auto sum = grid->getAccessor();
  auto weight = weights->getAccessor();
  for (std::size_t i = 0; i < frame.size(); ++i) {
    const Vec3d x = static_cast<Vec3d>(frame.position[i]) / voxel;
    const Vec3d low{std::floor(x.x), std::floor(x.y), std::floor(x.z)}, part = x - low;
    const openvdb::Vec3s v(frame.velocity[i].x, frame.velocity[i].y, frame.velocity[i].z);
    for (int k = 0; k < 8; ++k) {
      const int a = k & 1, b = k >> 1 & 1, c = k >> 2;
      const auto w =
          static_cast<float>((a ? part.x : 1 - part.x) * (b ? part.y : 1 - part.y) * (c ? part.z : 1 - part.z));
      if (!(w > 0)) continue;
      const openvdb::Coord at(int(low.x) + a, int(low.y) + b, int(low.z) + c);
      sum.setValue(at, sum.getValue(at) + w * v);
      weight.setValue(at, weight.getValue(at) + w);
    }
  }
  for (auto value = grid->beginValueOn(); value; ++value) value.setValue(*value / weight.getValue(value.getCoord()));
  grid->setVectorType(openvdb::VEC_CONTRAVARIANT_RELATIVE);
  grid->setTransform(vdb_transform(voxel, shift));
  return grid;
}

/// The share of space that foam takes about each node, trilinear: a fog. Nodes are a spacing apart.
openvdb::FloatGrid::Ptr foam_fog(const ParticleFrame& foam, double spacing, const Vec3d& shift) {
  constexpr float ball = 4.18879f;  // 4/3 pi
  auto grid = openvdb::FloatGrid::create(0.0f);
  auto share = grid->getAccessor();
  const std::vector<float>& radius = foam.columns.at("radius");
  for (std::size_t i = 0; i < foam.size(); ++i) {
    const Vec3d x = static_cast<Vec3d>(foam.position[i]) / spacing;
    const Vec3d low{std::floor(x.x), std::floor(x.y), std::floor(x.z)}, part = x - low;
    const auto r = radius[i] / static_cast<float>(spacing);
    for (int k = 0; k < 8; ++k) {
      const int a = k & 1, b = k >> 1 & 1, c = k >> 2;
      const double w = (a ? part.x : 1 - part.x) * (b ? part.y : 1 - part.y) * (c ? part.z : 1 - part.z);
      const openvdb::Coord at(int(low.x) + a, int(low.y) + b, int(low.z) + c);
      share.setValue(at, share.getValue(at) + static_cast<float>(w) * ball * r * r * r);
    }
  }
  grid->setGridClass(openvdb::GRID_FOG_VOLUME);
  grid->setTransform(vdb_transform(spacing, shift));
  return grid;
}

void write_vdb_frame(const ClipInfo& clip, const ClipFrame& frame, const fs::path& folder) {
  openvdb::initialize();
  openvdb::GridPtrVec grids;
  for (std::size_t m = 0; m < frame.meshes.size(); ++m) {
    grids.push_back(vdb_level_set(frame.meshes[m], clip.spacing / 2, clip.shift));
    grids.back()->setName(clip.mesh_name(m));
  }
  for (std::size_t o = 0; o < clip.objects.size(); ++o) {
    const TriMesh mesh = placed(clip.objects[o], frame.objects[o]);
    if (mesh.triangles.empty()) continue;
    grids.push_back(vdb_level_set(mesh, clip.spacing / 2, clip.shift));
    grids.back()->setName(clip.object_name(o));
  }
  if (clip.particles) {
    grids.push_back(velocity_grid(frame.particles, clip.spacing, clip.shift));
    grids.back()->setName("velocity");
  }
  if (clip.foam) {
    grids.push_back(foam_fog(frame.foam, clip.spacing, clip.shift));
    grids.back()->setName("foam");
  }
  openvdb::MetaMap about;
  about.insertMeta("frame", openvdb::Int32Metadata(frame.number));
  about.insertMeta("time", openvdb::DoubleMetadata(clip.time(frame.number)));
  about.insertMeta("fps", openvdb::DoubleMetadata(clip.fps));
  about.insertMeta("units", openvdb::StringMetadata(clip.units()));
  write_vdb_file(folder / numbered(clip.name, frame.number, ".vdb"), {grids.begin(), grids.end()}, about);
}

}  // namespace

Format vdb_format() {
  return {"vdb", "a level set and velocities, a file a frame", ".vdb", false, nullptr, each_frame<write_vdb_frame>};
}

}  // namespace dreampm::exchange

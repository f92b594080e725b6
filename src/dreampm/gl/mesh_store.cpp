#include "dreampm/gl/mesh_store.h"

#include "dreampm/base/error.h"

namespace dreampm::gl {

namespace {

Mat4f matrix_of(const Pose& pose) {
  const Vec3f x(pose.rotation({1, 0, 0})), y(pose.rotation({0, 1, 0})), z(pose.rotation({0, 0, 1})), p(pose.position);
  return {x.x, x.y, x.z, 0, y.x, y.y, y.z, 0, z.x, z.y, z.z, 0, p.x, p.y, p.z, 1};
}

void check(const MeshBatch& m, std::size_t index) {
  if (!m.normals.empty() && m.normals.size() != m.vertices.size())
    fail_input("picture: mesh {} has {} vertices but {} normals: give one each, or none", index, m.vertices.size(),
               m.normals.size());
  for (const auto& t : m.triangles)
    for (const std::uint32_t v : t)
      if (v >= m.vertices.size())
        fail_input("picture: mesh {} has a triangle at vertex {}, and only {} vertices", index, v, m.vertices.size());
}

}  // namespace

bool MeshStore::changed(Slot& slot, const MeshBatch& m) {
  if (slot.vertex_data == m.vertices.data() && slot.vertex_count == m.vertices.size() &&
      slot.triangle_data == m.triangles.data() && slot.triangle_count == m.triangles.size() &&
      slot.normal_data == m.normals.data() && slot.normal_count == m.normals.size() && slot.revision == m.revision)
    return false;
  slot.vertex_data = m.vertices.data(), slot.vertex_count = m.vertices.size();
  slot.triangle_data = m.triangles.data(), slot.triangle_count = m.triangles.size();
  slot.normal_data = m.normals.data(), slot.normal_count = m.normals.size();
  slot.revision = m.revision;
  return true;
}

std::span<const MeshOnDevice> MeshStore::upload(std::span<const MeshBatch> meshes) {
  if (slots_.size() < meshes.size()) slots_.resize(meshes.size());
  meshes_.clear();
  for (std::size_t k = 0; k < meshes.size(); ++k) {
    const MeshBatch& m = meshes[k];
    Slot& slot = slots_[k];
    if (changed(slot, m)) {
      slot.vertex_data = nullptr;  // until all of it has passed
      check(m, k);
      slot.position.fill(m.vertices.data(), m.vertices.size_bytes());
      slot.index.fill(m.triangles.data(), m.triangles.size_bytes());
      slot.vertices.floats(0, slot.position, 3);
      if (m.normals.empty()) {
        slot.vertices.none(1);
      } else {
        slot.normal.fill(m.normals.data(), m.normals.size_bytes());
        slot.vertices.floats(1, slot.normal, 3);
      }
      slot.vertices.indices(slot.index);
      slot.vertex_data = m.vertices.data();
    }
    meshes_.push_back({&m, &slot.vertices, static_cast<int>(3 * m.triangles.size()), matrix_of(m.pose)});
  }
  return meshes_;
}

}  // namespace dreampm::gl

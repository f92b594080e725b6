#include "dreampm/export/clip.h"

#include <fmt/format.h>

namespace dreampm::exchange {
std::string ClipInfo::units() const {
  const std::string unit = axes.scale == 1 ? "SI units" : fmt::format("a unit of {:.9g} m", 1 / axes.scale);
  return fmt::format("{}, {} up", unit, axes.up == Up::z ? "Z" : "Y");
}

std::string ClipInfo::mesh_name(std::size_t mesh) const {
  return meshed.size() > 1 ? materials[static_cast<std::size_t>(meshed[mesh])].name + "-surface" : "surface";
}

TriMesh placed(const ClipObject& object, const ObjectState& state) {
  if (object.deforms) return state.mesh;
  TriMesh mesh = object.mesh;
  if (state.pose == Pose{}) return mesh;
  for (Vec3f& v : mesh.vertices) v = static_cast<Vec3f>(state.pose(static_cast<Vec3d>(v)));
  for (Vec3f& n : mesh.normals) n = static_cast<Vec3f>(state.pose.rotation(static_cast<Vec3d>(n)));
  return mesh;
}

}  // namespace dreampm::exchange

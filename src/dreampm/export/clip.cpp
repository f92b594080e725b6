#include "dreampm/export/clip.h"

#include <fmt/format.h>

namespace dreampm::exchange {
namespace fs = std::filesystem;
namespace {

std::vector<fs::path> itself(const ClipInfo&, const fs::path& target) { return {target}; }

using WriteFrame = void (*)(const ClipInfo&, const ClipFrame&, const fs::path& folder);

/// Files of their own for each frame.
template <WriteFrame write>
class EachFrame final : public ClipWriter {
 public:
  EachFrame(const ClipInfo& clip, fs::path folder) : clip_(clip), folder_(std::move(folder)) {}
  void add(const ClipFrame& frame) override { write(clip_, frame, folder_); }

 private:
  ClipInfo clip_;
  fs::path folder_;
};
template <WriteFrame write>
std::unique_ptr<ClipWriter> each_frame(const ClipInfo& clip, const fs::path& folder) {
  return std::make_unique<EachFrame<write>>(clip, folder);
}

}  // namespace

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

const std::vector<Format>& formats() {
  static const std::vector<Format> all{
      {"ply", "particles and meshes, a file a frame", ".ply", false, nullptr, each_frame<write_ply_frame>},
      {"obj", "the same without velocities", ".obj", false, nullptr, each_frame<write_obj_frame>},
      {"gltf", "a .glb a frame, with materials and a camera", ".glb", true, nullptr, each_frame<write_gltf_frame>},
      {"vtkhdf", "a time series for ParaView and VTK", ".vtkhdf", false, vtkhdf_files, write_vtkhdf_clip},
      {"vdb", "a level set and velocities, a file a frame", ".vdb", false, nullptr, each_frame<write_vdb_frame>},
      {"usd", "one animated .usda", ".usda", false, itself, write_usd_clip}};
  return all;
}

}  // namespace dreampm::exchange

#include "dreampm/pictures/wetted_solids.h"

#include "dreampm/setup/colliders.h"

namespace dreampm {

WettedSolids::WettedSolids(const model::Scene& scene) {
  const Meshes files(Meshes::Say::keep);
  for (const model::Collider& c : scene.colliders) {
    if (c.pin || c.holds) continue;
    auto sequence = mesh_sequence(c, scene.space);
    solids_.push_back({c.name, sequence ? nullptr : collider_region(c, scene.space, files),
                       motion_path(c.motion, c.shape, scene.space.spacing, files), std::move(sequence)});
  }
}

std::vector<WettedSolid> WettedSolids::in(const FrameRecord& frame) const {
  std::vector<WettedSolid> solids;
  for (const Solid& s : solids_) {
    const auto found = frame.poses.find(s.name);
    solids.push_back({s.sequence ? s.sequence->at(frame.time) : s.region, found != frame.poses.end() ? found->second
                                                                          : s.path ? s.path->pose_at(frame.time)
                                                                                   : Pose{}});
  }
  return solids;
}

std::vector<WettedSolid> wetted_solids(const std::vector<Collider>& colliders) {
  std::vector<WettedSolid> solids;
  for (const Collider& c : colliders)
    if (!c.holds) solids.push_back({c.shape, c.pose});
  return solids;
}

}  // namespace dreampm

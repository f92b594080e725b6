#include "dreampm/pictures/wetted_solids.h"

namespace dreampm {

WettedSolids::WettedSolids(const model::Scene& scene) {
  const Meshes files(Meshes::Say::keep);
  for (const model::Collider& c : scene.colliders)
    if (!c.pin && !c.holds) solids_.emplace_back(c, scene.space, files);
}

std::vector<WettedSolid> WettedSolids::in(const FrameRecord& frame) const {
  std::vector<WettedSolid> solids;
  for (const SolidInTime& s : solids_) solids.push_back({s.region_at(frame.time), s.pose_in(frame)});
  return solids;
}

std::vector<WettedSolid> wetted_solids(const std::vector<Collider>& colliders) {
  std::vector<WettedSolid> solids;
  for (const Collider& c : colliders)
    if (!c.holds) solids.push_back({c.shape, c.pose});
  return solids;
}

}  // namespace dreampm

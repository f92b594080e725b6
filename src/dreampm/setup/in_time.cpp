#include "dreampm/setup/in_time.h"

#include "dreampm/setup/colliders.h"

namespace dreampm {

ColliderInTime::ColliderInTime(const model::Collider& given, const model::Space& space, const Meshes& meshes)
    : name_(given.name),
      path_(motion_path(given.motion, given.shape, space.spacing, meshes)),
      sequence_(mesh_sequence(given, space)) {}

Pose ColliderInTime::pose_in(const FrameRecord& frame) const {
  const auto rigid = frame.poses.find(name_);
  return rigid != frame.poses.end() ? rigid->second : pose_at(frame.time);
}

SolidInTime::SolidInTime(const model::Collider& given, const model::Space& space, const Meshes& meshes)
    : ColliderInTime(given, space, meshes), region_(sequence() ? nullptr : collider_region(given, space, meshes)) {}

}  // namespace dreampm

// Colliders of a scene in its frames, rigid bodies and containers that move among them: where they
// stand and what they fill.
#pragma once
#include <memory>
#include <string>

#include "dreampm/io/run_record.h"
#include "dreampm/level_set/level_set.h"
#include "dreampm/level_set/mesh_sequence.h"
#include "dreampm/math/motion_path.h"
#include "dreampm/model/scene.h"

namespace dreampm {

/// The motion of a collider through the frames of a run.
class ColliderInTime {
 public:
  /// Throws InputError for a file that cannot be read.
  ColliderInTime(const model::Collider& given, const model::Space& space, const Meshes& meshes);

  const std::string& name() const { return name_; }
  /// Its surfaces, if it deforms; else null.
  const MeshSequence* sequence() const { return sequence_.get(); }
  /// Its pose at a time [s] by the motion that the scene gives it; at rest without one.
  Pose pose_at(double time) const { return path_ ? path_->pose_at(time) : Pose{}; }
  /// Its pose in a frame: of rigid bodies as the run says, of others as the scene does.
  Pose pose_in(const FrameRecord& frame) const;

 private:
  std::string name_;
  std::shared_ptr<const MotionPath> path_;
  std::shared_ptr<const MeshSequence> sequence_;
};

/// A collider that is no pin, and the region that it fills.
class SolidInTime : public ColliderInTime {
 public:
  /// Throws InputError also for a shape that encloses nothing.
  SolidInTime(const model::Collider& given, const model::Space& space, const Meshes& meshes);

  /// The region before its pose; at a time [s] if it deforms.
  std::shared_ptr<const Region> region_at(double time) const { return sequence() ? sequence()->at(time) : region_; }

 private:
  std::shared_ptr<const Region> region_;  ///< null if it deforms
};

}  // namespace dreampm

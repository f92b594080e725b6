// Colliders and rigid bodies of a scene, as the surfaces of its matter meet them.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "dreampm/io/run_record.h"
#include "dreampm/level_set/mesh_sequence.h"
#include "dreampm/math/motion_path.h"
#include "dreampm/model/scene.h"
#include "dreampm/state/collider.h"
#include "dreampm/surface/surface.h"

namespace dreampm {

/// Those of a scene, read once, for its frames. What holds matter is none: that lies inside of it.
class WettedSolids {
 public:
  explicit WettedSolids(const model::Scene& scene);
  /// Returns them as they stand in a frame: rigid bodies as the run says, others as the scene does.
  std::vector<WettedSolid> in(const FrameRecord& frame) const;

 private:
  struct Solid {
    std::string name;
    std::shared_ptr<const Region> region;
    std::shared_ptr<const MotionPath> path;
    std::shared_ptr<const MeshSequence> sequence;  ///< in place of the region
  };
  std::vector<Solid> solids_;
};

/// Returns those of a simulation as they stand.
std::vector<WettedSolid> wetted_solids(const std::vector<Collider>& colliders);

}  // namespace dreampm

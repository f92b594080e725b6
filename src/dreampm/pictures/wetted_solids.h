// Colliders and rigid bodies of a scene, as the surfaces of its matter meet them.
#pragma once
#include <vector>

#include "dreampm/model/scene.h"
#include "dreampm/setup/in_time.h"
#include "dreampm/state/collider.h"
#include "dreampm/surface/surface.h"

namespace dreampm {

/// Those of a scene, read once, for its frames. What holds matter is none: that lies inside of it.
class WettedSolids {
 public:
  explicit WettedSolids(const model::Scene& scene);
  /// Returns them as they stand in a frame.
  std::vector<WettedSolid> in(const FrameRecord& frame) const;

 private:
  std::vector<SolidInTime> solids_;
};

/// Returns those of a simulation as they stand.
std::vector<WettedSolid> wetted_solids(const std::vector<Collider>& colliders);

}  // namespace dreampm

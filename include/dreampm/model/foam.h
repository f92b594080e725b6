// What matter sends out that is finer than its particles: spray, foam and bubbles of liquids, dust
// of snow and sand.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "dreampm/vec.h"

namespace dreampm::model {

/// Between which values a measure of the motion goes from nothing to all that it can give. One that
/// is absent is found from the frames of the run.
struct FoamLimits {
  std::optional<double> from, to;
  bool operator==(const FoamLimits&) const = default;
};

/// A cause of foam.
struct FoamSource {
  double share = 1;  ///< of Foam::rate that it can give; 0: none
  FoamLimits limits{};
  bool operator==(const FoamSource&) const = default;
};

/// How much foam there is, where it comes from, and how it moves and fades. The limits are, with
/// their units: speed m/s; trapped_air and vorticity m/s over `scale`; crest 1/m.
struct Foam {
  double amount = 1;             ///< times everything that is emitted; 0 or more
  std::vector<std::string> of;   ///< names; empty: every liquid of at most 0.1 Pa s, snow and sand
  std::optional<double> rate;    ///< 1/(m^3 s) of a cause at its upper limit; absent: 5000 a second in scale^3
  std::optional<double> scale;   ///< m, over which motion is compared; absent: by the volume of the matter
  std::optional<double> radius;  ///< m, of the mean; absent: a 20th of the scale
  FoamLimits speed;              ///< m/s: below, nothing is emitted whatever the cause
  FoamSource trapped_air, crest, vorticity{0.3, {}};
  int most = 2000000;                 ///< at once
  double life_min = 2, life_max = 5;  ///< s, of foam on the surface
  double grow = 0.1, fade = 0.5;      ///< s, in which a radius comes and goes
  std::optional<double> rise;         ///< m/s, of bubbles in liquid at rest; absent: by their radius
  double drag = 1;                    ///< times the drag of the air on a drop of that radius; 0: none
  Vec3d color{0.95, 0.96, 0.97};      ///< sRGB 0..1, of spray, foam and bubbles
  bool operator==(const Foam&) const = default;
};

}  // namespace dreampm::model

// Foam of what is played, made as matter moves, by the rules of the foam stage (foam/foam.h).
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "dreampm/foam/foam.h"
#include "dreampm/pipeline/foam_limits.h"
#include "dreampm/play/model/frame.h"
#include "dreampm/simulation.h"

namespace dreampm::play {

/// It moves on 20 times in a simulated second, and less often where a tick is longer. Limits are
/// found of what has been seen so far: the first splash gives a little too much.
class LiveFoam {
 public:
  /// Moves it on to where the matter is, where that is due. A scene without a key `foam` foams as
  /// one with an empty one.
  void see(const Simulation& simulation);
  /// There is none any more, and what was seen is forgotten: after a jump in time.
  void forget() { *this = {}; }
  /// Where it is drawn at that time [s]: on from where it was, at its velocities.
  void show(double time, FoamSprites& in_liquid, FoamSprites& outside) const;

 private:
  /// One of the two kinds of matter that foam.
  struct Kind {
    bool dust = false;
    Vec3f color{};  ///< sRGB
    FoamParticles foam{};
    FoamingMatter matter{};  ///< when it was moved on last
    std::vector<FoamMaxima> maxima{};
    double volume = 0;  ///< m^3, the most that there was
  };
  void move(Kind& kind, const Simulation& simulation, const model::Foam& foam, const FrameRecord& now);
  FrameRecord record(const Simulation& simulation) const;

  std::vector<Kind> kinds_;             ///< empty: it was never moved on
  int frame_ = 0;                       ///< counts how often it was
  FrameRecord before_{};                ///< when it was last
  std::vector<std::string> colliders_;  ///< that obstacles_ is of
  std::shared_ptr<const FoamObstacles> obstacles_;
};

}  // namespace dreampm::play

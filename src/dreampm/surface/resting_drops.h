// Drops at rest that dry up: how much of each is left, by what earlier frames show.
#pragma once
#include <cstdint>
#include <functional>
#include <map>
#include <vector>

#include "dreampm/math/vec.h"

namespace dreampm::surface {

/// The particles of a liquid in a frame.
struct LiquidFrame {
  double time = 0;                 ///< s
  std::vector<std::int32_t> ids;   ///< ascending
  std::vector<Vec3f> positions{};  ///< m
};

/// Particles rest while they are with few others and slow: fewer than 8 within 2.5 spacings, and by
/// less than a spacing in 1/24 s from frame to frame. A frame's answer hangs on the frames of the
/// last `life` alone, so that frames can be made in any order.
class RestingDrops {
 public:
  /// `life` [s]: after which nothing is left. `frame` returns a frame by its number, from `first`
  /// on; each is asked for once where frames are made in their order.
  RestingDrops(float spacing, double life, int first, std::function<LiquidFrame(int)> frame)
      : spacing_(spacing), life_(life), first_(first), frame_(std::move(frame)) {}

  /// The share of its volume that each particle of a frame has left: (1 - rest/life)^(3/2), since
  /// the square of a drop's radius shrinks evenly as it evaporates (Fuchs, "Evaporation and Droplet
  /// Growth in Gaseous Media", 1959).
  std::vector<float> remaining(int frame);

 private:
  /// Those with few others, in the order of their ids.
  struct Lonely {
    double time = 0;
    std::size_t all = 0;               ///< particles in the frame
    std::vector<std::uint32_t> place;  ///< of each in its frame
    std::vector<std::int32_t> ids;
    std::vector<Vec3f> positions;
  };
  const Lonely& lonely(int frame);

  float spacing_;
  double life_;
  int first_;
  std::function<LiquidFrame(int)> frame_;
  std::map<int, Lonely> known_;
};

}  // namespace dreampm::surface

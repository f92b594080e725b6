// Hands that do anything: for runs that look for what breaks a playground.
#pragma once
#include <cstdint>

#include "dreampm/play/model/action.h"
#include "dreampm/play/model/frame.h"

namespace dreampm::play {

/// Actions by chance. The same seed and frames give the same ones.
class RandomActions {
 public:
  explicit RandomActions(std::uint64_t seed) : seed_(seed) {}

  /// A control to anywhere in its range, or a tool to anywhere in the box: some of what comes out
  /// may be refused. Opens nothing.
  Action next(const Frame& frame);
  /// Another stage: a story, or one of the report's presets.
  Action open();

 private:
  double random(double low, double high);
  /// A whole number below `count`, which is 1 or more.
  std::size_t index(std::size_t count);

  std::uint64_t seed_, drawn_ = 0;
};

}  // namespace dreampm::play

// Actions by chance: for runs that look for what breaks a playground.
#pragma once
#include <cstddef>
#include <cstdint>
#include <string>

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

  // For tools.
  double number(double low, double high);
  /// A whole number below `count`, which is 1 or more.
  std::size_t index(std::size_t count);
  /// A place in the box.
  std::string place(const Frame& frame);
  /// A blank and a length: part of the shortest edge of the box.
  std::string length(const Frame& frame, double least, double most);
  /// Three numbers, each behind a blank.
  std::string vector(double low, double high);

 private:
  /// What is no tool's.
  Action other(const Frame& frame);
  Action setting(const Frame& frame);

  std::uint64_t seed_, drawn_ = 0;
};

}  // namespace dreampm::play

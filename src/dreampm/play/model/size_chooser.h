// Whether a machine keeps up with a stage, by a second of measuring.
#pragma once
#include <string>

#include "dreampm/play/model/frame.h"

namespace dreampm::play {

class SizeChooser {
 public:
  /// Whether the stage shall be a small one, which is said once: of a frame that is seen at that
  /// time [s], where the first second of the stage took much longer than that.
  bool wants_small(const Frame& frame, double now);

 private:
  std::string story_;
  double began_ = 0, measured_from_ = 0;  ///< s, of the clock
  double from_ = -1;                      ///< s, of the world; below 0: not yet
  bool done_ = false;
};

}  // namespace dreampm::play

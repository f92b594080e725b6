// When the window draws its next picture: no more of them than one sees, and none that would look
// as the last.
#pragma once
#include <cstdint>

#include "dreampm/play/model/frame.h"

namespace dreampm::play {

class PicturePace {
 public:
  /// Pictures a second where the solver does not keep up: it needs the processor more.
  static constexpr double most_a_second = 30;
  /// s: how long pictures go on after something came in, for what panels show late.
  static constexpr double linger = 1;

  /// Whether a picture is due at that time [s]. `touched`: something came in since the last call;
  /// `until`: panels change by themselves up to then.
  bool is_due(const Frame& frame, double now, bool touched, double until);
  /// A picture of that frame was drawn.
  void drew(const Frame& frame, double now);

 private:
  bool shows_the_same(const Frame& frame) const;

  double touched_ = -1e9, drawn_at_ = -1e9;
  double rate_ = 1;  ///< of late
  bool is_slow_ = false;
  std::uint64_t seen_ = 0;  ///< number of the frame that was counted last
  struct Shown {
    double time = -1;
    std::uint64_t steps = 0, actions = 0, message = 0;
    double past = 0, future = 0;
  } shown_;
};

}  // namespace dreampm::play

// What was shown of late, kept so that it can still become a film.
#pragma once
#include <cstdint>
#include <deque>
#include <memory>

#include "dreampm/play/model/frame.h"

namespace dreampm::play {

class LastSeconds {
 public:
  static constexpr double reach = 5;  ///< s of playing
  static constexpr double fps = 30;
  /// Of particles; where they need more, fewer seconds are kept.
  static constexpr std::uint64_t most_bytes = 256ull << 20;

  /// A frame to show, and when [s of playing]. What stood still is left out.
  struct Shown {
    std::shared_ptr<const Frame> frame;
    double time;
  };
  void keep(std::shared_ptr<const Frame> frame);
  const std::deque<Shown>& shown() const { return shown_; }

 private:
  std::deque<Shown> shown_;
  double now_ = 0;                        ///< s of playing
  std::uint64_t number_ = 0, bytes_ = 0;  ///< number_: of the frame that was seen last
  double time_ = -1;                      ///< s: that frame's
};

}  // namespace dreampm::play

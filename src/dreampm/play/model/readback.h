// Copies what one side of a playground shows out of it, into frames that stay as they are.
#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "dreampm/play/model/frame.h"
#include "dreampm/play/model/frame_pool.h"
#include "dreampm/play/model/play_scene.h"

namespace dreampm::play {

struct PlayModel;

/// Keeps what is dear to find and seldom changes from frame to frame: meshes, and where sliders
/// hold.
class FrameReader {
 public:
  std::shared_ptr<Frame> read(const PlayModel& side);

 private:
  void read_bodies(const PlayModel& side, Frame& frame);
  void read_controls(const PlayModel& side, Frame& frame);

  FramePool pool_;
  std::vector<BodyFrame> bodies_;  ///< where the scene has them
  std::shared_ptr<const LoadedScene> bodies_of_;
  /// Of the controls `of`, as they were at the tick `at`.
  struct Live {
    std::vector<LiveRange> ranges;
    std::shared_ptr<const std::vector<ControlInfo>> of;
    std::uint64_t at = 0;
  } live_;
};

}  // namespace dreampm::play

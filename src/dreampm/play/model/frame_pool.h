// Frames that are used again when nobody reads them any more: their memory is large.
#pragma once
#include <cstddef>
#include <memory>
#include <mutex>
#include <vector>

#include "dreampm/play/model/frame.h"

namespace dreampm::play {

class FramePool {
 public:
  /// Frames that wait to be used again; more of them are deleted.
  static constexpr std::size_t most_idle = 8;

  /// A frame to write to, with whatever it held before. The last of its readers, on whatever
  /// thread, gives it back, also where the pool is gone by then.
  std::shared_ptr<Frame> next();

 private:
  struct Idle {
    std::mutex mutex;
    std::vector<std::unique_ptr<Frame>> frames;
  };
  const std::shared_ptr<Idle> idle_ = std::make_shared<Idle>();
};

}  // namespace dreampm::play

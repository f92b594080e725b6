#include "dreampm/play/model/frame_pool.h"

#include <utility>

namespace dreampm::play {

std::shared_ptr<Frame> FramePool::next() {
  std::unique_ptr<Frame> frame;
  {
    const std::lock_guard lock(idle_->mutex);
    if (!idle_->frames.empty()) {
      frame = std::move(idle_->frames.back());
      idle_->frames.pop_back();
    }
  }
  if (!frame) frame = std::make_unique<Frame>();
  // The lock orders what the last reader did before what the next writer does.
  return {frame.release(), [idle = idle_](Frame* read) {
            std::unique_ptr<Frame> own(read);
            own->other.reset();
            const std::lock_guard lock(idle->mutex);
            if (idle->frames.size() < most_idle) idle->frames.push_back(std::move(own));
          }};
}

}  // namespace dreampm::play

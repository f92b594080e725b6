#include "dreampm/play/window/last_seconds.h"

#include <utility>

namespace dreampm::play {
namespace {

constexpr double ticks_in_a_second = 60;

std::uint64_t bytes_of_frame(const Frame& frame) {
  std::uint64_t bytes = 0;
  for (const MatterFrame& m : frame.matter)
    bytes += m.position.size() * sizeof(Vec3f) + m.value.size() * sizeof(float) + m.color.size() * 4;
  return bytes + (frame.other ? bytes : 0);
}

}  // namespace

void LastSeconds::keep(std::shared_ptr<const Frame> frame) {
  const std::uint64_t ticks = frame->number - std::exchange(number_, frame->number);
  const bool moved = frame->time != std::exchange(time_, frame->time);
  if (!moved || (!shown_.empty() && ticks == 0)) return;
  now_ += static_cast<double>(shown_.empty() ? 0 : ticks) / ticks_in_a_second;
  if (!shown_.empty() && now_ - shown_.back().time < 0.99 / fps) return;
  bytes_ += bytes_of_frame(*frame);
  shown_.push_back({std::move(frame), now_});
  while (shown_.size() > 1 && (shown_.front().time < now_ - reach + 0.5 / fps || bytes_ > most_bytes)) {
    bytes_ -= bytes_of_frame(*shown_.front().frame);
    shown_.pop_front();
  }
}

}  // namespace dreampm::play

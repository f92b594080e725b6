#include "dreampm/play/recorder.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>
#include <utility>

#include "dreampm/base/log.h"
#include "dreampm/video/encode.h"

namespace dreampm::play {
namespace {

/// Pictures that may wait for the encoder.
constexpr std::size_t most_waiting = 8;

/// In the middle of one of that size, black around it.
RgbImage fitted(const RgbImage& picture, int width, int height) {
  RgbImage out(width, height);
  const int x = (width - picture.width) / 2, y = (height - picture.height) / 2;
  const int from = std::max(0, -x), count = std::min(picture.width - from, width - std::max(0, x));
  for (int row = std::max(0, -y); row < picture.height && y + row < height; ++row)
    if (count > 0) std::memcpy(out.at(x + from, y + row), picture.at(from, row), static_cast<std::size_t>(count) * 3);
  return out;
}

}  // namespace

Recorder::Recorder(std::filesystem::path file, double fps) : file_(std::move(file)), fps_(fps) {
  thread_ = std::thread([this] {
    try {
      encode_pictures(
          [&]() -> std::optional<RgbImage> {
            std::unique_lock lock(mutex_);
            wake_.wait(lock, [&] { return ends_ || !waiting_.empty(); });
            if (waiting_.empty()) return std::nullopt;
            RgbImage next = std::move(waiting_.front());
            waiting_.pop_front();
            wake_.notify_all();
            return next;
          },
          file_, {.fps = fps_, .quality = 18, .quick = true});
    } catch (...) {
      const std::lock_guard lock(mutex_);
      failure_ = std::current_exception();
    }
    const std::lock_guard lock(mutex_);
    stopped_ = true;
    wake_.notify_all();
  });
}

Recorder::~Recorder() {
  try {
    finish();
  } catch (const std::exception& e) {
    warn("{}: the film failed while it ended: {}", file_.string(), e.what());
  }
}

void Recorder::add(const RgbImage& picture, double time) {
  check();
  if (frames_ == 0) width_ = picture.width & ~1, height_ = picture.height & ~1, began_ = last_time_ = time;
  if (width_ < 2 || height_ < 2) return;
  RgbImage now = fitted(picture, width_, height_);
  // The one before stands until now.
  began_ += std::max(0.0, time - last_time_ - longest_stand);
  last_time_ = time;
  const long due = std::lround((time - began_) * fps_);
  while (frames_ > 0 && frames_ < due) push(last_);
  if (frames_ <= due) push(now);
  last_ = std::move(now);
}

void Recorder::push(RgbImage picture) {
  std::unique_lock lock(mutex_);
  wake_.wait(lock, [&] { return stopped_ || waiting_.size() < most_waiting; });
  waiting_.push_back(std::move(picture));
  ++frames_;
  wake_.notify_all();
}

void Recorder::check() {
  const std::lock_guard lock(mutex_);
  if (failure_) std::rethrow_exception(failure_);
}

void Recorder::finish() {
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
  }
  wake_.notify_all();
  if (thread_.joinable()) thread_.join();
  check();
}

}  // namespace dreampm::play

#include "dreampm/play/window/recorder.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>
#include <utility>

#include "dreampm/base/log.h"

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

Recorder::Recorder(std::filesystem::path file, double fps, Behind behind, Encode encode)
    : file_(std::move(file)), fps_(fps), behind_(behind) {
  thread_ = std::thread([this, encode = std::move(encode)] {
    try {
      encode([&] { return next(); }, file_, {.fps = fps_, .quality = 18, .quick = true});
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
  if (frames_ > 0 && frames_ < due) push(last_, due - frames_);
  if (frames_ <= due && !push(now, 1)) ++left_out_;
  last_ = std::move(now);
}

bool Recorder::push(const RgbImage& picture, long frames) {
  std::unique_lock lock(mutex_);
  frames_ += frames;
  if (behind_ == Behind::waits) wake_.wait(lock, [&] { return stopped_ || waiting_.size() < most_waiting; });
  const bool has_room = waiting_.size() < most_waiting;
  if (has_room)
    waiting_.push_back({picture, frames});
  else
    waiting_.back().frames += frames;
  wake_.notify_all();
  return has_room;
}

/// For the encoder, on its thread.
std::optional<RgbImage> Recorder::next() {
  std::unique_lock lock(mutex_);
  wake_.wait(lock, [&] { return ends_ || !waiting_.empty(); });
  if (waiting_.empty()) return std::nullopt;
  Shown& first = waiting_.front();
  if (--first.frames > 0) return first.picture;
  RgbImage picture = std::move(first.picture);
  waiting_.pop_front();
  wake_.notify_all();
  return picture;
}

bool Recorder::is_behind() const {
  const std::lock_guard lock(mutex_);
  return !stopped_ && waiting_.size() >= most_waiting;
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

#include "dreampm/play/window/recorder.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>
#include <utility>

#include "dreampm/base/log.h"

namespace dreampm::play {
namespace {

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

Recorder::Recorder(std::filesystem::path file, double fps, Encode encode) : file_(std::move(file)), fps_(fps) {
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
  const bool was_thrown = is_thrown_;
  try {
    finish();
  } catch (const std::exception& e) {
    if (!was_thrown) warn("{}: the film failed while it ended: {}", file_.string(), e.what());
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
  if (frames_ > 0 && frames_ < due) repeat(due - frames_);
  last_is_pushed_ = frames_ <= due;
  if (last_is_pushed_) push(now);
  last_ = std::move(now);
}

bool Recorder::is_full() const {
  const std::size_t bytes = static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_) * 3;
  const std::size_t most = bytes == 0 ? most_waiting : std::clamp(most_bytes / bytes, std::size_t{4}, most_waiting);
  // One that stands on may come before a new one.
  return waiting_.size() + 2 > most;
}

void Recorder::push(const RgbImage& picture) {
  wait_for_room();
  const std::lock_guard lock(mutex_);
  ++frames_;
  waiting_.push_back({picture, 1});
  wake_.notify_all();
}

void Recorder::repeat(long frames) {
  const std::lock_guard lock(mutex_);
  frames_ += frames;
  if (last_is_pushed_ && !waiting_.empty())
    waiting_.back().frames += frames;
  else
    waiting_.push_back({last_, frames});
  wake_.notify_all();
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

bool Recorder::has_room() const {
  const std::lock_guard lock(mutex_);
  return stopped_ || !is_full();
}

void Recorder::wait_for_room() {
  std::unique_lock lock(mutex_);
  wake_.wait(lock, [&] { return stopped_ || !is_full(); });
}

double Recorder::behind() const {
  const std::lock_guard lock(mutex_);
  long frames = 0;
  for (const Shown& one : waiting_) frames += one.frames;
  return static_cast<double>(frames) / fps_;
}

void Recorder::check() {
  const std::lock_guard lock(mutex_);
  if (!failure_) return;
  is_thrown_ = true;
  std::rethrow_exception(failure_);
}

void Recorder::end() {
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
  }
  wake_.notify_all();
}

bool Recorder::is_done() const {
  const std::lock_guard lock(mutex_);
  return stopped_;
}

void Recorder::finish() {
  end();
  if (thread_.joinable()) thread_.join();
  check();
}

}  // namespace dreampm::play

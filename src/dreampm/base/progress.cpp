#include "dreampm/base/progress.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "dreampm/base/host.h"

namespace dreampm {

std::string duration_text(double seconds) {
  const long s = std::lround(std::max(0.0, seconds));
  if (s < 60) return fmt::format("{} s", s);
  if (s < 3600) return fmt::format("{} min {:02} s", s / 60, s % 60);
  return fmt::format("{} h {:02} min", s / 3600, s / 60 % 60);
}

Progress::Progress(std::string what, std::size_t total)
    : host_(current_host()), what_(std::move(what)), total_(total), start_(Clock::now()), last_(start_) {}

Progress::~Progress() { host_.progress_ends(); }

void Progress::update(std::size_t done, const std::string& note) {
  const auto now = Clock::now();
  if (!started_) {
    // Work that a resumed stage found done must not flatter the pace.
    first_ = done > 0 ? done - 1 : 0;
    started_ = true;
  }
  const double interval = std::chrono::duration<double>(now - last_).count();
  if (done < total_ && interval < (host_.rewrites_progress() ? 0.2 : 10.0) && last_ != start_) return;
  last_ = now;
  const double elapsed = std::chrono::duration<double>(now - start_).count();
  std::string line = fmt::format("{} {}/{}", what_, done, total_);
  if (done > first_ && done < total_)
    line += fmt::format(
        ", {} left", duration_text(elapsed * static_cast<double>(total_ - done) / static_cast<double>(done - first_)));
  if (done == total_) line += fmt::format(", {}", duration_text(elapsed));
  if (!note.empty()) line += "  " + note;
  host_.progress(line);
}

}  // namespace dreampm

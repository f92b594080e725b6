// Progress of long work, as lines to the current host: on a terminal one that is rewritten, in a
// log a plain one now and then.
#pragma once
#include <chrono>
#include <cstddef>
#include <string>

namespace dreampm {

class Host;

/// Shows how much of `total` units is done and how long the rest will take at the pace so far.
class Progress {
 public:
  Progress(std::string what, std::size_t total);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  /// `done` units of work are finished; `note` is appended.
  void update(std::size_t done, const std::string& note = {});

 private:
  using Clock = std::chrono::steady_clock;
  Host& host_;
  std::string what_;
  std::size_t total_, first_ = 0;
  bool started_ = false;
  Clock::time_point start_, last_;
};

/// "8 s", "3 min 05 s", "2 h 10 min".
std::string duration_text(double seconds);

}  // namespace dreampm

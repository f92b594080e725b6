// Clock and processor time.
#pragma once
#include <chrono>
#include <ctime>

namespace dreampm {

inline double seconds_now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Asking for processor time calls the system, which may take the processor away: not for anything
/// short.
struct Moment {
  double wall = seconds_now();
  double cpu = [] {
    timespec t{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
  }();
};

}  // namespace dreampm

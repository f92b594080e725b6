// The time that something took.
#pragma once
#include <chrono>

namespace dreampm {

/// Returns the seconds since `start`, by the wall clock [s].
inline double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace dreampm

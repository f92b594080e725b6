// Denormals cost up to 100 times a normal number and decide nothing.
#pragma once
#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace dreampm {

/// A scope in which this thread takes them for zero; the caller's mode comes back afterwards. A
/// thread of a loop has a mode of its own.
class FlushToZero {
 public:
#if defined(__x86_64__)
  FlushToZero() : saved_(_mm_getcsr()) { _mm_setcsr(saved_ | 0x8040u); }
  ~FlushToZero() { _mm_setcsr(saved_); }
  FlushToZero(const FlushToZero&) = delete;
  FlushToZero& operator=(const FlushToZero&) = delete;

 private:
  unsigned saved_;
#endif
};

}  // namespace dreampm

// Threads that work together on one kernel: a block of them. A kernel is a struct that is its own
// arguments:
//
//   struct Kernel {
//     static constexpr int threads = 128;          // of a block
//     struct Shared { ... };                       // memory of a block
//     template <class Block>
//     DM_FN void operator()(Block& block, Shared& shared) const {
//       block.each_thread([&](int t) { ... });     // every thread once, then all wait for each other
//     }
//   };
//
// On a device each_thread() is what one thread does, and a barrier (gpu/device_block.h). Here it is
// a loop over the threads, so that the same kernels run on any machine and tests see their bits.
// What lies between two calls of each_thread() every thread does alike. The order of the threads
// may be turned around: a kernel whose results depend on it has a race. A barrier that is missing
// within a phase does not show here, but under compute-sanitizer on a card.
#pragma once
#include <array>
#include <atomic>
#include <cstdint>
#include <limits>
#include <numeric>

#include "dreampm/math/scalar.h"

namespace dreampm::gpu {

/// The order in which the threads of a block, and the blocks of a launch, come on the host.
enum class ThreadOrder { rising, falling, scattered };

/// The place of number `i` of `count` in that order.
constexpr int place_in_order(ThreadOrder order, int i, int count) {
  if (order == ThreadOrder::falling) return count - 1 - i;
  if (order == ThreadOrder::rising) return i;
  // A multiplier without a common divisor with the count visits all.
  int step = 7;
  while (std::gcd(step, count) != 1) step += 4;
  return static_cast<int>((static_cast<std::int64_t>(i) * step + 3) % count);
}

/// A block of threads on the host.
template <int threads>
class HostBlock {
 public:
  HostBlock(int index, ThreadOrder order) : index_(index), order_(order) {}

  /// The number of this block in the launch.
  int index() const { return index_; }
  template <class Body>
  void each_thread(const Body& body) const {
    for (int i = 0; i < threads; ++i) body(place_in_order(order_, i, threads));
  }
  /// One value for each thread, that it keeps from one each_thread() to the next.
  template <class T>
  class PerThread {
   public:
    T& operator[](int thread) { return of_[static_cast<std::size_t>(thread)]; }

   private:
    std::array<T, threads> of_{};
  };

  /// Adds to a number that other threads of the block add to. Beyond its range it goes on at the
  /// other end, as on a device.
  static void add(std::int32_t& to, std::int32_t value) {
    to = static_cast<std::int32_t>(static_cast<std::uint32_t>(to) + static_cast<std::uint32_t>(value));
  }
  /// Adds 1 to a counter in a device's memory that threads of any block add to, and returns what it
  /// was.
  static std::int32_t count(std::int32_t& counter) {
    return std::atomic_ref<std::int32_t>(counter).fetch_add(1, std::memory_order_relaxed);
  }
  /// Lowers a number in a device's memory that other threads lower too, of any block.
  static void lower(std::int32_t& to, std::int32_t value) {
    const std::atomic_ref<std::int32_t> shared(to);
    std::int32_t now = shared.load(std::memory_order_relaxed);
    while (value < now && !shared.compare_exchange_weak(now, value, std::memory_order_relaxed)) {
    }
  }
  /// The nearest whole number, halves to even; the last one where it is beyond the range, and 0 of
  /// what is no number, as on a device.
  static std::int32_t nearest(float value) {
    constexpr float beyond = 2147483648.0f;
    if (!(value == value)) return 0;
    if (value >= beyond) return std::numeric_limits<std::int32_t>::max();
    if (value < -beyond) return std::numeric_limits<std::int32_t>::min();
    return static_cast<std::int32_t>(__builtin_lrintf(value));
  }

 private:
  int index_;
  ThreadOrder order_;
};

}  // namespace dreampm::gpu

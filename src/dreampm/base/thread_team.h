// Several loops, one after the other, by threads that stay together: what a step of a small scene
// needs, where starting and joining threads for every loop would cost more than the loops.
#pragma once
#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>

namespace dreampm {

/// A thread's view of its team. All threads of a team call the same loops in the same order. Each
/// has its own part of every loop, the same part of all, so that what one loop leaves in a thread's
/// cache is there for the next; a thread that is done with its part helps the others. Bodies must
/// not start loops on threads of their own.
class ThreadTeam {
 public:
  /// The state that the threads of a team share.
  class TeamState;
  ThreadTeam(TeamState& state, std::size_t thread, std::size_t threads)
      : state_(state), parts_(std::min(threads, most_parts)), part_(thread % parts_) {}

  /// Calls body(i) once for every i in [0, n), `grain` of them in a row on one thread. Returns when
  /// all calls are done: what the loop has written can be read. Other threads may already run the
  /// next loop then: read a result outside of loops only if no later loop writes it.
  template <class Body>
  void loop(std::size_t n, std::size_t grain, const Body& body) {
    const std::size_t pieces = (n + grain - 1) / grain;
    all_ += pieces;
    for (std::size_t p = 0; p < parts_; ++p)
      begin_[p] = end_[p], end_[p] += (p + 1) * pieces / parts_ - p * pieces / parts_;
    for (std::size_t p = part_; p < part_ + parts_; ++p) {
      const std::size_t part = p % parts_, first = part * pieces / parts_;
      std::size_t taken, count = 0;
      for (; take(part, taken); ++count) {
        const std::size_t begin = (first + taken - begin_[part]) * grain, end = std::min(n, begin + grain);
        for (std::size_t i = begin; i < end; ++i) body(i);
      }
      finish(count);
    }
    wait_until([&] { return all_done(); });
  }

  /// Returns the beginning of this thread's part, as a share of all work in [0, 1).
  double begin() const { return static_cast<double>(part_) / static_cast<double>(parts_); }
  /// Returns the end of this thread's part.
  double end() const { return static_cast<double>(part_ + 1) / static_cast<double>(parts_); }

  /// Waits for work that another thread has begun; one must not wait for other work, as no thread
  /// may ever begin it. Does not return where another thread's body has thrown.
  template <class Condition>
  void wait_until(const Condition& met) const {
    for (int tries = 0; !met(); ++tries) pause(tries);
  }

 private:
  static constexpr std::size_t most_parts = 32;
  bool take(std::size_t part, std::size_t& piece);
  void finish(std::size_t pieces);
  bool all_done() const;
  void pause(int tries) const;

  TeamState& state_;
  std::size_t parts_, part_;
  // Pieces of all loops so far: up to the one at hand, and with it.
  std::array<std::size_t, most_parts> begin_{}, end_{};
  std::size_t all_ = 0;
};

/// Calls body(ThreadTeam&) on up to thread_count() threads, this one among them, or on this one
/// alone inside of on_this_thread. Returns when all have; throws what a body threw first.
void parallel_region(const void* body, void (*call)(const void*, ThreadTeam&));
template <class Body>
void parallel_region(const Body& body) {
  parallel_region(&body, [](const void* b, ThreadTeam& team) { (*static_cast<const Body*>(b))(team); });
}

}  // namespace dreampm

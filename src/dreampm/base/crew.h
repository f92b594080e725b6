// Several loops, one after the other, by threads that stay together: what a step of a small scene needs, where starting
// and joining threads for every loop would cost more than the loops.
#pragma once
#include <algorithm>
#include <atomic>
#include <cstddef>

namespace dreampm {

/// A thread's view of the crew that it belongs to. All members call the same loops in the same order; each item of a
/// loop goes to one of them, in order. Bodies must not start loops on threads of their own.
class Crew {
 public:
  /// What the members share.
  class Board;
  explicit Crew(Board& board) : board_(board) {}

  /// Calls body(i) once for every i in [0, n), `grain` of them in a row on one thread. Returns when all is done, by
  /// whomever: what the loop has written can be read.
  template <class Body>
  void loop(std::size_t n, std::size_t grain, const Body& body) {
    const std::size_t first = end_;
    end_ += (n + grain - 1) / grain;
    std::size_t piece;
    while (take(piece)) {
      const std::size_t begin = (piece - first) * grain, end = std::min(n, begin + grain);
      for (std::size_t i = begin; i < end; ++i) body(i);
      finish();
    }
    wait_until([&] { return all_done(); });
  }

  /// Waits for what another member is about to do: in a loop, for an item before the own one, or the crew would wait
  /// forever. Does not return where another's body has thrown.
  template <class Condition>
  void wait_until(const Condition& met) const {
    for (int tries = 0; !met(); ++tries) pause(tries);
  }

 private:
  bool take(std::size_t& piece);
  void finish();
  bool all_done() const;
  void pause(int tries) const;

  Board& board_;
  std::size_t end_ = 0;  ///< of the pieces of all loops so far
};

/// Calls body(Crew&) on up to thread_count() threads, this one among them, or on this one alone inside of
/// on_this_thread. Returns when all have; throws what a body threw first.
void work_together(const void* body, void (*call)(const void*, Crew&));
template <class Body>
void work_together(const Body& body) {
  work_together(&body, [](const void* b, Crew& crew) { (*static_cast<const Body*>(b))(crew); });
}

}  // namespace dreampm

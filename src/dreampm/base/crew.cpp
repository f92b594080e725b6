#include "dreampm/base/crew.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <exception>
#include <thread>

#include "dreampm/base/parallel.h"

namespace dreampm {
namespace {

/// A thread that waits on a core which another program needs keeps that program, or its own crew, from working.
constexpr int pauses_before_yield = 1000;

/// Ends the work of a member where another's has failed.
struct Abandoned {};

void relax() {
#if defined(__x86_64__)
  __builtin_ia32_pause();
#elif defined(__aarch64__)
  asm volatile("yield");
#endif
}

}  // namespace

// Pieces of a part are numbered on and on through all loops, so that a counter a part serves for all of them: a loop
// begins when all pieces before it are done. Each on a cache line of its own.
class Crew::Board {
 public:
  struct alignas(64) Counter {
    std::atomic<std::size_t> count{0};
  };
  std::array<Counter, most_parts> taken;
  Counter done;
  alignas(64) std::atomic<bool> failed{false};
  std::exception_ptr error;  ///< of whoever set `failed`
};

bool Crew::take(std::size_t part, std::size_t& piece) {
  std::atomic<std::size_t>& taken = board_.taken[part].count;
  piece = taken.load(std::memory_order_relaxed);
  while (piece < end_[part])
    if (taken.compare_exchange_weak(piece, piece + 1, std::memory_order_relaxed)) return true;
  return false;
}

void Crew::finish(std::size_t pieces) {
  if (pieces > 0) board_.done.count.fetch_add(pieces, std::memory_order_release);
}

bool Crew::all_done() const { return board_.done.count.load(std::memory_order_acquire) >= all_; }

void Crew::pause(int tries) const {
  if (board_.failed.load(std::memory_order_relaxed)) throw Abandoned();
  if (tries < pauses_before_yield)
    relax();
  else
    std::this_thread::yield();
}

void work_together(const void* body, void (*call)(const void*, Crew&)) {
  Crew::Board board;
  const int slots = tbb::this_task_arena::max_concurrency(), members = std::min(thread_count(), slots);
  if (members <= 1) {
    Crew alone(board, 0, 1);
    return call(body, alone);
  }
  const auto member = [&](int index) {
    // Where every thread is wanted its slot is the same in every crew; of two, the first is the caller.
    if (members == slots) index = tbb::this_task_arena::current_thread_index();
    Crew crew(board, static_cast<std::size_t>(index), static_cast<std::size_t>(members));
    try {
      call(body, crew);
    } catch (const Abandoned&) {
    } catch (...) {
      static_assert(std::atomic<bool>::is_always_lock_free);
      if (!board.failed.exchange(true, std::memory_order_acq_rel)) board.error = std::current_exception();
    }
  };
  tbb::parallel_for(0, members, member, tbb::simple_partitioner());
  if (board.error) std::rethrow_exception(board.error);
}

}  // namespace dreampm

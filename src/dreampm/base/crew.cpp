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

// Pieces of all loops are numbered on and on, so that two counters serve for all of them: a loop begins when all pieces
// before it are done. Each on a cache line of its own.
class Crew::Board {
 public:
  alignas(64) std::atomic<std::size_t> taken{0};
  alignas(64) std::atomic<std::size_t> done{0};
  alignas(64) std::atomic<bool> failed{false};
  std::exception_ptr error;  ///< of whoever set `failed`
};

bool Crew::take(std::size_t& piece) {
  piece = board_.taken.load(std::memory_order_relaxed);
  while (piece < end_)
    if (board_.taken.compare_exchange_weak(piece, piece + 1, std::memory_order_relaxed)) return true;
  return false;
}

void Crew::finish() { board_.done.fetch_add(1, std::memory_order_release); }

bool Crew::all_done() const { return board_.done.load(std::memory_order_acquire) >= end_; }

void Crew::pause(int tries) const {
  if (board_.failed.load(std::memory_order_relaxed)) throw Abandoned();
  if (tries < pauses_before_yield)
    relax();
  else
    std::this_thread::yield();
}

void work_together(const void* body, void (*call)(const void*, Crew&)) {
  Crew::Board board;
  const int members = std::min(thread_count(), tbb::this_task_arena::max_concurrency());
  if (members <= 1) {
    Crew alone(board);
    return call(body, alone);
  }
  const auto member = [&](int) {
    Crew crew(board);
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

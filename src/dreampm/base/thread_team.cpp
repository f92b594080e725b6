#include "dreampm/base/thread_team.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <exception>
#include <thread>

#include "dreampm/base/parallel.h"

namespace dreampm {
namespace {

/// A thread that waits on a core which another program needs keeps that program, or its own team,
/// from working.
constexpr int pauses_before_yield = 1000;

/// Ends the work of a thread where another's has failed.
struct Abandoned {};

void relax() {
#if defined(__x86_64__)
  __builtin_ia32_pause();
#elif defined(__aarch64__)
  asm volatile("yield");
#endif
}

}  // namespace

// Pieces of a part are numbered on and on through all loops, so that a counter a part serves for
// all of them: a loop begins when all pieces before it are done. Each on a cache line of its own.
class ThreadTeam::TeamState {
 public:
  struct alignas(64) Counter {
    std::atomic<std::size_t> count{0};
  };
  std::array<Counter, most_parts> taken;
  Counter done;
  alignas(64) std::atomic<bool> failed{false};
  std::exception_ptr error;  ///< of whoever set `failed`
};

bool ThreadTeam::take(std::size_t part, std::size_t& piece) {
  std::atomic<std::size_t>& taken = state_.taken[part].count;
  piece = taken.load(std::memory_order_relaxed);
  while (piece < end_[part])
    if (taken.compare_exchange_weak(piece, piece + 1, std::memory_order_relaxed)) return true;
  return false;
}

void ThreadTeam::finish(std::size_t pieces) {
  if (pieces > 0) state_.done.count.fetch_add(pieces, std::memory_order_release);
}

bool ThreadTeam::all_done() const { return state_.done.count.load(std::memory_order_acquire) >= all_; }

void ThreadTeam::pause(int tries) const {
  if (state_.failed.load(std::memory_order_relaxed)) throw Abandoned();
  if (tries < pauses_before_yield)
    relax();
  else
    std::this_thread::yield();
}

void parallel_region(const void* body, void (*call)(const void*, ThreadTeam&)) {
  ThreadTeam::TeamState state;
  const int slots = tbb::this_task_arena::max_concurrency(), threads = std::min(thread_count(), slots);
  if (threads <= 1) {
    ThreadTeam alone(state, 0, 1);
    return call(body, alone);
  }
  const auto thread = [&](int index) {
    // A thread's slot is the same in every team if all threads take part; of two, the first is the
    // caller.
    if (threads == slots) index = tbb::this_task_arena::current_thread_index();
    ThreadTeam team(state, static_cast<std::size_t>(index), static_cast<std::size_t>(threads));
    try {
      call(body, team);
    } catch (const Abandoned&) {
    } catch (...) {
      static_assert(std::atomic<bool>::is_always_lock_free);
      if (!state.failed.exchange(true, std::memory_order_acq_rel)) state.error = std::current_exception();
    }
  };
  tbb::parallel_for(0, threads, thread, tbb::simple_partitioner());
  if (state.error) std::rethrow_exception(state.error);
}

}  // namespace dreampm

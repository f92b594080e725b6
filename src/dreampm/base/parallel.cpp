#include "dreampm/base/parallel.h"

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>

namespace dreampm {

struct ThreadLimit::Impl {
  tbb::global_control control;
};

ThreadLimit::ThreadLimit(int count)
    : impl_(new Impl{
          tbb::global_control(tbb::global_control::max_allowed_parallelism,
                              static_cast<std::size_t>(count > 0 ? count : tbb::info::default_concurrency()))}) {}
ThreadLimit::~ThreadLimit() = default;

int thread_count() {
  const auto process =
      static_cast<int>(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
  return std::min(process, tbb::this_task_arena::max_concurrency());
}

struct ThreadArena::Impl {
  tbb::task_arena arena;
};

ThreadArena::ThreadArena(int count)
    : impl_(new Impl{tbb::task_arena(count > 0 ? std::min(count, thread_count()) : thread_count())}) {}
ThreadArena::~ThreadArena() = default;
void ThreadArena::run(const std::function<void()>& body) { impl_->arena.execute(body); }

void on_this_thread(const std::function<void()>& body) { tbb::task_arena(1).execute(body); }

void parallel_ranges(std::size_t n, std::size_t grain, RangeBody body) {
  if (n == 0) return;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, n, std::max<std::size_t>(grain, 1)),
                    [&](const tbb::blocked_range<std::size_t>& r) { body(r.begin(), r.end()); });
}

}  // namespace dreampm

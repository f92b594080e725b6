// Loops over threads. Results must not depend on how many there are: write by index, sum in a fixed
// order.
#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <functional>
#include <memory>
#include <type_traits>

namespace dreampm {

/// While it lives, parallel loops use at most `count` threads (0: all cores).
class ThreadLimit {
 public:
  explicit ThreadLimit(int count);
  ~ThreadLimit();
  ThreadLimit(const ThreadLimit&) = delete;
  ThreadLimit& operator=(const ThreadLimit&) = delete;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Threads that loops may use now, here.
int thread_count();

/// Threads of one owner: loops in what it runs use at most `count`, whatever runs beside it.
class ThreadArena {
 public:
  explicit ThreadArena(int count);  ///< 0: as many as loops may use here; never more
  ~ThreadArena();
  ThreadArena(const ThreadArena&) = delete;
  ThreadArena& operator=(const ThreadArena&) = delete;
  /// Calls body once, and returns when it has; throws what it throws.
  void run(const std::function<void()>& body);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Calls body; loops inside it run on the calling thread alone, so that several bodies can work
/// side by side.
void on_this_thread(const std::function<void()>& body);

/// A body of a loop by reference: a step calls many, and none should take memory. What it refers to
/// must outlive the call that it is passed to.
class RangeBody {
 public:
  template <class Body>
    requires(!std::is_same_v<std::remove_cvref_t<Body>, RangeBody>)
  RangeBody(const Body& body)
      : object_(&body), call_([](const void* object, std::size_t begin, std::size_t end) {
          (*static_cast<const Body*>(object))(begin, end);
        }) {}
  void operator()(std::size_t begin, std::size_t end) const { call_(object_, begin, end); }

 private:
  const void* object_;
  void (*call_)(const void*, std::size_t, std::size_t);
};

/// Calls body(begin, end) over disjoint pieces of [0, n), each of at least `grain` items where
/// possible.
void parallel_ranges(std::size_t n, std::size_t grain, RangeBody body);

/// Calls body(i) for every i in [0, n).
template <class Body>
void parallel_for(std::size_t n, std::size_t grain, const Body& body) {
  parallel_ranges(n, grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) body(i);
  });
}

/// Adds one sum to another.
struct Plus {
  template <class T>
  void operator()(T& to, const T& sum) const {
    to += sum;
  }
};

/// Calls body(sum, i) for every i in [0, n), where `sum` starts as `zero` and belongs to a piece of
/// [0, n) that is worked through in order; join(sum, of the next piece) puts all together. Takes no
/// memory.
template <class T, class Body, class Join = Plus>
T parallel_reduce(std::size_t n, const T& zero, const Body& body, const Join& join = {}) {
  constexpr std::size_t pieces = 64;  // for any number of threads
  std::array<T, pieces> sums;
  sums.fill(zero);
  const std::size_t each = (n + pieces - 1) / pieces;
  parallel_for(pieces, 1, [&](std::size_t piece) {
    T sum = zero;
    for (std::size_t i = piece * each; i < std::min(n, (piece + 1) * each); ++i) body(sum, i);
    sums[piece] = sum;
  });
  T all = zero;
  for (const T& sum : sums) join(all, sum);
  return all;
}

}  // namespace dreampm

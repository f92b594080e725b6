// Schedules tasks in space: neighbors add to the same nodes, and have to do so in the same order
// for any number of threads.
#pragma once
#include <atomic>
#include <cstdint>
#include <vector>

#include "dreampm/base/thread_team.h"
#include "dreampm/state/neighbors.h"

namespace dreampm {

/// Tasks at places of a lattice, colored so that no two of one color touch. A task waits for its
/// neighbors of lower colors alone. Each thread of a team begins with a part of space of its own.
class ColoredScheduler {
 public:
  /// `places` of the tasks: blocks, in order, all with the same z where tasks reach through all of
  /// it. `work`: of each, in any unit. Keeps its memory.
  void prepare(const World<float>& world, const std::vector<Vec3i>& places, const std::vector<std::uint32_t>& work);
  /// All tasks, those of a lower color first. Of two that touch, the one that comes first here runs
  /// first, in whatever order they are begun.
  const std::vector<std::uint32_t>& by_color() const { return by_color_; }
  /// Must be called before every run, by one thread.
  void begin();
  /// Calls body(task) for all of them. All threads of a team call it together.
  template <class Body>
  void run(ThreadTeam& team, const Body& body) {
    const std::uint32_t first = task_at(team.begin()), last = task_at(team.end());
    for (const std::uint32_t task : order_)
      if (task >= first && task < last) run_task(team, task, body);
    for (const std::uint32_t task : order_) run_task(team, task, body);
    for (const std::uint32_t task : order_) wait_for(team, task);
  }

 private:
  enum State : std::uint8_t { waiting, taken, done };

  /// Runs a task that no thread has taken: first the tasks it waits for that none has taken.
  template <class Body>
  void run_task(ThreadTeam& team, std::uint32_t task, const Body& body) {
    if (!take(task)) return;
    const auto before = [&](const auto& what) {
      for (std::uint32_t i = first_wait_[task]; i < first_wait_[task + 1]; ++i) what(waits_for_[i]);
    };
    before([&](std::uint32_t other) { run_task(team, other, body); });
    before([&](std::uint32_t other) { wait_for(team, other); });
    body(task);
    state(task).store(done, std::memory_order_release);
  }
  bool take(std::uint32_t task) {
    std::uint8_t found = waiting;
    return state(task).load(std::memory_order_relaxed) == waiting &&
           state(task).compare_exchange_strong(found, taken, std::memory_order_relaxed);
  }
  void wait_for(const ThreadTeam& team, std::uint32_t task) {
    team.wait_until([&] { return state(task).load(std::memory_order_acquire) == done; });
  }
  std::atomic_ref<std::uint8_t> state(std::uint32_t task) { return std::atomic_ref(states_[task]); }
  /// The task that begins at a share of all work.
  std::uint32_t task_at(double share) const;

  BlockList places_;
  std::vector<Vec3i> wrapped_;
  std::vector<Neighbors> around_;
  std::vector<std::uint8_t> colors_;
  std::vector<std::uint32_t> by_color_;
  std::vector<std::uint64_t> work_before_;  ///< by task, and of all
  std::vector<std::uint32_t> order_;        ///< in which to begin them
  std::vector<std::uint32_t> first_wait_;   ///< by task, into waits_for_
  std::vector<std::uint32_t> waits_for_;
  std::vector<std::uint8_t> states_;
};

}  // namespace dreampm

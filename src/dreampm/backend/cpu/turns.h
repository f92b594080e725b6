// Who may work when: tasks that lie next to each other add to the same nodes, and have to do so in the same order for
// any number of threads.
#pragma once
#include <atomic>
#include <cstdint>
#include <vector>

#include "dreampm/base/crew.h"
#include "dreampm/state/world.h"

namespace dreampm {

/// Tasks at places of a lattice, eight colours of them, so that no two of one colour touch. A task waits for those
/// around it that have a lower colour, and for no others.
class Turns {
 public:
  /// `places` of the tasks: blocks, in order. Keeps its memory.
  void prepare(const World<float>& world, const std::vector<Vec3i>& places);
  /// Before every run.
  void begin() { ++round_; }
  /// Calls body(task) for all of them. All members of a crew call it together.
  template <class Body>
  void run(Crew& crew, const Body& body) {
    crew.loop(order_.size(), 1, [&](std::size_t turn) {
      const std::size_t task = order_[turn];
      for (std::size_t i = first_wait_[task]; i < first_wait_[task + 1]; ++i)
        crew.wait_until([&] { return rounds(waits_for_[i]).load(std::memory_order_acquire) == round_; });
      body(task);
      rounds(task).store(round_, std::memory_order_release);
    });
  }

 private:
  std::atomic_ref<std::uint32_t> rounds(std::size_t task) { return std::atomic_ref(done_[task]); }

  BlockList places_;
  std::vector<Vec3i> room_;
  std::vector<std::uint8_t> colors_;
  std::vector<std::uint32_t> order_;       ///< by colour: what a task waits for comes before it
  std::vector<std::uint32_t> first_wait_;  ///< by task, into waits_for_
  std::vector<std::uint32_t> waits_for_;
  std::vector<std::uint32_t> done_;  ///< the last round of each task
  std::uint32_t round_ = 0;
};

}  // namespace dreampm

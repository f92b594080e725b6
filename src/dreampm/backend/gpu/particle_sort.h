// The sort of a World whose particles and nodes lie in a device's memory, as Regroup: the same
// order bit for bit.
#pragma once
#include <vector>

#include "dreampm/backend/gpu/grid_layout.h"
#include "dreampm/state/regroup_plan.h"

namespace dreampm::gpu {

class ParticleSort {
 public:
  /// What it is handed has to outlive it.
  ParticleSort(Device& device, GridLayout& layout, SomePlaces& places, SomeNodes& nodes);
  /// Nodes and particles have to be current in `memory`, and are afterwards. The World gets the
  /// lists of blocks, and its arrays their sizes. What sinks take the host decides: of the blocks
  /// that they reach positions and nodes come home, and are overwritten in the World.
  void operator()(World<float>& world, Memory& memory);

 private:
  struct SetRoom {
    explicit SetRoom(Device& device)
        : counts(device), number(device), start(device), from(device), taken(device), taken_start(device) {}
    Buffer<std::int32_t> counts, number;
    Buffer<std::uint32_t> start, from;
    Buffer<std::uint32_t> taken, taken_start;  ///< as SortInput has them; empty where none are
  };
  SortInput input(const SetMemory& set, const SetRoom& room) const;
  void find_taken(World<float>& world, Memory& memory);
  void count_moves(World<float>& world, Memory& memory);
  void find_targets();
  void find_cells(World<float>& world, Memory& memory);
  void move(World<float>& world, std::size_t set, SetMemory& memory);

  Device* device_;
  GridLayout& layout_;
  SomePlaces& places_;
  SomeNodes& nodes_;
  RegroupPlan<float> plan_;
  Alike alike_{};
  std::vector<SetRoom> sets_;
  Buffer<std::int32_t> moves_, targets_;
  Buffer<std::uint32_t> cells_;
  // On the host.
  std::vector<std::int32_t> counted_, to_;
  std::vector<std::uint32_t> halves_;
};

}  // namespace dreampm::gpu

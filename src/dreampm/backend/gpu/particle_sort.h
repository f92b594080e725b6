// The sort of a World whose particles and nodes lie in a device's memory, as Regroup: the same
// order bit for bit.
#pragma once
#include <vector>

#include "dreampm/backend/gpu/set_memory.h"
#include "dreampm/state/grid_topology.h"
#include "dreampm/state/regroup_plan.h"

namespace dreampm::gpu {

class ParticleSort {
 public:
  explicit ParticleSort(Device& device);
  /// True if a device can sort this world: the host does where sinks take matter, or particles
  /// carry their motion.
  static bool takes(const World<float>& world);
  /// Nodes and particles have to be current in `memory`, and are afterwards. The World gets the
  /// lists of blocks, and its arrays their sizes.
  void operator()(World<float>& world, Memory& memory);

 private:
  struct SetRoom {
    explicit SetRoom(Device& device) : counts(device), number(device), start(device), from(device) {}
    Buffer<std::int32_t> counts, number;
    Buffer<std::uint32_t> start, from;
  };
  SortInput input(const SetMemory& set) const;
  void count_moves(World<float>& world, Memory& memory);
  void find_targets();
  void find_cells(World<float>& world, Memory& memory);
  void move(World<float>& world, std::size_t set, SetMemory& memory);
  void carry_nodes(World<float>& world, Memory& memory);

  Device* device_;
  RegroupPlan<float> plan_;
  GridTopology<float> topology_;
  Alike alike_{};
  std::vector<SetRoom> sets_;
  Buffer<std::int32_t> moves_, targets_, before_;
  Buffer<std::uint32_t> cells_;
  Buffer<Node<float>> carried_;
  // On the host.
  std::vector<std::int32_t> counted_, to_, before_home_;
  std::vector<std::uint32_t> halves_;
  std::vector<std::uint64_t> occupied_;
};

}  // namespace dreampm::gpu

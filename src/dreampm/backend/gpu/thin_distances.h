// Distances of particles from colliders that are too thin for the splines between the nodes: the
// host measures them, of the particles near such places.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "dreampm/backend/common.h"
#include "dreampm/backend/gpu/launch.h"
#include "dreampm/backend/gpu/set_memory.h"

namespace dreampm::gpu {

class ThinDistances {
 public:
  explicit ThinDistances(Device& device) : device_(&device), blocks_(device), places_(device), distances_(device) {}
  /// Must be called after every change of the block lists, of the particles' order, or of
  /// colliders. `reached`: by block of particles.
  void prepare(const World<float>& world, Memory& memory, const Obstacles& obstacles,
               const std::vector<StencilBlocks>& reached);
  /// The particles have moved.
  void outdate() { measured_ = false; }
  /// Makes SetMemory::distance current, if any is asked for.
  void measure(const World<float>& world, Memory& memory, const Obstacles& obstacles,
               const std::vector<StencilBlocks>& reached);
  /// True if any particle may be near such a place; else SetMemory::distance is not to be read.
  bool any() const { return !near_.empty(); }

 private:
  Device* device_;
  bool measured_ = false;
  std::vector<std::uint32_t> near_;  ///< blocks of particles
  /// By set: where the particles of each of these begin among them all, and the end.
  std::vector<std::vector<std::uint32_t>> starts_home_;
  Buffer<std::uint32_t> blocks_;
  std::vector<Buffer<std::uint32_t>> starts_;
  Buffer<Vec3<float>> places_;
  Buffer<Node<float>> distances_;
  std::vector<Vec3<float>> places_home_;
  std::vector<Node<float>> distances_home_;
};

}  // namespace dreampm::gpu

// The way of what lies in some blocks from a device's memory to the World, and back.
#pragma once
#include <cstdint>
#include <vector>

#include "dreampm/backend/gpu/set_memory.h"

namespace dreampm::gpu {

/// Brings home the positions of the particles of some blocks: what the World's arrays have of
/// others is left alone.
class SomePlaces {
 public:
  explicit SomePlaces(Device& device) : device_(&device), blocks_(device), starts_(device), copies_(device) {}
  /// `blocks`: of particles, rising. `memory`: particles are current there.
  void download(World<float>& world, Memory& memory, const std::vector<std::uint32_t>& blocks);

 private:
  Device* device_;
  Buffer<std::uint32_t> blocks_, starts_;
  Buffer<Vec3<float>> copies_;
  std::vector<std::uint32_t> starts_home_;
  std::vector<Vec3<float>> home_;
};

/// Brings the nodes of some blocks of the grid home, and what became of them back.
class SomeNodes {
 public:
  explicit SomeNodes(Device& device) : device_(&device), blocks_(device), copies_(device) {}
  /// Room for the nodes of all blocks of a field, or fewer, that nothing lasting lies in.
  Buffer<Node<float>>& spare() { return copies_; }
  /// The blocks of all calls that follow.
  void choose(std::vector<std::uint32_t> blocks);
  void download(World<float>& world, Memory& memory, std::size_t target);
  void upload(World<float>& world, Memory& memory, std::size_t target);

 private:
  /// Calls one(nodes in the World, copies of them) for every block.
  template <class Body>
  void each_block(World<float>& world, std::size_t target, const Body& one);

  Device* device_;
  std::vector<std::uint32_t> chosen_;
  Buffer<std::uint32_t> blocks_;
  Buffer<Node<float>> copies_;
  std::vector<Node<float>> home_;
};

}  // namespace dreampm::gpu

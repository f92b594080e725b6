// Arrays of particles in a device's memory that leave it: for programs that go on there.
#pragma once
#include <memory>

#include "dreampm/backend/gpu/set_memory.h"
#include "dreampm/particles.h"

namespace dreampm::gpu {

class ParticleArrays {
 public:
  /// The arrays keep the device.
  explicit ParticleArrays(std::shared_ptr<Device> device) : device_(std::move(device)), blocks_(*device_) {}
  /// Copies what `fields` name of a set, whose particles are current in `memory`. Velocities are
  /// those of `motion`, or, where that is null, of the last pass that kept them in `memory`. Throws
  /// std::logic_error where there are not as many velocities as particles.
  DeviceParticles operator()(const World<float>& world, std::size_t set, const SetMemory& memory,
                             const Motion<float>* motion, const ParticleFields& fields);

 private:
  std::shared_ptr<Device> device_;
  Buffer<Vec3i> blocks_;  ///< of particles
};

}  // namespace dreampm::gpu

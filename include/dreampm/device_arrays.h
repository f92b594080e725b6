// Particles as arrays in the memory of a device, for programs that go on there.
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>

namespace dreampm {

/// The kinds of memory, by their numbers in DLPack.
enum class DeviceKind : std::int32_t { host = 1, cuda = 2 };

/// A device: its kind, and its number among those of that kind, from 0.
struct DeviceId {
  DeviceKind kind = DeviceKind::host;
  std::int32_t number = 0;
  friend bool operator==(const DeviceId&, const DeviceId&) = default;
};

/// An array in the memory of a device. It never changes, and is there as long as a reference to it
/// is, even where the simulation is not. Its methods may be called by any thread.
class DeviceArray {
 public:
  virtual ~DeviceArray() = default;
  virtual DeviceId device() const = 0;
  /// Returns its address there; null of an array without entries.
  virtual const void* data() const = 0;
  virtual std::size_t bytes() const = 0;
  /// Makes a stream of the device wait until the array is filled; returns at once. `stream`: 1 the
  /// legacy default stream, 2 the default stream of the calling thread, else a cudaStream_t.
  /// Memory of the host has no streams, and is filled.
  virtual void make_wait(std::uintptr_t stream) const = 0;
  /// Copies all of it to the host. Throws RunError where the device fails.
  virtual void download(void* to) const = 0;
  /// Copies it on the device. Throws RunError where there is no room.
  virtual std::shared_ptr<const DeviceArray> copy() const = 0;
};

/// Particles of one material as they were when they were asked for, in the order in which they lay
/// in memory: all arrays are in that order, and `id` says which particle is which. Null where an
/// array was not asked for.
struct DeviceParticles {
  std::size_t count = 0;
  std::shared_ptr<const DeviceArray> position;  ///< float, 3 a particle [m]
  std::shared_ptr<const DeviceArray> velocity;  ///< float, 3 a particle [m/s], as in ParticleView
  std::shared_ptr<const DeviceArray> id;        ///< std::uint32_t, as in ParticleView

  std::size_t size() const { return count; }
};

}  // namespace dreampm

// A device: memory of its own, and kernels that work there.
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "dreampm/device_arrays.h"

namespace dreampm::gpu {

/// Calls come from one thread, and take effect in their order. Those that arrays which outlive a
/// simulation make may come from any: allocate, release, copy, download, make_wait.
class Device {
 public:
  virtual ~Device() = default;
  /// A line: its name, its memory and its architecture.
  virtual std::string about() const = 0;
  /// The kind of device and compiler that decide the bits.
  virtual std::string isa() const = 0;
  /// Which it is, for other programs.
  virtual DeviceId id() const = 0;
  /// Bytes of memory that are free, and of all.
  struct Memory {
    std::size_t free, all;
  };
  virtual Memory memory() const = 0;
  /// Throws RunError where there is no room, with what there is.
  virtual void* allocate(std::size_t bytes) = 0;
  virtual void release(void* memory) noexcept = 0;
  virtual void upload(void* to, const void* from, std::size_t bytes) = 0;
  /// Waits for the kernels launched before.
  virtual void download(void* to, const void* from, std::size_t bytes) = 0;
  /// Within its memory.
  virtual void copy(void* to, const void* from, std::size_t bytes) = 0;
  /// Makes a stream of another program wait for all that was asked for before, as
  /// DeviceArray::make_wait.
  virtual void make_wait(std::uintptr_t stream) = 0;
  /// Launches kernel `number` of the list with that many blocks of threads. `arguments`: the kernel
  /// itself. Throws RunError where an earlier one failed.
  virtual void launch(int number, const void* arguments, int blocks) = 0;
  /// Bytes that all Buffers have of it.
  std::size_t held() const { return held_; }

 private:
  template <class T>
  friend class Buffer;
  std::size_t held_ = 0;
};

/// An array in a device's memory. It grows, and keeps its room.
template <class T>
class Buffer {
 public:
  explicit Buffer(Device& device) : device_(&device) {}
  ~Buffer() { drop(); }
  Buffer(Buffer&& b) noexcept
      : device_(b.device_),
        data_(std::exchange(b.data_, nullptr)),
        room_(std::exchange(b.room_, 0)),
        size_(std::exchange(b.size_, 0)) {}
  Buffer& operator=(Buffer&& b) noexcept {
    std::swap(device_, b.device_), std::swap(data_, b.data_), std::swap(room_, b.room_), std::swap(size_, b.size_);
    return *this;
  }

  /// Contents are undefined after it, where it grows.
  void resize(std::size_t size) {
    if (size > room_) {
      drop();
      const std::size_t wanted = size + size / 8;
      data_ = static_cast<T*>(device_->allocate(wanted * sizeof(T)));
      room_ = wanted;
      device_->held_ += room_ * sizeof(T);
    }
    size_ = size;
  }
  std::size_t size() const { return size_; }
  T* data() const { return size_ == 0 ? nullptr : data_; }
  template <class Array>
  void upload(const Array& from) {
    static_assert(sizeof(*from.data()) == sizeof(T));
    resize(from.size());
    if (size_ > 0) device_->upload(data_, from.data(), size_ * sizeof(T));
  }
  /// `to`: as long as this, else it throws std::logic_error: who asks has another world.
  template <class Array>
  void download(Array& to) const {
    static_assert(sizeof(*to.data()) == sizeof(T));
    if (to.size() != size_) throw std::logic_error("an array of a World is not as long as that of the device");
    if (size_ > 0) device_->download(to.data(), data_, size_ * sizeof(T));
  }

 private:
  void drop() {
    device_->held_ -= room_ * sizeof(T);
    device_->release(std::exchange(data_, nullptr));
    room_ = size_ = 0;
  }

  Device* device_;
  T* data_ = nullptr;
  std::size_t room_ = 0, size_ = 0;
};

}  // namespace dreampm::gpu

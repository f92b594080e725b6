// A device that counts.
#pragma once
#include <cstddef>
#include <map>
#include <memory>
#include <new>
#include <string>
#include <utility>

#include "dreampm/backend/gpu/device.h"

namespace dreampm::gpu_test {

/// Counts what is asked of a device, whose memory may be small.
class Counting final : public gpu::Device {
 public:
  explicit Counting(std::unique_ptr<gpu::Device> device) : device_(std::move(device)) {}
  std::string about() const override { return device_->about(); }
  std::string isa() const override { return device_->isa(); }
  DeviceId id() const override { return device_->id(); }
  Memory memory() const override { return {limit - taken, limit}; }
  void* allocate(std::size_t bytes) override {
    if (taken + bytes > limit) throw std::bad_alloc();
    void* const memory = device_->allocate(bytes);
    ++allocations, taken += sizes_[memory] = bytes;
    return memory;
  }
  void release(void* memory) noexcept override {
    taken -= sizes_[memory], sizes_.erase(memory);
    device_->release(memory);
  }
  void upload(void* to, const void* from, std::size_t bytes) override {
    uploaded += bytes, device_->upload(to, from, bytes);
  }
  void download(void* to, const void* from, std::size_t bytes) override {
    downloaded += bytes, ++downloads, device_->download(to, from, bytes);
  }
  void copy(void* to, const void* from, std::size_t bytes) override { device_->copy(to, from, bytes); }
  void make_wait(std::uintptr_t stream) override { device_->make_wait(stream); }
  void launch(int number, const void* arguments, int blocks) override {
    ++launches, device_->launch(number, arguments, blocks);
  }
  void clear() { uploaded = downloaded = 0, downloads = launches = allocations = 0; }
  std::size_t uploaded = 0, downloaded = 0, taken = 0;
  std::size_t limit = std::size_t{1} << 60;  ///< bytes
  int downloads = 0, launches = 0, allocations = 0;

 private:
  std::unique_ptr<gpu::Device> device_;
  std::map<void*, std::size_t> sizes_;
};

}  // namespace dreampm::gpu_test

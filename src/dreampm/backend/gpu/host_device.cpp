#include "dreampm/backend/gpu/host_device.h"

#include <cstdlib>
#include <cstring>
#include <limits>
#include <new>

#include "dreampm/backend/gpu/kernels.h"
#include "dreampm/base/parallel.h"

namespace dreampm::gpu {
namespace {

using Launch = void (*)(const void* arguments, int blocks, ThreadOrder order);

template <class K>
void launch_on_host(const void* arguments, int blocks, ThreadOrder order) {
  const K& kernel = *static_cast<const K*>(arguments);
  parallel_for(static_cast<std::size_t>(blocks), 4, [&](std::size_t i) {
    HostBlock<K::threads> block(place_in_order(order, static_cast<int>(i), blocks), order);
    // As on a device nothing is known of it: a kernel that reads what it did not write shows it.
    alignas(64) std::byte memory[sizeof(typename K::Shared)];
    std::memset(memory, 0xff, sizeof memory);
    kernel(block, *reinterpret_cast<typename K::Shared*>(memory));
  });
}

struct LaunchTable {
  Launch of[Kernels::size];
  constexpr LaunchTable() : of{} {
    int n = 0;
    Kernels::for_each([&]<class K>() { of[n++] = &launch_on_host<K>; });
  }
};
constexpr LaunchTable launches;

class HostDevice final : public Device {
 public:
  explicit HostDevice(ThreadOrder order) : order_(order) {}
  std::string about() const override { return "this machine, thread after thread"; }
  std::string isa() const override { return "host"; }
  DeviceId id() const override { return {DeviceKind::host, 0}; }
  Memory memory() const override {
    constexpr std::size_t much = std::numeric_limits<std::size_t>::max() / 2;
    return {much, much};
  }
  void* allocate(std::size_t bytes) override {
    void* const memory = std::malloc(bytes);
    if (!memory) throw std::bad_alloc();
    std::memset(memory, 0xff, bytes);
    return memory;
  }
  void release(void* memory) noexcept override { std::free(memory); }
  void upload(void* to, const void* from, std::size_t bytes) override { std::memcpy(to, from, bytes); }
  void download(void* to, const void* from, std::size_t bytes) override { std::memcpy(to, from, bytes); }
  void copy(void* to, const void* from, std::size_t bytes) override { std::memcpy(to, from, bytes); }
  void make_wait(std::uintptr_t) override {}
  void launch(int number, const void* arguments, int blocks) override {
    launches.of[number](arguments, blocks, order_);
  }

 private:
  ThreadOrder order_;
};

}  // namespace

std::unique_ptr<Device> make_host_device(ThreadOrder order) { return std::make_unique<HostDevice>(order); }

}  // namespace dreampm::gpu

// A library that stands in for libdreampm_cuda.so where there is no card: the same functions over
// the host's memory and threads.
#include <atomic>
#include <cstdlib>
#include <limits>
#include <string>

#include "dreampm/backend/gpu/cuda/cuda_library.h"
#include "dreampm/backend/gpu/cuda/kernel_sources.h"
#include "dreampm/backend/gpu/host_device.h"
#include "dreampm/backend/gpu/kernels.h"

namespace dreampm::gpu {
namespace {

// Numbers of devices that behave badly, and of one that says it has CUDA's memory, which other
// programs cannot tell from a card until they touch it.
constexpr int full = 1, failing = 2, small = 3, seems_cuda = 4;
struct Opened {
  std::unique_ptr<Device> host;
  int number;
};
/// The streams that waited for a device so far; of the last one its number.
std::atomic<unsigned long long> waits{0}, last_stream{0};
/// Pieces of memory that are allocated now.
std::atomic<long long> allocated{0};
Opened& opened(void* device) { return *static_cast<Opened*>(device); }

const char* open(int number, void** device) {
  // Tests choose it where the command asks for the first.
  if (const char* const chosen = std::getenv("DREAMPM_STAND_IN")) number = std::atoi(chosen);
  if (number > seems_cuda) return "there is no device of that number";
  *device = new Opened{make_host_device(), number};
  return nullptr;
}
void close(void* device) { delete &opened(device); }
const char* about(void*, const char** name, int* major, int* minor, std::size_t* memory) {
  *name = "Stand-in", *major = 9, *minor = 0, *memory = std::size_t{1} << 30;
  return nullptr;
}
void id(void* device, int* kind, int* number) {
  const bool cuda = opened(device).number == seems_cuda;
  *kind = static_cast<int>(cuda ? DeviceKind::cuda : DeviceKind::host), *number = cuda ? opened(device).number : 0;
}
const char* memory(void* device, std::size_t* free, std::size_t* all) {
  *free = std::size_t{1} << (opened(device).number == small ? 14 : 29), *all = std::size_t{1} << 30;
  return nullptr;
}
const char* allocate(void* device, std::size_t bytes, void** memory) {
  if (opened(device).number == full) return "out of memory";
  *memory = opened(device).host->allocate(bytes);
  ++allocated;
  return nullptr;
}
void release(void* device, void* memory) {
  opened(device).host->release(memory);
  --allocated;
}
const char* upload(void* device, void* to, const void* from, std::size_t bytes) {
  opened(device).host->upload(to, from, bytes);
  return nullptr;
}
const char* download(void* device, void* to, const void* from, std::size_t bytes) {
  opened(device).host->download(to, from, bytes);
  return nullptr;
}
const char* copy(void* device, void* to, const void* from, std::size_t bytes) {
  opened(device).host->copy(to, from, bytes);
  return nullptr;
}
const char* make_wait(void*, unsigned long long stream) {
  ++waits, last_stream = stream;
  return nullptr;
}
const char* launch(void* device, int kernel, const void* arguments, int blocks) {
  if (opened(device).number == failing) return "an illegal memory access was encountered";
  opened(device).host->launch(kernel, arguments, blocks);
  return nullptr;
}

constexpr CudaLibrary library{STAND_IN_VERSION,
                              Kernels::fingerprint(),
                              STAND_IN_SOURCES,
                              open,
                              close,
                              about,
                              id,
                              memory,
                              allocate,
                              release,
                              upload,
                              download,
                              copy,
                              make_wait,
                              launch};

}  // namespace
}  // namespace dreampm::gpu

extern "C" const dreampm::gpu::CudaLibrary* dreampm_cuda_library() { return &dreampm::gpu::library; }
// What tests ask it besides.
extern "C" unsigned long long stand_in_waits() { return dreampm::gpu::waits; }
extern "C" unsigned long long stand_in_last_stream() { return dreampm::gpu::last_stream; }
extern "C" long long stand_in_allocated() { return dreampm::gpu::allocated; }

// A library that stands in for libdreampm_cuda.so where there is no card: the same functions over
// the host's memory and threads.
#include <cstdlib>
#include <limits>
#include <string>

#include "dreampm/backend/gpu/cuda/cuda_library.h"
#include "dreampm/backend/gpu/cuda/kernel_sources.h"
#include "dreampm/backend/gpu/host_device.h"
#include "dreampm/backend/gpu/kernels.h"

namespace dreampm::gpu {
namespace {

// Numbers of devices that behave badly.
constexpr int full = 1, failing = 2, small = 3;
struct Opened {
  std::unique_ptr<Device> host;
  int number;
};
Opened& opened(void* device) { return *static_cast<Opened*>(device); }

const char* open(int number, void** device) {
  // Tests choose it where the command asks for the first.
  if (const char* const chosen = std::getenv("DREAMPM_STAND_IN")) number = std::atoi(chosen);
  if (number > small) return "there is no device of that number";
  *device = new Opened{make_host_device(), number};
  return nullptr;
}
void close(void* device) { delete &opened(device); }
const char* about(void*, const char** name, int* major, int* minor, std::size_t* memory) {
  *name = "Stand-in", *major = 9, *minor = 0, *memory = std::size_t{1} << 30;
  return nullptr;
}
const char* memory(void* device, std::size_t* free, std::size_t* all) {
  *free = std::size_t{1} << (opened(device).number == small ? 14 : 29), *all = std::size_t{1} << 30;
  return nullptr;
}
const char* allocate(void* device, std::size_t bytes, void** memory) {
  if (opened(device).number == full) return "out of memory";
  *memory = opened(device).host->allocate(bytes);
  return nullptr;
}
void release(void* device, void* memory) { opened(device).host->release(memory); }
const char* upload(void* device, void* to, const void* from, std::size_t bytes) {
  opened(device).host->upload(to, from, bytes);
  return nullptr;
}
const char* download(void* device, void* to, const void* from, std::size_t bytes) {
  opened(device).host->download(to, from, bytes);
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
                              memory,
                              allocate,
                              release,
                              upload,
                              download,
                              launch};

}  // namespace
}  // namespace dreampm::gpu

extern "C" const dreampm::gpu::CudaLibrary* dreampm_cuda_library() { return &dreampm::gpu::library; }

// libdreampm_cuda.so: the kernels of gpu/kernels.h, and the calls of the CUDA runtime that gpu/device.h asks for. Built by
// tools/build_cuda.
#include "dreampm/backend/gpu/cuda/cuda_library.h"
#include "dreampm/backend/gpu/cuda/kernel_sources.h"

#include <cuda_runtime.h>

#include "dreampm/backend/gpu/device_block.h"
#include "dreampm/backend/gpu/kernels.h"

namespace dreampm::gpu {
namespace {

using Launch = void (*)(const void* arguments, int blocks, cudaStream_t stream);

template <class K>
void launch_kernel(const void* arguments, int blocks, cudaStream_t stream) {
  run<K><<<blocks, K::threads, 0, stream>>>(*static_cast<const K*>(arguments));
}

template <class... K>
const Launch* launches_of(KernelList<K...>) {
  static constexpr Launch all[] = {&launch_kernel<K>...};
  return all;
}

/// The library holds machine code and PTX for this and what came after.
constexpr int least_capability = 8;

struct Opened {
  int number;
  cudaStream_t stream;
  cudaDeviceProp facts;
};
Opened& opened(void* device) { return *static_cast<Opened*>(device); }

/// Errors stay until they are asked for; the next call should not meet one that was told.
const char* message(cudaError_t error) {
  if (error == cudaSuccess) return nullptr;
  cudaGetLastError();
  return cudaGetErrorString(error);
}
/// The current device is each thread's own.
cudaError_t use(void* device) { return cudaSetDevice(opened(device).number); }

const char* open(int number, void** device) {
  int count = 0;
  if (const cudaError_t error = cudaGetDeviceCount(&count)) return message(error);
  if (number < 0 || number >= count) return "there is no device of that number";
  Opened one{number, nullptr, {}};
  if (const cudaError_t error = cudaGetDeviceProperties(&one.facts, number)) return message(error);
  if (one.facts.major < least_capability) return "its compute capability is below 8.0";
  if (const cudaError_t error = cudaSetDevice(number)) return message(error);
  if (const cudaError_t error = cudaStreamCreateWithFlags(&one.stream, cudaStreamNonBlocking)) return message(error);
  *device = new Opened(one);
  return nullptr;
}
void close(void* device) {
  cudaStreamDestroy(opened(device).stream);
  delete &opened(device);
}
const char* about(void* device, const char** name, int* major, int* minor, std::size_t* memory) {
  const cudaDeviceProp& facts = opened(device).facts;
  *name = facts.name, *major = facts.major, *minor = facts.minor, *memory = facts.totalGlobalMem;
  return nullptr;
}
const char* memory(void* device, std::size_t* free, std::size_t* all) {
  if (const cudaError_t error = use(device)) return message(error);
  return message(cudaMemGetInfo(free, all));
}
const char* allocate(void* device, std::size_t bytes, void** memory) {
  if (const cudaError_t error = use(device)) return message(error);
  return message(cudaMalloc(memory, bytes));
}
void release(void* device, void* memory) {
  use(device);
  cudaFree(memory);
}
/// Waits, as the host's memory may be gone after it.
const char* upload(void* device, void* to, const void* from, std::size_t bytes) {
  const cudaStream_t stream = opened(device).stream;
  if (const cudaError_t error = use(device)) return message(error);
  if (const cudaError_t error = cudaMemcpyAsync(to, from, bytes, cudaMemcpyHostToDevice, stream)) return message(error);
  return message(cudaStreamSynchronize(stream));
}
const char* download(void* device, void* to, const void* from, std::size_t bytes) {
  const cudaStream_t stream = opened(device).stream;
  if (const cudaError_t error = use(device)) return message(error);
  if (const cudaError_t error = cudaMemcpyAsync(to, from, bytes, cudaMemcpyDeviceToHost, stream)) return message(error);
  return message(cudaStreamSynchronize(stream));
}
const char* launch(void* device, int kernel, const void* arguments, int blocks) {
  if (const cudaError_t error = use(device)) return message(error);
  launches_of(Kernels{})[kernel](arguments, blocks, opened(device).stream);
  return message(cudaGetLastError());
}

constexpr CudaLibrary library{DM_VERSION, Kernels::fingerprint(), kernel_sources, open,   close,    about,
                              memory,     allocate,               release,        upload, download, launch};

}  // namespace
}  // namespace dreampm::gpu

extern "C" __attribute__((visibility("default"))) const dreampm::gpu::CudaLibrary* dreampm_cuda_library() {
  return &dreampm::gpu::library;
}

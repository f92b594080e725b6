// libdreampm_cuda.so: the kernels of gpu/kernels.h, and the calls of the CUDA runtime that gpu/device.h asks for. Built by
// tools/build_cuda.
#include "dreampm/backend/gpu/cuda/cuda_library.h"
#include "dreampm/backend/gpu/cuda/kernel_sources.h"

#include <cuda_runtime.h>

#include "dreampm/backend/gpu/device_block.h"
#include "dreampm/backend/gpu/kernels.h"
#include "dreampm/device_arrays.h"

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
/// The device of calls while this lives. The current one is each thread's own, and other programs of
/// the process have theirs: they find it again afterwards.
class Current {
 public:
  explicit Current(int number) {
    error_ = cudaGetDevice(&before_);
    if (error_ != cudaSuccess || before_ == number) return;
    error_ = cudaSetDevice(number);
    changed_ = error_ == cudaSuccess;
  }
  explicit Current(void* device) : Current(opened(device).number) {}
  Current(const Current&) = delete;
  Current& operator=(const Current&) = delete;
  ~Current() {
    if (changed_) cudaSetDevice(before_);
  }
  cudaError_t error() const { return error_; }

 private:
  int before_ = 0;
  bool changed_ = false;
  cudaError_t error_;
};

const char* open(int number, void** device) {
  int count = 0;
  if (const cudaError_t error = cudaGetDeviceCount(&count)) return message(error);
  if (number < 0 || number >= count) return "there is no device of that number";
  Opened one{number, nullptr, {}};
  if (const cudaError_t error = cudaGetDeviceProperties(&one.facts, number)) return message(error);
  if (one.facts.major < least_capability) return "its compute capability is below 8.0";
  const Current current(number);
  if (const cudaError_t error = current.error()) return message(error);
  if (const cudaError_t error = cudaStreamCreateWithFlags(&one.stream, cudaStreamNonBlocking)) return message(error);
  *device = new Opened(one);
  return nullptr;
}
void close(void* device) {
  const Current current(device);
  cudaStreamDestroy(opened(device).stream);
  delete &opened(device);
}
const char* about(void* device, const char** name, int* major, int* minor, std::size_t* memory) {
  const cudaDeviceProp& facts = opened(device).facts;
  *name = facts.name, *major = facts.major, *minor = facts.minor, *memory = facts.totalGlobalMem;
  return nullptr;
}
void id(void* device, int* kind, int* number) {
  *kind = static_cast<int>(DeviceKind::cuda), *number = opened(device).number;
}
const char* memory(void* device, std::size_t* free, std::size_t* all) {
  const Current current(device);
  if (const cudaError_t error = current.error()) return message(error);
  return message(cudaMemGetInfo(free, all));
}
const char* allocate(void* device, std::size_t bytes, void** memory) {
  const Current current(device);
  if (const cudaError_t error = current.error()) return message(error);
  return message(cudaMalloc(memory, bytes));
}
void release(void* device, void* memory) {
  const Current current(device);
  cudaFree(memory);
}
/// Waits, as the host's memory may be gone after it.
const char* upload(void* device, void* to, const void* from, std::size_t bytes) {
  const cudaStream_t stream = opened(device).stream;
  const Current current(device);
  if (const cudaError_t error = current.error()) return message(error);
  if (const cudaError_t error = cudaMemcpyAsync(to, from, bytes, cudaMemcpyHostToDevice, stream)) return message(error);
  return message(cudaStreamSynchronize(stream));
}
const char* download(void* device, void* to, const void* from, std::size_t bytes) {
  const cudaStream_t stream = opened(device).stream;
  const Current current(device);
  if (const cudaError_t error = current.error()) return message(error);
  if (const cudaError_t error = cudaMemcpyAsync(to, from, bytes, cudaMemcpyDeviceToHost, stream)) return message(error);
  return message(cudaStreamSynchronize(stream));
}
const char* copy(void* device, void* to, const void* from, std::size_t bytes) {
  const Current current(device);
  if (const cudaError_t error = current.error()) return message(error);
  return message(cudaMemcpyAsync(to, from, bytes, cudaMemcpyDeviceToDevice, opened(device).stream));
}
/// CUDA's own numbers of the two default streams are 1 and 2, too.
const char* make_wait(void* device, unsigned long long stream) {
  const Current current(device);
  if (const cudaError_t error = current.error()) return message(error);
  cudaEvent_t done;
  if (const cudaError_t error = cudaEventCreateWithFlags(&done, cudaEventDisableTiming)) return message(error);
  cudaError_t error = cudaEventRecord(done, opened(device).stream);
  if (error == cudaSuccess) error = cudaStreamWaitEvent(reinterpret_cast<cudaStream_t>(stream), done, 0);
  cudaEventDestroy(done);  // once it has happened
  return message(error);
}
const char* launch(void* device, int kernel, const void* arguments, int blocks) {
  const Current current(device);
  if (const cudaError_t error = current.error()) return message(error);
  launches_of(Kernels{})[kernel](arguments, blocks, opened(device).stream);
  return message(cudaGetLastError());
}

constexpr CudaLibrary library{DM_VERSION, Kernels::fingerprint(), kernel_sources, open,     close, about,     id,
                              memory,     allocate,               release,        upload,   download, copy, make_wait, launch};

}  // namespace
}  // namespace dreampm::gpu

extern "C" __attribute__((visibility("default"))) const dreampm::gpu::CudaLibrary* dreampm_cuda_library() {
  return &dreampm::gpu::library;
}

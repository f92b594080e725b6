// The border between DreaMPM and libdreampm_cuda.so, which holds the kernels and the CUDA runtime:
// plain functions, so that the two need not come from one compiler. The library is loaded at run
// time; without it, or without a driver, there is no device, and nothing else changes.
#pragma once
#include <cstddef>

namespace dreampm::gpu {

/// The functions of the library. Those that may fail return null, or what went wrong, in memory
/// that stays until the next call.
struct CudaLibrary {
  const char* version;         ///< of DreaMPM, which has to be the same
  unsigned long long kernels;  ///< fingerprint of the list in gpu/kernels.h, which has to be the same
  unsigned long long sources;  ///< hash of what the kernels are made of (cmake/KernelSources.cmake): the same too
  const char* (*open)(int number, void** device);
  void (*close)(void* device);
  /// Name, compute capability and memory in bytes.
  const char* (*about)(void* device, const char** name, int* major, int* minor, std::size_t* memory);
  /// Kind and number, as DeviceId.
  void (*id)(void* device, int* kind, int* number);
  const char* (*memory)(void* device, std::size_t* free, std::size_t* all);
  const char* (*allocate)(void* device, std::size_t bytes, void** memory);
  void (*release)(void* device, void* memory);
  const char* (*upload)(void* device, void* to, const void* from, std::size_t bytes);
  const char* (*download)(void* device, void* to, const void* from, std::size_t bytes);
  const char* (*copy)(void* device, void* to, const void* from, std::size_t bytes);
  /// As Device::make_wait.
  const char* (*make_wait)(void* device, unsigned long long stream);
  const char* (*launch)(void* device, int kernel, const void* arguments, int blocks);
};

/// The name of the function of the library that returns its CudaLibrary, and its type.
inline constexpr const char* cuda_library_entry = "dreampm_cuda_library";
using CudaLibraryEntry = const CudaLibrary* (*)();

}  // namespace dreampm::gpu

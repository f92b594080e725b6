// A block of threads on a device. Read by compilers of device code alone: nvcc, and clang for CUDA
// and for HIP, which need no headers of a toolkit for it.
#pragma once
#include <cstdint>

#include "dreampm/math/scalar.h"

#ifdef __clang__
#define DM_KERNEL __attribute__((global))
#define DM_SHARED __attribute__((shared))
#define DM_DEVICE __attribute__((device)) __attribute__((always_inline)) inline
#ifdef __HIP__
#define DM_BOUNDS(threads, blocks) __attribute__((amdgpu_flat_work_group_size(threads, threads)))
#else
#define DM_BOUNDS(threads, blocks) __attribute__((launch_bounds(threads, blocks)))
#endif
#else
#define DM_KERNEL __global__
#define DM_SHARED __shared__
#define DM_DEVICE __device__ __forceinline__
#define DM_BOUNDS(threads, blocks) __launch_bounds__(threads, blocks)
#endif

namespace dreampm::gpu {

// What the compilers name differently.
#if defined(__HIP__)
DM_DEVICE int thread_number() { return static_cast<int>(__builtin_amdgcn_workitem_id_x()); }
DM_DEVICE int block_number() { return static_cast<int>(__builtin_amdgcn_workgroup_id_x()); }
DM_DEVICE void wait_for_all() {
  __builtin_amdgcn_fence(__ATOMIC_RELEASE, "workgroup");
  __builtin_amdgcn_s_barrier();
  __builtin_amdgcn_fence(__ATOMIC_ACQUIRE, "workgroup");
}
DM_DEVICE void add_to_shared(std::int32_t& to, std::int32_t value) { __atomic_fetch_add(&to, value, __ATOMIC_RELAXED); }
DM_DEVICE std::int32_t count_in_memory(std::int32_t& counter) {
  return __atomic_fetch_add(&counter, 1, __ATOMIC_RELAXED);
}
DM_DEVICE void lower_in_memory(std::int32_t& to, std::int32_t value) {
  __atomic_fetch_min(&to, value, __ATOMIC_RELAXED);
}
DM_DEVICE std::int32_t to_nearest(float value) {
  if (!(value == value)) return 0;
  // The largest and the least float within the range.
  return static_cast<std::int32_t>(__builtin_rintf(min(max(value, -2147483648.0f), 2147483520.0f)));
}
#elif defined(__clang__)
DM_DEVICE int thread_number() { return __nvvm_read_ptx_sreg_tid_x(); }
DM_DEVICE int block_number() { return __nvvm_read_ptx_sreg_ctaid_x(); }
DM_DEVICE void wait_for_all() { __syncthreads(); }
DM_DEVICE void add_to_shared(std::int32_t& to, std::int32_t value) { __atomic_fetch_add(&to, value, __ATOMIC_RELAXED); }
DM_DEVICE std::int32_t count_in_memory(std::int32_t& counter) {
  return __atomic_fetch_add(&counter, 1, __ATOMIC_RELAXED);
}
DM_DEVICE void lower_in_memory(std::int32_t& to, std::int32_t value) {
  __atomic_fetch_min(&to, value, __ATOMIC_RELAXED);
}
DM_DEVICE std::int32_t to_nearest(float value) { return __nvvm_f2i_rn(value); }
#else
DM_DEVICE int thread_number() { return static_cast<int>(threadIdx.x); }
DM_DEVICE int block_number() { return static_cast<int>(blockIdx.x); }
DM_DEVICE void wait_for_all() { __syncthreads(); }
DM_DEVICE void add_to_shared(std::int32_t& to, std::int32_t value) { atomicAdd(&to, value); }
DM_DEVICE std::int32_t count_in_memory(std::int32_t& counter) { return atomicAdd(&counter, 1); }
DM_DEVICE void lower_in_memory(std::int32_t& to, std::int32_t value) { atomicMin(&to, value); }
DM_DEVICE std::int32_t to_nearest(float value) { return __float2int_rn(value); }
#endif

/// As HostBlock.
class DeviceBlock {
 public:
  DM_DEVICE int index() const { return block_number(); }
  template <class Body>
  DM_DEVICE void each_thread(const Body& body) const {
    body(thread_number());
    wait_for_all();
  }
  template <class T>
  class PerThread {
   public:
    DM_DEVICE T& operator[](int) { return own_; }

   private:
    T own_{};
  };
  static DM_DEVICE void add(std::int32_t& to, std::int32_t value) { add_to_shared(to, value); }
  static DM_DEVICE std::int32_t count(std::int32_t& counter) { return count_in_memory(counter); }
  static DM_DEVICE void lower(std::int32_t& to, std::int32_t value) { lower_in_memory(to, value); }
  static DM_DEVICE std::int32_t nearest(float value) { return to_nearest(value); }
};

/// How many blocks of a kernel a multiprocessor should hold, which bounds their registers.
template <class K>
constexpr int resident_blocks() {
  if constexpr (requires { K::resident; })
    return K::resident;
  else
    return 1;
}

/// The entry of a kernel.
template <class K>
DM_KERNEL void DM_BOUNDS(K::threads, resident_blocks<K>()) run(const K kernel) {
  DM_SHARED typename K::Shared shared;
  DeviceBlock block;
  kernel(block, shared);
}

}  // namespace dreampm::gpu

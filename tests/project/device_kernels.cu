// The kernels of the gpu backends as device code: all of gpu/kernels.h. Compiled by tools/check_device; it runs nowhere.
#include "dreampm/backend/gpu/kernels.h"

#include "dreampm/backend/gpu/device_block.h"

namespace dreampm::gpu {

template <class... K>
constexpr int instantiate(KernelList<K...>) {
  int count = 0;
  ((count += &run<K> != nullptr), ...);
  return count;
}
inline const int kernels = instantiate(Kernels{});

}  // namespace dreampm::gpu

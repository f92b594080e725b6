#include "dreampm/solver/projection/kernels.h"

#include "dreampm/backend/cpu/kernel.h"
#include "dreampm/solver/projection/giving_loops.h"
#include "dreampm/solver/projection/multigrid_loops.h"
#include "dreampm/solver/projection/row_loops.h"
#include "dreampm/solver/projection/taking_loops.h"

namespace dreampm {
namespace {

template <class R>
const ProjectionKernels<R>& plain_kernels() {
  static constexpr ProjectionKernels<R> table{
      "scalar", [](const BlockTaking<R>& block, BlockMove& found) { take_particles<R, OneParticle<R>>(block, found); },
      [](const BlockGiving<R>& block) { give_particles<R, OneParticle<R>>(block); },
      MultigridLoops<R, OneParticle<R>>::table, RowLoops<R, OneParticle<R>>::table};
  return table;
}

/// Returns the table of an instruction set that the machine has: another's must not be called.
const ProjectionKernels<float>& table_of(std::string_view isa) {
#if defined(__x86_64__)
  return isa == "avx512" ? avx512::projection_table()
         : isa == "avx2" ? avx2::projection_table()
                         : sse4::projection_table();
#else
  static_cast<void>(isa);
  return neon::projection_table();
#endif
}

}  // namespace

template <>
const ProjectionKernels<float>& projection_kernels(std::string_view isa) {
  if (isa == "scalar") return plain_kernels<float>();
  const KernelTables here = available_kernels();
  for (int t = here.count - 1; t >= 0; --t)
    if (isa == here.tables[t]->isa) return table_of(isa);
  // The best for a backend on a device.
  return table_of(here.tables[here.count - 1]->isa);
}
template <>
const ProjectionKernels<double>& projection_kernels(std::string_view) {
  return plain_kernels<double>();
}

}  // namespace dreampm

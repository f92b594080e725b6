// The kernels of the gpu backends, one list: a number each, by which a device launches them.
#pragma once
#include <cstdint>
#include <type_traits>

#include "dreampm/backend/gpu/block_copies.h"
#include "dreampm/backend/gpu/contact_gaps.h"
#include "dreampm/backend/gpu/deep_contact.h"
#include "dreampm/backend/gpu/field_visit.h"
#include "dreampm/backend/gpu/flow_kernels.h"
#include "dreampm/backend/gpu/grid_sum.h"
#include "dreampm/backend/gpu/image_layers.h"
#include "dreampm/backend/gpu/near_particles.h"
#include "dreampm/backend/gpu/particle_copy.h"
#include "dreampm/backend/gpu/solid_contact.h"
#include "dreampm/backend/gpu/sort_kernels.h"
#include "dreampm/backend/gpu/stage_visit.h"
#include "dreampm/backend/gpu/surface_solve.h"
#include "dreampm/backend/gpu/viscous_pass.h"

namespace dreampm::gpu {

template <class... K>
struct KernelList {
  static_assert((std::is_trivially_copyable_v<K> && ...), "a kernel is copied to the device as it stands");
  static_assert(((sizeof(K) <= 4096 && sizeof(typename K::Shared) <= 48 * 1024) && ...),
                "a kernel's arguments or the memory of a block are larger than CUDA has them");
  static constexpr int size = sizeof...(K);
  /// Differs between lists whose kernels take other arguments.
  static constexpr std::uint64_t fingerprint() {
    std::uint64_t sum = 0;
    ((sum = sum * 1000003 + sizeof(K) * 64 + sizeof(typename K::Shared)), ...);
    return sum;
  }
  /// The number of a kernel.
  template <class One>
  static constexpr int number_of() {
    int n = 0;
    static_cast<void>(((std::is_same_v<One, K> || (++n, false)) || ...));
    constexpr bool known = (std::is_same_v<One, K> || ...);
    static_assert(known, "no kernel of the list");
    return n;
  }
  /// Calls f.template operator()<K>() for each in order.
  template <class F>
  static constexpr void for_each(F&& f) {
    (f.template operator()<K>(), ...);
  }
};

template <class... L>
struct JoinLists;
template <class... A>
struct JoinLists<KernelList<A...>> {
  using Type = KernelList<A...>;
};
template <class... A, class... B, class... Rest>
struct JoinLists<KernelList<A...>, KernelList<B...>, Rest...> {
  using Type = typename JoinLists<KernelList<A..., B...>, Rest...>::Type;
};

/// The kernels of one material.
template <class M>
struct MaterialKernels {
  using Steps = KernelList<Pass<M, false, false>, Pass<M, false, true>>;
  using Relaxing =
      std::conditional_t<VolumeRelaxed<M>, KernelList<Pass<M, true, false>, Pass<M, true, true>>, KernelList<>>;
  using Stages = std::conditional_t<Viscous<M>, KernelList<ViscousPass<M>>, KernelList<>>;
  using Type = typename JoinLists<Steps, Relaxing, Stages>::Type;
};
using SortKernels = KernelList<CountMoves, CountCells, StartCells, FillPlaces, SortPlaces, MoveParticles, CarryNodes>;
using FlowKernels = KernelList<OpenColumns, PlaceSeeds, HoldCells, FindEmptyBlocks>;
/// Those of the grid, and sums.
using GridKernels =
    KernelList<SumArenas, BeginVisit, ApplyFields, FieldWork, FoldImages, FinishVisit, ReflectImages, AddImageMass,
               MeetDeep, CopyBlocks, FillBlocks, MeetSolids, BeginStage, DragSolids, EndStage, ClearGaps, MeasureGaps,
               MeasureColliderGaps, FindWallGaps, Fill<float>, Fill<std::int32_t>, CopyPlaces, SpreadDistances,
               AddUp<BlockSums>, AddUp<GridTerms>, AddUp<SourceTerms>, SpeedPass>;
using SurfaceKernels = KernelList<FindActingPoints, FindNodeAreas, FindEffectiveMasses, DescendPoints, SumBodies,
                                  ApplyImpulses, FinishSurfaces>;
/// Those of programs that read particles on the device.
using ReaderKernels = KernelList<CopyParticles>;
template <class... M>
auto kernels_of(MaterialList<M...>) -> typename JoinLists<GridKernels, SortKernels, FlowKernels, SurfaceKernels,
                                                          ReaderKernels, typename MaterialKernels<M>::Type...>::Type;

using Kernels = decltype(kernels_of(Materials{}));

}  // namespace dreampm::gpu

// The one list of materials. A new one: its file in materials/, and its name here.
#pragma once
#include <utility>

#include "dreampm/physics/materials/elastic.h"
#include "dreampm/physics/materials/neo_hookean.h"
#include "dreampm/physics/materials/newtonian.h"
#include "dreampm/physics/materials/sand.h"
#include "dreampm/physics/materials/seed.h"
#include "dreampm/physics/materials/snow.h"
#include "dreampm/physics/materials/viscoplastic.h"

namespace dreampm {

template <class... M>
struct MaterialList {
#ifndef __CUDACC__  // nvcc takes it for no constant
  static_assert((has_right_sliders(M::info.params) && ...),
                "a slider of a material's table beyond its range, or one that needs what is no switch");
#endif
  static constexpr int size = sizeof...(M);
  /// Calls f.template operator()<M>() for each material in order.
  template <class F>
  static void for_each(F&& f) {
    (f.template operator()<M>(), ...);
  }
  /// Calls f for the material of that name; false if there is none.
  template <class F>
  static bool with(std::string_view name, F&& f) {
    return ((M::info.name == name && (f.template operator()<M>(), true)) || ...);
  }
};

template <class... A, class... B>
MaterialList<A..., B...> joined(MaterialList<A...>, MaterialList<B...>);

}  // namespace dreampm

// Materials outside of this tree: cmake -DDM_EXTRA_MATERIALS="HEADER:STRUCT;...". The header named
// here is generated.
#ifdef DM_EXTRA_MATERIALS
#include DM_EXTRA_MATERIALS
#else
namespace dreampm {
using ExtraMaterials = MaterialList<>;
}
#endif

namespace dreampm {

using OwnMaterials = MaterialList<Newtonian, Elastic, NeoHookean, Snow, Sand, Viscoplastic, Seed>;
using Materials = decltype(joined(OwnMaterials{}, ExtraMaterials{}));

/// m/s: the fastest wave behind the shock where that material, at rest in itself, hits a wall at
/// `speed` head on, or is caught by one that moves along it. With the front's speed U the strain is
/// speed/U, and momentum across it gives strain * stress = density * speed^2 (Rankine 1870,
/// Hugoniot 1887). 0 where that is far below its sound. `values` complete. Throws std::out_of_range
/// for an unknown name.
double shock_wave_speed(std::string_view material, const Values& values, double speed);

/// The number of state columns of a material.
template <class M>
inline constexpr int state_columns = static_cast<int>(std::size(M::template State<float>::names));

}  // namespace dreampm

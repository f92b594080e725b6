#include "solid_of.h"

#include "dreampm/geometry/region.h"

namespace dreampm {

WettedSolid solid_of(const Shape& shape) { return {make_region(shape, 0.01, {})}; }

}  // namespace dreampm

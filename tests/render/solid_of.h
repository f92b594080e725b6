// A shape as a solid that liquid wets. Apart, since geometry/region.h and the tracer do not go
// together in one file: both have a `trace`.
#pragma once
#include "dreampm/shape.h"
#include "dreampm/surface/surface.h"

namespace dreampm {

WettedSolid solid_of(const Shape& shape);

}  // namespace dreampm

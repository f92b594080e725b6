// Particles and meshes as arrays of numpy.
#pragma once
#include <nanobind/ndarray.h>

#include "convert.h"
#include "dreampm/image.h"
#include "dreampm/mesh.h"
#include "dreampm/particles.h"

namespace dreampm::python {

using Picture = nb::ndarray<nb::numpy, std::uint8_t, nb::shape<-1, -1, 3>>;

/// The picture as an array that owns it, (height, width, 3).
Picture array_of(RgbImage image);

}  // namespace dreampm::python

// A triangle mesh as plain arrays, with the vectors of this library.
#pragma once
#include "dreampm/math/vec.h"
#include "dreampm/mesh.h"

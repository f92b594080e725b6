// Where the grain of a solid lies by default.
#pragma once
#include <optional>

#include "dreampm/math/vec.h"
#include "dreampm/render/render.h"

namespace dreampm {

/// The frame of a mesh: x along `grain`, or the longest way if absent, z along the thinnest. The
/// axes of the picture where no way is longer than others, as in a ball or a cube.
TextureFrame texture_frame(const TriMesh& mesh, const std::optional<Vec3f>& grain);

}  // namespace dreampm

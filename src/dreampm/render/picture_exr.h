// A picture as an OpenEXR file, for compositing: linear light with what the first surfaces are
// like.
#pragma once
#include "dreampm/render/render.h"

namespace dreampm {

/// Channels of what was asked for, as a data window of the whole frame. R, G, B: radiance; A: 1, as
/// the sky is drawn. Z: depth [m], 1e10 of the sky. normal.X, .Y, .Z: in the scene's axes;
/// albedo.R, .G, .B; motion.X, .Y: pixels from frame to frame, to the right and up. Z and motion
/// are floats, the others halves.
ExrPicture exr_of(const Picture& picture);

}  // namespace dreampm

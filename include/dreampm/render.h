// Pictures of a simulation as it stands, by the path tracer of `dreampm render`.
#pragma once
#include <optional>

#include "dreampm/image.h"

namespace dreampm {

class Simulation;

/// Settings of one picture. A member that is not given is as in the scene's section `render`.
struct PictureOptions {
  std::optional<int> width, height;  ///< pixels, 8 to 16384
  std::optional<int> samples;        ///< at most, a pixel; 4 or more
};

/// Wraps liquids and solids in meshes, and traces the picture. Throws InputError for a value out of
/// range, Interrupted when the host asks to stop.
RgbImage render(const Simulation& simulation, const PictureOptions& options = {});

}  // namespace dreampm

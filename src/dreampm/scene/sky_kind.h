// The skies of a picture.
#pragma once

namespace dreampm {

enum class SkyKind {
  clear,    ///< blue, with soft clouds and a glow round the sun
  studio,   ///< dark, with a soft light above
  uniform,  ///< radiance 1 everywhere: for tests; no scene asks for it
};

}  // namespace dreampm

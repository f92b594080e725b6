#define BEFORE_OPAQUE
#include "water_splat.vert.glsl"

#define BEFORE_OPAQUE
#include "water_splat.frag.glsl"

#define EXACT_DEPTH
#include "spheres.vert.glsl"

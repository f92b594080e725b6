#define EXACT_DEPTH
#include "spheres.frag.glsl"

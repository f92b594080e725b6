#define FROM_DEPTH
#include "sun_blur.frag.glsl"

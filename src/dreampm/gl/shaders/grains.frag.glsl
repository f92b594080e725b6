// Grains are not balls: flatter, they read as one heap with a rough surface.
#define ROUND 0.5
#include "spheres.frag.glsl"

// The curve from linear radiance to what a screen shows.
#pragma once
#include "dreampm/render/render.h"

namespace dreampm::trace {

/// sRGB in 0 to 1 from exposed linear radiance: toe, shoulder, saturation, transfer curve.
Vec3f develop(Vec3f linear);

/// A cheap stand-in for the curve, by channel, to measure errors by.
Vec3f as_shown(const Vec3f& linear);

/// As far as the light of a bright pixel spills, of pictures that are so high [pixels].
int bloom_reach(int height);

}  // namespace dreampm::trace

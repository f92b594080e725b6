// What liquids absorb where matter of several colors mixes in them.
#pragma once
#include <span>

#include "dreampm/model/render.h"
#include "dreampm/render/absorption.h"

namespace dreampm {

/// Absorption [1/m] of clear matter of which a layer of `shown_layer` (math/look_color.h) lets that
/// linear color through.
Vec3d absorption_of(const Vec3f& color);

/// The field of particles, each with a linear color, on cells of two spacings: in each the color to
/// which its particles mix (math/pigments.h). Cells without particles take over what is beside
/// them. There must be particles; positions and spacing [m].
AbsorptionField absorption_field(std::span<const Vec3f> positions, std::span<const Vec3f> colors, float spacing);

}  // namespace dreampm

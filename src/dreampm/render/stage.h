// What stands around the matter in a picture, beside floor and basin: lamps, a backdrop.
#pragma once
#include <optional>

#include "dreampm/render/backdrop.h"
#include "dreampm/render/intersect.h"
#include "dreampm/render/lamps.h"
#include "dreampm/render/render.h"

namespace dreampm::trace {

/// The lamps of the scene's place, with its floor.
Lamps lamps_of(const RenderScene& scene);

/// The backdrop of a studio, as seen from `eye` [m]. Nothing elsewhere, and without a floor.
std::optional<Backdrop> backdrop_of(const RenderScene& scene, const Vec3f& eye);

model::Look paper_look();

/// Is there anything that photons may land on, beside the floor?
bool has_matte(const RenderScene& scene, const Geometry& geometry);

/// A box around what is clear or cloudy; empty (min above max) if nothing is.
Box3f clear_bounds(const RenderScene& scene, const Geometry& geometry);

}  // namespace dreampm::trace

// Which wall of the box the cursor takes hold of, and where it drags it.
#pragma once
#include <optional>

#include "dreampm/gl/camera.h"
#include "dreampm/simulation.h"
#include "dreampm/vec.h"

namespace dreampm::play {

/// Part of the box that two walls leave between each other.
inline constexpr double least_room = 0.2;

/// A place on a wall.
struct WallFace {
  Side side;
  Vec3d at;  ///< m
};

/// The wall of the room behind what one looks at; where that is the floor, the one that one looks
/// through. Nothing where the ray passes the room.
std::optional<WallFace> pick_wall(const Box3d& room, const gl::Ray& ray);

/// m, along the wall's axis: where the ray is nearest to the line through `from` that the wall
/// moves along. Nothing where it runs along that line.
std::optional<double> drawn_to(Side side, const Vec3d& from, const gl::Ray& ray);

}  // namespace dreampm::play

// Finds colliders that are too thin to hold matter.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "dreampm/model/scene.h"
#include "dreampm/state/world.h"

namespace dreampm {

/// Cells below which a collider may let matter through. Cells of a projection are cut by one
/// surface: what is thinner than a cell is lost between its nodes.
inline double thinnest_wall(SolverKind solver) { return solver == SolverKind::projection ? 1 : 0.5; }

struct ThinPlace {
  double thickness;  ///< m
  Vec3d at;          ///< m, in the middle of the wall
};

/// Returns the thinnest place of collider `c` of the world, if it is thinner than thinnest_wall()
/// in a place more than a cell wide that matter can touch from both sides: one that a closed wall
/// of the space or another collider covers is part of something thicker. Lines along the three
/// axes, half a cell apart or, in very large colliders, more, look for it.
std::optional<ThinPlace> thin_place(const World<double>& world, std::size_t c);

/// A line for each collider of the world with a thin place, with the spacing that would do.
std::vector<std::string> thin_collider_warnings(const World<double>& world, const model::Space& space);

}  // namespace dreampm

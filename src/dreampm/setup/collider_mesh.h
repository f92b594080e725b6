// Static colliders as meshes, to be drawn.
#pragma once
#include <optional>

#include "dreampm/geometry/mesh.h"
#include "dreampm/shape.h"

namespace dreampm {

/// The surface of a collider's shape [m]. Exact for boxes, balls, cylinders and meshes but for
/// tessellation; the edges of unions, differences and intersections are bevelled by `voxel` [m]. A
/// plane gives the polygon that it cuts out of `room`, empty if it misses it. Vertices on a side of
/// `room` are moved a hair inside, so that no face fights with glass or floor; if `clear`, those
/// within half a `voxel` are put on it, where the face is one with the floor or the pane. Vertices
/// count from `shift` [m], shape and room do not. With a `thickness` [m] it is the shell about that
/// surface, whose edges are bevelled; one that is thinner than a 200th of its longest side is drawn
/// that thick. Throws InputError for a mesh that cannot be read.
TriMesh collider_mesh(const Shape& shape, double voxel, const Box3d& room, const Vec3d& shift = {},
                      std::optional<double> thickness = {}, bool clear = false);

}  // namespace dreampm

# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects that have a surface: where they stand, and their triangles."""
import numpy

from .core.errors import DreampmError

MESHES = ("MESH", "CURVE", "SURFACE", "META", "FONT")


def matrix_of(thing, depsgraph):
    return numpy.array(thing.evaluated_get(depsgraph).matrix_world, dtype=float)


def local_mesh(thing, depsgraph):
    """Vertices and triangles of an object with its modifiers, in its own axes."""
    evaluated = thing.evaluated_get(depsgraph)
    mesh = evaluated.to_mesh()
    try:
        points = numpy.empty(len(mesh.vertices) * 3, dtype="f4")
        mesh.vertices.foreach_get("co", points)
        mesh.calc_loop_triangles()
        triangles = numpy.empty(len(mesh.loop_triangles) * 3, dtype="i4")
        mesh.loop_triangles.foreach_get("vertices", triangles)
    finally:
        evaluated.to_mesh_clear()
    return points.reshape(-1, 3).astype(float), triangles.reshape(-1, 3)


def world_mesh(thing, depsgraph):
    """The same in the axes of Blender's world."""
    points, triangles = local_mesh(thing, depsgraph)
    if not len(triangles):
        raise DreampmError(f"{thing.name} has no faces: it can take no part")
    matrix = matrix_of(thing, depsgraph)
    if numpy.linalg.det(matrix[:3, :3]) < 0:  # a mirrored object: its faces would look inward
        triangles = triangles[:, ::-1]
    return points @ matrix[:3, :3].T + matrix[:3, 3], triangles


def bounds_of(thing, depsgraph):
    """The bounds of an object in the world."""
    matrix = matrix_of(thing, depsgraph)
    corners = numpy.array([tuple(c) for c in thing.evaluated_get(depsgraph).bound_box]) @ matrix[:3, :3].T
    corners += matrix[:3, 3]
    return corners.min(axis=0), corners.max(axis=0)

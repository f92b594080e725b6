# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender has Z up and its own unit; scenes have Y up and meters."""
import re

import numpy

# Rows: the scene's x, y, z in Blender's axes. It turns by a quarter about x, so handedness stays.
ROTATION = numpy.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])


def to_scene(vectors, scale=1.0):
    """Places or velocities, (..., 3), of Blender as those of a scene; `scale` is meters per unit of Blender."""
    return numpy.asarray(vectors, dtype=float) @ ROTATION.T * scale


def to_blender(vectors, scale=1.0):
    """The way back: (..., 3) in meters, Y up, to Blender's units, Z up. float32 stays float32."""
    v = numpy.asarray(vectors)
    if v.dtype != numpy.float32:
        v = v.astype(float)
    out = numpy.empty_like(v)
    out[..., 0], out[..., 1], out[..., 2] = v[..., 0], -v[..., 2], v[..., 1]
    return out if scale == 1 else out / v.dtype.type(scale)


def matrix_to_scene(matrix, scale=1.0):
    """A matrix (4, 4) that takes Blender's points to Blender's points, as one of the scene."""
    m = numpy.asarray(matrix, dtype=float)
    out = numpy.eye(4)
    out[:3, :3] = ROTATION @ m[:3, :3] @ ROTATION.T
    out[:3, 3] = ROTATION @ m[:3, 3] * scale
    return out


def matrix_to_blender(matrix, scale=1.0):
    """The way back."""
    m = numpy.asarray(matrix, dtype=float)
    out = numpy.eye(4)
    out[:3, :3] = ROTATION.T @ m[:3, :3] @ ROTATION
    out[:3, 3] = ROTATION.T @ m[:3, 3] / scale
    return out


def box_to_scene(low, high, scale=1.0):
    """The two corners of a box along the axes."""
    corners = to_scene([low, high], scale)
    return corners.min(axis=0), corners.max(axis=0)


SIDES = {"x_min": "-X", "x_max": "+X", "y_min": "-Z", "y_max": "+Z", "z_min": "+Y", "z_max": "-Y"}


def sides_in_blender(text):
    """A message of the command about walls of a scene, as one about sides of the domain."""
    return re.sub(r"\b(?:the )?(wall|open side) ([xyz]_(?:min|max))\b",
                  lambda m: ("the open side " if m[1] == "open side" else "the side ") + SIDES[m[2]] + " of the domain", text)

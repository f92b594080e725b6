# SPDX-License-Identifier: GPL-3.0-or-later
"""The animation of an object as the motion of a rigid collider."""
import math

import numpy


class NotRigid(Exception):
    """The object is scaled or sheared while it moves."""


def rotation_vector(r):
    """Axis and angle [degrees, 0 to 180] of a rotation matrix."""
    twice_sine = numpy.array([r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1]])
    angle = math.atan2(numpy.linalg.norm(twice_sine), numpy.trace(r) - 1)
    if angle < 1e-7:
        return None, 0.0
    if angle < math.pi - 1e-4:
        return twice_sine / numpy.linalg.norm(twice_sine), math.degrees(angle)
    # Near half a turn the sine says nothing: the longest column of R + I lies along the axis.
    columns = r + numpy.eye(3)
    axis = columns[:, numpy.argmax(numpy.linalg.norm(columns, axis=0))]
    axis = axis / numpy.linalg.norm(axis)
    return (axis if axis @ twice_sine >= 0 else -axis), math.degrees(angle)


def is_still(matrices, tolerance=1e-7):
    first = numpy.asarray(matrices[0])
    size = 1 + numpy.abs(first).max()
    return all(numpy.abs(numpy.asarray(m) - first).max() <= tolerance * size for m in matrices)


def rigid_keys(times, matrices):
    """Keys [(t, position, axis, angle)] and the point about which they turn, from matrices (4, 4) in the scene's axes
    and meters. Angles go on over several turns. Raises NotRigid where lengths change by more than a thousandth."""
    first = numpy.asarray(matrices[0], dtype=float)
    about, inverse = first[:3, 3], numpy.linalg.inv(first[:3, :3])
    keys, axis_before, angle_before = [], numpy.array([0.0, 1.0, 0.0]), 0.0
    for t, matrix in zip(times, matrices):
        m = numpy.asarray(matrix, dtype=float)
        turn = m[:3, :3] @ inverse
        if numpy.abs(turn.T @ turn - numpy.eye(3)).max() > 2e-3 or numpy.linalg.det(turn) < 0:
            raise NotRigid
        u, _, v = numpy.linalg.svd(turn)
        axis, angle = rotation_vector(u @ v)
        if axis is None:
            axis = axis_before
        elif axis @ axis_before < 0:
            axis, angle = -axis, -angle
        angle += 360 * round((angle_before - angle) / 360)
        if numpy.abs(axis - axis_before).max() < 1e-6:  # the same to the last digit: it then turns about one axis
            axis = axis_before
        keys.append((float(t), m[:3, 3] - about, axis, angle))
        axis_before, angle_before = axis, angle
    return without_idle_keys(keys), about


def without_idle_keys(keys):
    """Leaves out a key between two that are alike."""
    def alike(a, b):
        return numpy.abs(a[1] - b[1]).max() < 1e-9 and (a[2] == b[2]).all() and abs(a[3] - b[3]) < 1e-9

    return [k for i, k in enumerate(keys)
            if i in (0, len(keys) - 1) or not (alike(k, keys[i - 1]) and alike(k, keys[i + 1]))]

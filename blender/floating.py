# SPDX-License-Identifier: GPL-3.0-or-later
"""Floating bodies get keyframes from the poses that the run recorded."""
import bpy
import mathutils

from .core import axes

PREFIX = "DreaMPM "
REST = "dreampm_rest"


def is_own_action(thing):
    data = thing.animation_data
    return bool(data and data.action and data.action.name.startswith(PREFIX))


def release(thing):
    """Takes the keyframes away and puts the object back where it started."""
    if not is_own_action(thing):
        return
    action = thing.animation_data.action
    thing.animation_data_clear()
    if not action.users:
        bpy.data.actions.remove(action)
    if REST in thing:
        thing.matrix_world = mathutils.Matrix([thing[REST][i:i + 4] for i in range(0, 16, 4)])
        del thing[REST]


def animate(thing, rest, poses, first_frame, scale):
    """Keyframes of the place and the rotation, at each frame of the run; `rest` is the object's matrix at its start."""
    release(thing)
    rest = mathutils.Matrix(rest)
    thing[REST] = [x for row in rest for x in row]
    rotation = {"QUATERNION": "rotation_quaternion", "AXIS_ANGLE": "rotation_axis_angle"}.get(thing.rotation_mode,
                                                                                          "rotation_euler")
    before = None
    for frame, pose in poses:
        thing.matrix_world = mathutils.Matrix(axes.matrix_to_blender(pose, scale).tolist()) @ rest
        if rotation == "rotation_euler" and before:
            thing.rotation_euler = thing.matrix_basis.to_euler(thing.rotation_mode, before)
        elif rotation == "rotation_quaternion" and before and thing.rotation_quaternion.dot(before) < 0:
            thing.rotation_quaternion.negate()
        if rotation != "rotation_axis_angle":
            before = getattr(thing, rotation).copy()
        for path in ("location", rotation):
            thing.keyframe_insert(path, frame=first_frame + frame - 1)
    if thing.animation_data and thing.animation_data.action:
        thing.animation_data.action.name = PREFIX + thing.name

# SPDX-License-Identifier: GPL-3.0-or-later
"""DreaMPM for Blender: objects become liquids, materials, colliders and emitters of a scene, the command `dreampm`
simulates it, and its frames come back as a mesh sequence.

What needs no Blender lies in core/, and is tested with plain Python."""
from . import baking, operators, panels, playback, preferences, properties

PARTS = (preferences, properties, operators, panels, playback, baking)


def register():
    for part in PARTS:
        part.register()


def unregister():
    for part in reversed(PARTS):
        part.unregister()

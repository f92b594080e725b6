# SPDX-License-Identifier: GPL-3.0-or-later
"""Where the command is, and the materials that it knows."""
import bpy

from .core import command
from .core.errors import DreampmError


class DreampmPreferences(bpy.types.AddonPreferences):
    bl_idname = __package__

    command: bpy.props.StringProperty(
        name="Command", subtype="FILE_PATH", default="",
        description="The program dreampm. Empty: the one on PATH, or of the Python package dreampm")

    def draw(self, _context):
        self.layout.prop(self, "command")
        try:
            self.layout.label(text=f"Found: {find_command()}", icon="CHECKMARK")
        except DreampmError as error:
            self.layout.label(text=str(error), icon="ERROR")


def find_command():
    """The path of the command. Raises DreampmError where there is none."""
    addon = bpy.context.preferences.addons.get(__package__)
    return command.find(addon.preferences.command if addon else "")


def known_materials(again=False):
    """What the command knows of materials. Raises DreampmError where there is no command, or where it fails; it is kept
    that it failed unless it is asked `again`."""
    return command.known_choices(find_command(), again)


def materials():
    """The same; nothing where there is no command or where it fails, which the panel reports."""
    try:
        return known_materials()
    except DreampmError:
        return []


def material(key):
    return next((c for c in materials() if c.key == key), None)


def register():
    bpy.utils.register_class(DreampmPreferences)


def unregister():
    bpy.utils.unregister_class(DreampmPreferences)

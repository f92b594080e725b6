# SPDX-License-Identifier: GPL-3.0-or-later
"""What the buttons do."""
import os

import bpy
import numpy

from . import baking, preferences, properties
from .core import command
from .core.errors import DreampmError
from .meshes import bounds_of


class Reporting:
    """Errors that the user can mend are reported, as Blender does."""
    bl_options = {"REGISTER", "UNDO"}

    def execute(self, context):
        try:
            self.act(context)
        except DreampmError as error:
            baking.session.error = str(error)
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        return {"FINISHED"}


class DREAMPM_OT_add_domain(Reporting, bpy.types.Operator):
    """Add a box about all objects that take part, with room around them, as the domain"""
    bl_idname, bl_label = "dreampm.add_domain", "Add Domain"

    def act(self, context):
        depsgraph = context.evaluated_depsgraph_get()
        taking_part = [t for t in context.scene.objects if t.type in properties.MESHES and t.dreampm.role != "NONE"]
        boxes = [bounds_of(t, depsgraph) for t in taking_part] or [(numpy.full(3, -1.0), numpy.full(3, 1.0))]
        low, high = numpy.min([b[0] for b in boxes], axis=0), numpy.max([b[1] for b in boxes], axis=0)
        room = 0.1 * max(high - low)
        low[:2], high = low[:2] - room, high + room
        x0, y0, z0, x1, y1, z1 = *map(float, low), *map(float, high)
        mesh = bpy.data.meshes.new("Domain")
        mesh.from_pydata([(x, y, z) for x in (x0, x1) for y in (y0, y1) for z in (z0, z1)], [],
                         [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)])
        box = bpy.data.objects.new("Domain", mesh)
        context.scene.collection.objects.link(box)
        context.view_layer.update()
        context.scene.dreampm.spacing = 0
        context.scene.dreampm.domain = box


class DREAMPM_OT_mark(Reporting, bpy.types.Operator):
    """Give all selected objects a role"""
    bl_idname, bl_label = "dreampm.mark", "Mark Selected As"
    role: bpy.props.EnumProperty(name="Role", items=properties.ROLES)

    @classmethod
    def poll(cls, context):
        return bool(context.selected_objects)

    def act(self, context):
        things = [t for t in context.selected_objects if t.type in properties.MESHES]
        if not things:
            raise DreampmError("no selected object has a mesh: only meshes, curves, surfaces and texts take part")
        for thing in things:
            thing.dreampm.role = self.role


def value_items(self, context):
    """The parameters of the active object's material that have no own value yet."""
    settings = context.object.dreampm
    choice = preferences.material(settings.material_key)
    properties.kept_texts["values"] = [
        (p.key, p.key.replace("_", " ").capitalize(), f"{p.help}{' [' + p.unit + ']' if p.unit else ''}")
        for p in (choice.parameters if choice else ()) if p.key not in settings.values]
    return properties.kept_texts["values"]


class DREAMPM_OT_value_add(Reporting, bpy.types.Operator):
    """Set a parameter of the material, other than the preset has it"""
    bl_idname, bl_label = "dreampm.value_add", "Set Parameter"
    key: bpy.props.EnumProperty(name="Parameter", items=value_items)

    def act(self, context):
        settings = context.object.dreampm
        choice = preferences.material(settings.material_key)
        parameter = choice.parameter(self.key)
        value = settings.values.add()
        value.name = parameter.key
        at = choice.values.get(parameter.key, parameter.default)
        if isinstance(at, str):
            value.word = at
        else:
            value.number = parameter.low if at is None else at


class DREAMPM_OT_value_remove(Reporting, bpy.types.Operator):
    """Take the preset's value again"""
    bl_idname, bl_label = "dreampm.value_remove", "Remove"
    index: bpy.props.IntProperty()

    def act(self, context):
        context.object.dreampm.values.remove(self.index)


class DREAMPM_OT_estimate(Reporting, bpy.types.Operator):
    """Write the scene, and ask the command what it will need"""
    bl_idname, bl_label = "dreampm.estimate", "Check"

    @classmethod
    def poll(cls, _context):
        return not baking.session.busy

    def act(self, context):
        captured, folder, _ = baking.write(context)
        baking.session.clear()
        baking.session.notes = captured.warnings
        try:
            said = command.estimate(preferences.find_command(), os.path.join(folder, baking.SCENE))
        except DreampmError as error:
            raise DreampmError(command.shorter(str(error), folder)) from error
        baking.session.notes = command.estimate_lines(said) + captured.warnings
        self.report({"INFO"}, baking.session.notes[0])


class DREAMPM_OT_bake(Reporting, bpy.types.Operator):
    """Simulate in the background, and show the frames as they come. Replaces those of an earlier bake"""
    bl_idname, bl_label = "dreampm.bake", "Bake"
    bl_options = {"REGISTER"}
    resume: bpy.props.BoolProperty(name="Resume", default=False, options={"SKIP_SAVE"},
                                   description="Goes on where the last bake stopped, with the scene as it was then")

    @classmethod
    def poll(cls, _context):
        return not baking.session.busy

    def act(self, context):
        (baking.resume if self.resume else baking.bake)(context)
        if baking.session.error:  # without a window the bake is over by now
            raise DreampmError(baking.session.error)


class DREAMPM_OT_cancel(Reporting, bpy.types.Operator):
    """Stop the bake. What is done is kept, and Resume goes on from there"""
    bl_idname, bl_label = "dreampm.cancel", "Cancel"
    bl_options = {"REGISTER"}

    @classmethod
    def poll(cls, _context):
        return baking.session.busy

    def act(self, _context):
        baking.session.bake.job.cancel()


class DREAMPM_OT_free(Reporting, bpy.types.Operator):
    """Delete the frames of the bake, and the objects that show them"""
    bl_idname, bl_label = "dreampm.free", "Free Bake"
    bl_options = {"REGISTER"}

    @classmethod
    def poll(cls, _context):
        return not baking.session.busy

    def invoke(self, context, event):
        return context.window_manager.invoke_confirm(self, event)

    def act(self, context):
        baking.free(context.scene)


class DREAMPM_OT_load(Reporting, bpy.types.Operator):
    """Show the frames of a run that was made by dreampm run or make"""
    bl_idname, bl_label = "dreampm.load", "Open a Run"
    directory: bpy.props.StringProperty(subtype="DIR_PATH")

    def invoke(self, context, _event):
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}

    def act(self, context):
        baking.load(context.scene, self.directory)


class DREAMPM_OT_dismiss(Reporting, bpy.types.Operator):
    """Hide the message"""
    bl_idname, bl_label = "dreampm.dismiss", "Dismiss"
    bl_options = {"INTERNAL"}

    def act(self, _context):
        baking.session.clear()


CLASSES = (DREAMPM_OT_add_domain, DREAMPM_OT_mark, DREAMPM_OT_value_add, DREAMPM_OT_value_remove, DREAMPM_OT_estimate,
           DREAMPM_OT_bake, DREAMPM_OT_cancel, DREAMPM_OT_free, DREAMPM_OT_load, DREAMPM_OT_dismiss)

register, unregister = bpy.utils.register_classes_factory(CLASSES)

# SPDX-License-Identifier: GPL-3.0-or-later
"""The panels: in the sidebar of the 3D view, and among the properties of an object."""
import textwrap

import bpy

from . import baking, preferences
from .core.errors import DreampmError
from .properties import MATTER, MESHES


def paragraph(layout, text, width, icon="NONE"):
    layout = layout.column(align=True)
    layout.scale_y = 0.8
    for i, line in enumerate(textwrap.wrap(text, max(20, width)) or [""]):
        layout.label(text=line, icon=icon if i == 0 else "BLANK1" if icon != "NONE" else "NONE")


def letters(context):
    """About how many go into a line of the region."""
    return int(context.region.width / (8.5 * context.preferences.system.ui_scale)) if context.region else 40


def draw_messages(layout, context):
    session = baking.session
    if not session.error and not session.notes:
        return
    box = layout.box()
    row = box.row()
    row.label(text="Error" if session.error else "Notes", icon="ERROR" if session.error else "INFO")
    row.operator("dreampm.dismiss", text="", icon="X", emboss=False)
    for text in session.error.splitlines() + session.notes:
        paragraph(box, text, letters(context))


def draw_material(layout, settings):
    choice = preferences.material(settings.material_key)
    layout.prop(settings, "material")
    for i, value in enumerate(settings.values):
        parameter = choice.parameter(value.name) if choice else None
        column = layout.column(align=True)
        unit = f" [{parameter.unit}]" if parameter and parameter.unit else ""
        column.label(text=value.name.replace("_", " ").capitalize() + unit)
        row = column.row(align=True)
        row.prop(value, "word" if parameter and isinstance(parameter.default, str) else "number", text="")
        row.operator("dreampm.value_remove", text="", icon="X").index = i
    layout.operator_menu_enum("dreampm.value_add", "key")
    layout.prop(settings, "show")


def draw_object(layout, thing):
    s = thing.dreampm
    layout.use_property_split = True
    layout.use_property_decorate = False
    layout.prop(s, "role")
    column = layout.column()
    if s.role in MATTER:
        draw_material(column, s)
    if s.role in ("LIQUID", "MATERIAL", "EMITTER", "FLOATING"):
        column.prop(s, "velocity")
    if s.role in ("LIQUID", "MATERIAL", "FLOATING"):
        column.prop(s, "spin")
    if s.role in ("LIQUID", "MATERIAL"):
        column.prop(s, "cut")
    if s.role == "EMITTER":
        for name in ("start", "stop", "pool", "recycle"):
            column.prop(s, name)
    if s.role == "COLLIDER":
        column.prop(s, "surface")
        if s.surface != "stick":
            column.prop(s, "friction")
        column.prop(s, "motion")
        column.prop(s, "shell")
        if s.shell:
            column.prop(s, "thickness")
    if s.role == "FLOATING":
        column.prop(s, "density")
        column.prop(s, "friction")


class Sidebar:
    bl_space_type, bl_region_type, bl_category = "VIEW_3D", "UI", "DreaMPM"


class DREAMPM_PT_bake(Sidebar, bpy.types.Panel):
    bl_label = "DreaMPM"

    def draw(self, context):
        layout, s = self.layout, context.scene.dreampm
        try:
            preferences.known_materials()
        except DreampmError as error:
            paragraph(layout, str(error), letters(context), "ERROR")
            layout.operator("preferences.addon_show", text="Preferences").module = __package__
            return
        session = baking.session
        if session.busy:
            job = session.bake.job
            layout.progress(factor=job.progress.factor, type="BAR", text=job.text())
            row = layout.row()
            row.enabled = job.state == "running"
            row.operator("dreampm.cancel", icon="CANCEL")
            return
        row = layout.row(align=True)
        row.operator("dreampm.bake", icon="PHYSICS")
        if self.can_resume(context.scene):
            row.operator("dreampm.bake", text="Resume", icon="PLAY").resume = True
        if s.baked:
            row.operator("dreampm.free", text="", icon="TRASH")
        layout.operator("dreampm.estimate", icon="INFO")
        draw_messages(layout, context)

    @staticmethod
    def can_resume(scene):
        """Whether frames that are asked for are missing from a bake that was begun."""
        baked = baking.Baked.of(scene)
        try:
            run = baking.run_of(scene)
        except DreampmError:
            return False
        return bool(baked) and run.can_resume() and not run.is_whole(baked.frames_to(scene), baked.meshed())


class DREAMPM_PT_object(Sidebar, bpy.types.Panel):
    bl_label, bl_parent_id = "Object", "DREAMPM_PT_bake"

    def draw(self, context):
        thing = context.object
        if thing and thing.type in MESHES:
            draw_object(self.layout, thing)
        else:
            self.layout.label(text="Select an object with a mesh")
        self.layout.operator_menu_enum("dreampm.mark", "role")


class DREAMPM_PT_domain(Sidebar, bpy.types.Panel):
    bl_label, bl_parent_id = "Domain", "DREAMPM_PT_bake"

    def draw(self, context):
        layout, s = self.layout, context.scene.dreampm
        layout.use_property_split = True
        layout.use_property_decorate = False
        layout.prop(s, "domain")
        if not s.domain:
            layout.operator("dreampm.add_domain", icon="CUBE")
        for name in ("spacing", "floor", "sides", "ceiling", "scene_range"):
            layout.prop(s, name)
        if not s.scene_range:
            layout.prop(s, "frame_start")
            layout.prop(s, "frame_end")


class DREAMPM_PT_output(Sidebar, bpy.types.Panel):
    bl_label, bl_parent_id, bl_options = "Surface and Files", "DREAMPM_PT_bake", {"DEFAULT_CLOSED"}

    def draw(self, context):
        layout, s = self.layout, context.scene.dreampm
        layout.use_property_split = True
        layout.use_property_decorate = False
        for name in ("voxel", "smooth", "backend", "threads", "folder"):
            layout.prop(s, name)
        layout.operator("dreampm.load", icon="FILE_FOLDER")


class DREAMPM_PT_properties(bpy.types.Panel):
    bl_label = "DreaMPM"
    bl_space_type, bl_region_type, bl_context = "PROPERTIES", "WINDOW", "object"

    @classmethod
    def poll(cls, context):
        return context.object is not None and context.object.type in MESHES

    def draw(self, context):
        draw_object(self.layout, context.object)
        result = context.object.dreampm_result
        if result.folder:
            for name in ("folder", "material", "particles", "first_frame"):
                self.layout.prop(result, name)


CLASSES = (DREAMPM_PT_bake, DREAMPM_PT_object, DREAMPM_PT_domain, DREAMPM_PT_output, DREAMPM_PT_properties)

register, unregister = bpy.utils.register_classes_factory(CLASSES)

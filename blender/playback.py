# SPDX-License-Identifier: GPL-3.0-or-later
"""Shows the frames of a run: an object for each material, whose mesh is that of the current frame."""
import os

import bpy
import numpy
from bpy.app.handlers import persistent

from . import looks
from .core.errors import DreampmError
from .core.run_folder import RunFolder

PREFIX = "DreaMPM "

# How a mesh keeps values: by how many a vertex has, or by what they are.
KINDS = {"i": ("INT", "value"), "f": ("FLOAT", "value"), 3: ("FLOAT_VECTOR", "vector"),
         4: ("BYTE_COLOR", "color_srgb")}

# What each mesh shows, so that a frame is read once: by its session's own number.
_shown = {}


def results_of(scene, folder=None):
    """Objects of a scene that show a run; those of one folder."""
    found = [thing for thing in scene.objects if thing.type == "MESH" and thing.dreampm_result.folder]
    return found if folder is None else [t for t in found if path_of(t) == os.path.normpath(folder)]


def path_of(thing):
    return os.path.normpath(bpy.path.abspath(thing.dreampm_result.folder, library=thing.library))


def fill(mesh, frame):
    """Puts a frame into a mesh; materials stay."""
    mesh.clear_geometry()
    n, m = len(frame.points), len(frame.triangles)
    mesh.vertices.add(n)
    mesh.vertices.foreach_set("co", frame.points.ravel())
    if m:
        mesh.loops.add(3 * m)
        mesh.loops.foreach_set("vertex_index", numpy.ascontiguousarray(frame.triangles, dtype="i4").ravel())
        mesh.polygons.add(m)
        mesh.polygons.foreach_set("loop_start", numpy.arange(0, 3 * m, 3, dtype="i4"))
        mesh.polygons.foreach_set("use_smooth", numpy.ones(m, dtype=bool))
        mesh.update(calc_edges=True)
    # Cycles and EEVEE read it for motion blur: units a second.
    if frame.velocity is not None:
        mesh.attributes.new("velocity", "FLOAT_VECTOR", "POINT").data.foreach_set("vector", frame.velocity.ravel())
    if frame.ids is not None:
        mesh.attributes.new("id", "INT", "POINT").data.foreach_set("value", frame.ids)
    for name, values in frame.attributes.items():
        kind, member = KINDS[values.shape[1] if values.ndim == 2 else values.dtype.kind]
        mesh.attributes.new(name, kind, "POINT").data.foreach_set(member, values.ravel())
    if m and frame.normals is not None:
        mesh.normals_split_custom_set_from_vertices(frame.normals)
    mesh.update()


def show(thing, blender_frame):
    """Puts the frame of the run that belongs to a frame of Blender into the object's mesh."""
    result = thing.dreampm_result
    run, number = RunFolder(path_of(thing)), blender_frame - result.first_frame + 1
    files = run.foam_files(number) if result.foam else run.files(result.material, number)
    if not files:
        return
    key = state_of(files, result)
    if _shown.get(thing.data.session_uid) == key:
        return
    fill(thing.data, files.read(result.particles or result.foam, result.scale))
    _shown[thing.data.session_uid] = key


def state_of(files, result):
    """What a frame is read from: it changes while a bake goes on."""
    return (files, result.particles, result.scale, result.first_frame,
            tuple(os.stat(f).st_mtime_ns if os.path.exists(f) else 0 for f in (files.surface, files.particles)))


def refresh(scene):
    """Shows what is there now. Errors are returned, not raised: one damaged file must not stop the others."""
    errors = []
    for thing in results_of(scene):
        try:
            show(thing, scene.frame_current)
        except DreampmError as error:
            errors.append(str(error))
    return errors


@persistent
def on_frame(scene, _depsgraph=None):
    for error in refresh(scene):
        print(f"DreaMPM: {error}")


@persistent
def on_load(_path, _more=None):
    """Another file, or another state of this one by undo: meshes are not what they were."""
    _shown.clear()
    for scene in bpy.data.scenes:
        on_frame(scene)


def make_result(scene, folder, material, first_frame, scale, particles=False, kind="newtonian", preset="water",
                radius=0.01):
    """The object that shows a material of a run: the one that did so before, or a new one."""
    for thing in results_of(scene, folder):
        if thing.dreampm_result.material == material and not thing.dreampm_result.foam:
            break
    else:
        mesh = bpy.data.meshes.new(PREFIX + material)
        thing = bpy.data.objects.new(PREFIX + material, mesh)
        scene.collection.objects.link(thing)
        mesh.materials.append(looks.look_for(material, kind, preset))
    result = thing.dreampm_result
    result.folder = relative(folder)
    result.material, result.first_frame, result.scale, result.particles = material, first_frame, scale, particles
    if particles:
        looks.draw_as_points(thing, radius, thing.data.materials[0] if thing.data.materials else None)
    elif "Points" in thing.modifiers:
        thing.modifiers.remove(thing.modifiers["Points"])
    return thing


def make_foam(scene, folder, first_frame, scale):
    """The object that shows the foam of a run: points of their own radii."""
    for thing in results_of(scene, folder):
        if thing.dreampm_result.foam:
            break
    else:
        thing = bpy.data.objects.new(PREFIX + "foam", bpy.data.meshes.new(PREFIX + "foam"))
        scene.collection.objects.link(thing)
        thing.data.materials.append(looks.foam_look())
    result = thing.dreampm_result
    result.folder = relative(folder)
    result.material, result.first_frame, result.scale, result.foam = "foam", first_frame, scale, True
    looks.draw_as_foam(thing, thing.data.materials[0] if thing.data.materials else None)
    return thing


def remove_results(scene, folder, keep=()):
    for thing in results_of(scene, folder):
        if thing.dreampm_result.foam or thing.dreampm_result.material not in keep:
            mesh = thing.data
            bpy.data.objects.remove(thing)
            if not mesh.users:
                bpy.data.meshes.remove(mesh)


def relative(folder):
    """Beside the .blend file if it can be said so: the two then move together."""
    if not bpy.data.filepath:
        return folder
    try:
        return bpy.path.relpath(folder)
    except ValueError:  # on another drive
        return folder


def handlers():
    events = bpy.app.handlers
    return ((events.frame_change_post, on_frame), (events.load_post, on_load), (events.undo_post, on_load),
            (events.redo_post, on_load))


def register():
    for event, function in handlers():
        event.append(function)


def unregister():
    for event, function in handlers():
        event.remove(function)
    _shown.clear()

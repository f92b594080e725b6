# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads a scene of Blender: its meshes into files, its settings into a setup."""
import os
import shutil

import bpy
import numpy

from . import preferences
from .core import axes, motion, ply
from .core.errors import DreampmError
from .core.setup import Body, Collider, Emitter, Material, Names, Rigid, Setup, Sink, boxes_meet, edges_are_paired
from .meshes import MESHES, bounds_of, local_mesh, matrix_of, world_mesh

MODELS = "models"


def scale_of(scene):
    """Meters per unit."""
    return round_single(scene.unit_settings.scale_length) if scene.unit_settings.system != "NONE" else 1.0


def may_move(thing):
    """Whether anything about the object could change with time."""
    datas = [thing, thing.data, getattr(thing.data, "shape_keys", None)]
    return (any(d.animation_data for d in datas if d) or bool(thing.constraints) or bool(thing.modifiers)
            or thing.rigid_body is not None or (thing.parent is not None and may_move(thing.parent)))


def parameter_values(settings, choice):
    """Own values of a material, as a scene says them."""
    values = []
    for value in settings.values:
        parameter = choice.parameter(value.name)
        if parameter:
            values.append((value.name, value.word or round_single(value.number)))
    return tuple(values)


def round_single(number):
    """A float of Blender in the shortest digits that mean it."""
    return float(str(numpy.float32(number)))


class Capture:
    """One pass over a scene. Afterwards `setup` and `warnings` are there, and the meshes lie in `folder`/models."""

    def __init__(self, context, folder):
        self.context, self.scene, self.folder = context, context.scene, folder
        self.settings, self.scale = self.scene.dreampm, scale_of(self.scene)
        self.first, self.last = self.settings.frames()
        self.fps = self.scene.render.fps / self.scene.render.fps_base
        self.names, self.warnings, self.rigid = Names(), [], {}
        self.liquids_only = True
        self.boxes = {}

    def run(self):
        if not self.settings.domain:
            raise DreampmError("there is no domain: add one, or choose the object whose bounds are the domain")
        if self.settings.spacing <= 0:
            raise DreampmError("the spacing is 0: say how far apart particles are")
        if self.last < self.first:
            raise DreampmError(f"the last frame, {self.last}, lies before the first, {self.first}")
        things = {}
        for thing in self.scene.objects:
            if thing.dreampm.role == "NONE" or thing.name not in self.context.view_layer.objects or thing.hide_viewport:
                continue
            if thing.type in MESHES:
                things.setdefault(thing.dreampm.role, []).append(thing)
            else:
                what = "an instance of a collection" if thing.instance_type == "COLLECTION" else "no mesh"
                self.warnings.append(f"{thing.name} is {what} ({thing.type.lower()}) and takes no part: give the role to "
                                     "objects with faces" + (
                                         ", by Object > Apply > Make Instances Real" if "instance" in what else ""))
        shutil.rmtree(os.path.join(self.folder, MODELS), ignore_errors=True)
        os.makedirs(os.path.join(self.folder, MODELS), exist_ok=True)
        now = self.scene.frame_current, self.scene.frame_subframe
        try:
            self.scene.frame_set(self.first)
            self._read(things)
        finally:
            self.scene.frame_set(now[0], subframe=now[1])
        return self

    def _read(self, things):
        depsgraph = self.context.evaluated_depsgraph_get()
        low, high = bounds_of(self.settings.domain, depsgraph)
        s = self.settings
        self.setup = Setup(
            name=Names().give(os.path.splitext(os.path.basename(bpy.data.filepath))[0] or self.scene.name),
            low=tuple(low), high=tuple(high), spacing=s.spacing, fps=self.fps, frames=self.last - self.first + 1,
            gravity=tuple(self.scene.gravity) if self.scene.use_gravity else (0, 0, 0), scale=self.scale,
            walls={"floor": s.floor, "sides": s.sides, "ceiling": s.ceiling}, voxel=round_single(s.voxel),
            smooth=s.smooth)
        moving = []
        for thing in things.get("COLLIDER", []):
            self._collider(thing, depsgraph, moving)
        for thing in things.get("FLOATING", []):
            self._floating(thing, depsgraph)
        for thing in things.get("LIQUID", []) + things.get("MATERIAL", []):
            self._body(thing, depsgraph)
        for thing in things.get("EMITTER", []):
            self._emitter(thing, depsgraph, moving)
        for thing in things.get("OUTFLOW", []):
            name, mesh = self._mesh(thing, depsgraph)
            self.setup.sinks.append(Sink(name, mesh))
            if may_move(thing):
                moving.append((thing, self.setup.sinks[-1]))
        if self.liquids_only:
            for collider in self.setup.colliders:
                collider.friction = 0  # liquids do not feel it, and the command would say so
        if moving:
            self._watch(moving)

    def _mesh(self, thing, depsgraph, hollow=False):
        """Writes the mesh of an object as it is now: its name, and the file beside the scene."""
        name = self.names.give(thing.name)
        points, triangles = world_mesh(thing, depsgraph)
        if not hollow and not edges_are_paired(triangles):
            self.warnings.append(f"{thing.name} is not closed: its holes are filled" + (
                ". Tick Shell to make it a wall" if thing.dreampm.role == "COLLIDER" else ""))
        low, high = points.min(axis=0), points.max(axis=0)
        around = round_single(thing.dreampm.thickness) / 2 if hollow else 0
        self.boxes[name] = (low - around, high + around)
        return name, self._write(f"{name}.ply", points, triangles)

    def _write(self, file, points, triangles):
        ply.write_mesh(os.path.join(self.folder, MODELS, file), axes.to_scene(points, self.scale), triangles)
        return f"{MODELS}/{file}"

    def _collider(self, thing, depsgraph, moving):
        s = thing.dreampm
        name, mesh = self._mesh(thing, depsgraph, hollow=s.shell)
        one = Collider(name, [mesh], s.surface, round_single(s.friction), s.thickness if s.shell else 0)
        self.setup.colliders.append(one)
        if s.motion == "DEFORM" or (s.motion == "AUTO" and may_move(thing)):
            moving.append((thing, one))

    def _floating(self, thing, depsgraph):
        from .floating import is_own_action
        action = thing.animation_data.action if thing.animation_data else None
        if action and not is_own_action(thing):
            raise DreampmError(f"{thing.name} is animated: a floating body moves by itself. Clear its animation, or "
                               "make it a collider")
        s = thing.dreampm
        name, mesh = self._mesh(thing, depsgraph)
        low, high = self.boxes[name]
        self.rigid[name] = [thing.name, matrix_of(thing, depsgraph).tolist()]
        self.setup.rigid.append(Rigid(name, mesh, tuple((low + high) / 2), round_single(s.density),
                                      round_single(s.friction), tuple(s.velocity), tuple(s.spin)))

    def _body(self, thing, depsgraph):
        s = thing.dreampm
        name, mesh = self._mesh(thing, depsgraph)
        solids = [*self.setup.colliders, *self.setup.rigid]
        cut = tuple(one.name for one in solids if s.cut and boxes_meet(self.boxes[one.name], self.boxes[name]))
        self.setup.bodies.append(Body(name, self._material(thing), mesh, tuple(s.velocity), tuple(s.spin), cut))

    def _material(self, thing):
        settings = thing.dreampm
        choice = preferences.material(settings.material_key)
        if not choice:
            raise DreampmError(f"{thing.name}: the command knows no material {settings.material_key}: choose another")
        self.liquids_only = self.liquids_only and choice.liquid
        particles = settings.show == "PARTICLES" or (settings.show == "AUTO" and choice.type == "sand")
        return Material(choice.type, choice.preset, parameter_values(settings, choice), particles)

    def _emitter(self, thing, depsgraph, moving):
        s = thing.dreampm
        if not any(s.velocity):
            raise DreampmError(f"{thing.name} is an emitter without a velocity: matter has to move through it")
        name, mesh = self._mesh(thing, depsgraph)
        self.setup.emitters.append(Emitter(
            name, self._material(thing), mesh, tuple(s.velocity), max(0, s.start - self.first) / self.fps,
            max(0, s.stop - self.first) / self.fps if s.stop else 0, s.pool, s.recycle))
        if may_move(thing):
            moving.append((thing, self.setup.emitters[-1]))

    def _watch(self, moving):
        """Goes through the frames to see how colliders, emitters and outflows move."""
        frames = range(self.first, self.last + 1)
        probes = {self.first, (self.first + self.last) // 2, self.last}
        poses, shapes = [[] for _ in moving], [[] for _ in moving]
        for frame in frames:
            self.scene.frame_set(frame)
            depsgraph = self.context.evaluated_depsgraph_get()
            for i, (thing, _) in enumerate(moving):
                poses[i].append(axes.matrix_to_scene(matrix_of(thing, depsgraph), self.scale))
                if frame in probes:
                    shapes[i].append(local_mesh(thing, depsgraph)[0])
        times = [(frame - self.first) / self.fps for frame in frames]
        deforming = []
        for i, (thing, collider) in enumerate(moving):
            is_collider = isinstance(collider, Collider)
            if is_collider and thing.dreampm.motion == "DEFORM" or deforms(shapes[i]):
                deforming.append((thing, collider))
            elif not motion.is_still(poses[i]):
                try:
                    collider.keys, collider.about = motion.rigid_keys(times, poses[i])
                except motion.NotRigid:
                    deforming.append((thing, collider))
        for thing, one in deforming:
            if not isinstance(one, Collider):
                raise DreampmError(f"{thing.name} deforms: an emitter or outflow may move and turn, and keeps its shape")
        if deforming and len(frames) > 1:
            self._write_sequences(deforming, frames)

    def _write_sequences(self, deforming, frames):
        for thing, collider in deforming:
            if collider.thickness > 0:
                raise DreampmError(f"{thing.name} deforms, and is a shell: a shell may only move. Give it two layers "
                                   "of faces by a Solidify modifier, and no Shell")
            collider.meshes = []
        sizes = {}
        for number, frame in enumerate(frames, 1):
            self.scene.frame_set(frame)
            depsgraph = self.context.evaluated_depsgraph_get()
            for thing, collider in deforming:
                points, triangles = world_mesh(thing, depsgraph)
                if sizes.setdefault(thing.name, (len(points), len(triangles))) != (len(points), len(triangles)):
                    raise DreampmError(f"{thing.name} has other faces in frame {frame} than in frame {frames[0]}: a "
                                       "collider that deforms keeps its faces")
                collider.meshes.append(self._write(f"{collider.name}.{number:06}.ply", points, triangles))


def deforms(shapes):
    """Whether vertices move in the object's own axes."""
    first = shapes[0]
    size = 1e-6 * (1 + numpy.abs(first).max(initial=0))
    return any(s.shape != first.shape or numpy.abs(s - first).max(initial=0) > size for s in shapes[1:])

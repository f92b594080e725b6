# SPDX-License-Identifier: GPL-3.0-or-later
"""What is to be simulated, in Blender's axes and units, and the scene that follows from it."""
import dataclasses
import os
import re

import numpy

from . import axes, yaml_text
from .errors import DreampmError


@dataclasses.dataclass(frozen=True)
class Material:
    """A type of `dreampm materials`, one of its presets or none, and own values as a scene says them."""
    type: str
    preset: str = ""
    values: tuple = ()  # of (key, number or word)
    particles: bool = False  # shown as particles, not as a surface


@dataclasses.dataclass
class Body:
    name: str
    material: Material
    mesh: str  # a file beside the scene
    velocity: tuple = (0, 0, 0)  # m/s
    spin: tuple = (0, 0, 0)  # rad/s
    cut: tuple = ()  # names of colliders and floating bodies that are cut out of it


@dataclasses.dataclass
class Collider:
    name: str
    meshes: list  # one file, or one a frame
    type: str = "separate"
    friction: float = 0
    thickness: float = 0  # in units of Blender; 0: it is solid
    keys: list = dataclasses.field(default_factory=list)  # of motion.rigid_keys: already in the scene's axes
    about: tuple = (0, 0, 0)


@dataclasses.dataclass
class Rigid:
    name: str
    mesh: str
    middle: tuple  # of the bounds of its mesh
    density: float = 500  # kg/m^3
    friction: float = 0.4
    velocity: tuple = (0, 0, 0)
    spin: tuple = (0, 0, 0)


@dataclasses.dataclass
class Emitter:
    name: str
    material: Material
    mesh: str
    velocity: tuple  # m/s
    start: float = 0  # s
    stop: float = 0  # s; 0: never
    pool: int = 100000
    recycle: bool = False
    keys: list = dataclasses.field(default_factory=list)  # as a collider has them
    about: tuple = (0, 0, 0)


@dataclasses.dataclass
class Sink:
    name: str
    mesh: str
    keys: list = dataclasses.field(default_factory=list)  # as a collider has them
    about: tuple = (0, 0, 0)


@dataclasses.dataclass
class Setup:
    name: str
    low: tuple  # of the domain
    high: tuple
    spacing: float  # between particles, in units of Blender
    fps: float
    frames: int
    gravity: tuple = (0, 0, -9.81)  # m/s^2
    scale: float = 1  # meters per unit
    walls: dict = dataclasses.field(default_factory=dict)  # "floor", "sides", "ceiling": a type
    voxel: float = 0.5
    smooth: int = 2
    checkpoint: int = 10
    bodies: list = dataclasses.field(default_factory=list)
    colliders: list = dataclasses.field(default_factory=list)
    rigid: list = dataclasses.field(default_factory=list)
    emitters: list = dataclasses.field(default_factory=list)
    sinks: list = dataclasses.field(default_factory=list)


class Names:
    """Names that a scene accepts, each given once: those of Blender have blanks, points and letters of any script."""

    def __init__(self):
        self.taken = set()

    def give(self, wanted):
        name = re.sub(r"[^A-Za-z0-9_-]+", "_", wanted).strip("_-")[:56] or "object"
        one, n = name, 1
        while one.lower() in self.taken:  # they also name files, and some file systems know no case
            n += 1
            one = f"{name}-{n}"
        self.taken.add(one.lower())
        return one


def material_entry(m):
    entry = {"type": m.type}
    if m.preset:
        entry["preset"] = m.preset
    entry.update((key, yaml_text.Word(v) if isinstance(v, str) else v) for key, v in m.values)
    return entry


def named_materials(setup, names):
    """Each different material with a name of its own, in the order of the bodies and emitters."""
    found = {}
    for thing in [*setup.bodies, *setup.emitters]:
        if thing.material not in found:
            found[thing.material] = names.give(thing.material.preset or thing.material.type)
    return found


def vector(v):
    return [float(x) for x in v]


def body_entry(body, material):
    entry = {"material": material, "shape": {"mesh": body.mesh}}
    if body.cut:
        entry["cut"] = list(body.cut)
    for key in ("velocity", "spin"):
        if any(getattr(body, key)):
            entry[key] = vector(axes.to_scene(getattr(body, key)))
    return entry


def sink_entry(sink):
    entry = {"shape": {"mesh": sink.mesh}}
    if sink.keys:
        entry["motion"] = motion_entry(sink)
    return entry


def motion_entry(collider):
    keys = [{"t": t, "position": vector(position), "rotate": {"axis": vector(axis), "angle": float(angle)}}
            for t, position, axis, angle in collider.keys]
    return {"about": vector(collider.about), "keys": keys}


def collider_entry(collider, setup):
    entry = {"shape": {"mesh": collider.meshes[0]}, "type": collider.type}
    if len(collider.meshes) > 1:
        entry["shape"] = {"meshes": list(collider.meshes), "fps": float(setup.fps)}
    if collider.friction and collider.type != "stick":
        entry["friction"] = collider.friction
    if collider.thickness > 0:
        entry["thickness"] = collider.thickness * setup.scale
    if collider.keys:
        entry["motion"] = motion_entry(collider)
    return entry


def rigid_entry(rigid, scale):
    entry = {"shape": {"mesh": rigid.mesh}, "position": vector(axes.to_scene(rigid.middle, scale)),
             "density": rigid.density, "friction": rigid.friction}
    for key in ("velocity", "spin"):
        if any(getattr(rigid, key)):
            entry[key] = vector(axes.to_scene(getattr(rigid, key)))
    return entry


def emitter_entry(emitter, material):
    entry = {"material": material, "shape": {"mesh": emitter.mesh},
             "velocity": vector(axes.to_scene(emitter.velocity)), "pool": emitter.pool}
    if emitter.start > 0:
        entry["start"] = emitter.start
    if emitter.stop > 0:
        entry["stop"] = emitter.stop
    if emitter.recycle:
        entry["recycle"] = True
    if emitter.keys:
        entry["motion"] = motion_entry(emitter)
    return entry


def scene_of(setup):
    """The scene as a tree, and the name that each material has in it."""
    low, high = axes.box_to_scene(setup.low, setup.high, setup.scale)
    if not (high > low).all():
        raise DreampmError("the domain has no volume: give it a width, a depth and a height")
    if not setup.bodies and not setup.emitters:
        raise DreampmError("nothing to simulate: mark an object as liquid, material or emitter")
    names = Names()
    for thing in [*setup.colliders, *setup.rigid, *setup.sinks]:
        names.taken.add(thing.name.lower())
    materials = named_materials(setup, names)
    tree = {
        "dreampm": 1,
        "name": setup.name,
        "about": "Written by DreaMPM for Blender: meters, Y up.",
        "space": {"min": vector(low), "max": vector(high), "spacing": setup.spacing * setup.scale,
                  "walls": {side: {"type": kind} for side, kind in setup.walls.items()}},
        "time": {"fps": float(setup.fps), "frames": int(setup.frames)},
        "gravity": vector(axes.to_scene(setup.gravity)),
        "materials": {name: material_entry(m) for m, name in materials.items()},
        "bodies": {b.name: body_entry(b, materials[b.material]) for b in setup.bodies},
        "emitters": {e.name: emitter_entry(e, materials[e.material]) for e in setup.emitters},
        "sinks": {s.name: sink_entry(s) for s in setup.sinks},
        "colliders": {c.name: collider_entry(c, setup) for c in setup.colliders},
        "rigid": {r.name: rigid_entry(r, setup.scale) for r in setup.rigid},
        "output": {"folder": "run", "particles": {"format": "ply", "attributes": ["velocity"]},
                   "checkpoint": {"every": setup.checkpoint}},
        "surface": {"voxel": setup.voxel, "smooth": setup.smooth},
        "render": {"looks": {name: {"type": "spheres"} for m, name in materials.items() if m.particles}},
    }
    if not tree["render"]["looks"]:
        del tree["render"]
    return {key: value for key, value in tree.items() if value != {}}, materials


def write_scene(path, setup):
    """Writes the scene file whole or not at all; returns the name of each material."""
    tree, materials = scene_of(setup)
    text = "# Written by DreaMPM for Blender; the next bake writes it anew.\n" + yaml_text.dump(tree)
    temporary = f"{path}.tmp"
    with open(temporary, "w", encoding="utf-8") as out:
        out.write(text)
    os.replace(temporary, path)
    return materials


def boxes_meet(a, b):
    """Whether two boxes ((low, high), (low, high)) have a part in common."""
    return bool((numpy.asarray(a[0]) < numpy.asarray(b[1])).all() and (numpy.asarray(b[0]) < numpy.asarray(a[1])).all())


def edges_are_paired(triangles):
    """Whether every edge of a mesh joins two faces: it then encloses something."""
    t = numpy.asarray(triangles)
    if not len(t):
        return False
    edges = numpy.sort(numpy.concatenate([t[:, [0, 1]], t[:, [1, 2]], t[:, [2, 0]]]), axis=1)
    _, counts = numpy.unique(edges, axis=0, return_counts=True)
    return bool((counts == 2).all())

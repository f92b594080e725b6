# SPDX-License-Identifier: GPL-3.0-or-later
"""The folder of a run: which frames it has, how it ended, and how it is emptied."""
import dataclasses
import json
import os
import re
import shutil

import numpy

from . import axes, ply
from .errors import DreampmError

# What `dreampm run` and `surface` write.
FOLDERS = ("particles", "surface", "foam", "checkpoint", "models", "probes", "render")
FILES = ("run.json", "scene.yaml", "ledger.csv", "fill.csv", "log.txt", "lock", "contact-sheet.png")
NUMBERED = re.compile(r"(.+)_(\d{6,})\.ply")


# Columns that are no attributes of their own.
KNOWN = {"x", "y", "z", "nx", "ny", "nz", "vx", "vy", "vz", "id", "material", "alpha"}


def attributes_of(file, scale):
    """What else a file says of its vertices, by name: (n,) numbers, (n, 3) vectors in Blender's axes, (n, 4) a color in
    sRGB. A radius is in Blender's units."""
    found = {}
    rest = [name for name in file.columns.dtype.names if name not in KNOWN]
    color = file.vectors(("red", "green", "blue"))
    if color is not None:
        found["color"] = numpy.concatenate([color / 255, numpy.ones((len(color), 1), "f4")], axis=1).astype("f4")
        rest = [name for name in rest if name not in ("red", "green", "blue")]
    for name in [n[:-2] for n in rest if n.endswith("_x")]:
        vector = file.vectors((f"{name}_x", f"{name}_y", f"{name}_z"))
        if vector is not None:
            found[name] = axes.to_blender(vector)
            rest = [n for n in rest if n not in (f"{name}_x", f"{name}_y", f"{name}_z")]
    for name in rest:
        values = file.columns[name]
        found[name] = values.astype("i4" if values.dtype.kind in "iu" else "f4")
    if "radius" in found:
        found["radius"] = (found["radius"] / scale).astype("f4")
    return found


class Frame:
    """What Blender shows of a frame: in its axes, and in units, or units a second."""

    def __init__(self, file, scale):
        self.points = axes.to_blender(file.places(), scale).astype("f4")
        self.triangles = file.triangles
        velocity, normal = file.velocities(), file.normals()
        if velocity is None and not len(file):  # a mesh of nothing has no columns for it
            velocity = numpy.empty((0, 3), dtype="f4")
        self.velocity = None if velocity is None else axes.to_blender(velocity, scale)
        self.normals = None if normal is None else axes.to_blender(normal)
        self.ids = file.columns["id"].astype("i4") if "id" in file.columns.dtype.names else None
        self.attributes = attributes_of(file, scale)

    def keep(self, rows):
        self.attributes = {name: numpy.ascontiguousarray(v[rows]) for name, v in self.attributes.items()}
        for name in ("points", "velocity", "normals", "ids"):
            values = getattr(self, name)
            if values is not None:
                setattr(self, name, numpy.ascontiguousarray(values[rows]))


@dataclasses.dataclass(frozen=True)
class FrameFiles:
    """Where a frame of a material lies."""
    material: str
    number: int
    surface: str
    particles: str

    def read(self, particles, scale=1.0):
        """Its surface, or its particles if these are wanted or no surface is there yet."""
        if not particles and os.path.exists(self.surface):
            return Frame(ply.read(self.surface), scale)
        file = ply.read(self.particles)
        frame = Frame(file, scale)
        if "material" in file.columns.dtype.names and file.materials:
            wanted = [index for index, name in file.materials.items() if name == self.material]
            frame.keep(numpy.isin(file.columns["material"], wanted))
        return frame


def numbered(folder, stem):
    """The numbers of the frames that a folder has as STEM_NNNNNN.ply."""
    if not os.path.isdir(folder):
        return []
    found = (NUMBERED.fullmatch(name) for name in os.listdir(folder))
    return sorted(int(m[2]) for m in found if m and m[1] == stem)


class RunFolder:
    def __init__(self, path):
        self.path = path

    def at(self, *parts):
        return os.path.join(self.path, *parts)

    def record(self):
        """run.json, or nothing where there is none."""
        try:
            with open(self.at("run.json"), encoding="utf-8") as file:
                return json.load(file)
        except FileNotFoundError:
            return {}
        except (OSError, ValueError) as error:
            raise DreampmError(f"{self.at('run.json')}: cannot be read: {error}") from error

    def particle_file(self, frame):
        return self.at("particles", f"particles_{frame:06}.ply")

    def surface_of(self, material, frame, meshed=None):
        """The mesh of a material. A run with one meshed material calls its files `surface`, others after the material.
        `meshed` are the names of these materials; without it, the files that are there tell."""
        own = len(meshed) > 1 if meshed is not None else bool(numbered(self.at("surface"), material))
        return self.at("surface", f"{material if own else 'surface'}_{frame:06}.ply")

    def has_foam(self):
        return bool(numbered(self.at("foam"), "foam"))

    def foam_files(self, number):
        """The same as `files`, of spray, foam, bubbles and dust. Nothing where the run has none."""
        frames = numbered(self.at("foam"), "foam")
        if not frames:
            return None
        number = min(max(number, 1), frames[-1])
        return FrameFiles("foam", number, "", self.at("foam", f"foam_{number:06}.ply"))

    def last_frame(self):
        frames = numbered(self.at("particles"), "particles")
        return frames[-1] if frames else 0

    def files(self, material, number):
        """Where a frame of a material lies. A number beyond the ends means the end. Nothing where the run has no
        frame."""
        last = self.last_frame()
        if not last:
            return None
        number = min(max(number, 1), last)
        return FrameFiles(material, number, self.surface_of(material, number), self.particle_file(number))

    def materials(self):
        """The names of the materials of a run that may be of anybody's, by its first frame."""
        numbers = numbered(self.at("particles"), "particles")
        if not numbers:
            raise DreampmError(f"{self.path}: no folder of a run: it has no particles/particles_000001.ply")
        return list(ply.read(self.particle_file(numbers[0])).materials.values())

    def poses(self):
        """Where each rigid body stands: {name: [(frame, matrix (4, 4) in the scene's axes)]}."""
        found = {}
        for frame in self.record().get("frames", []):
            for pose in frame.get("poses", []):
                found.setdefault(pose["name"], []).append((frame["frame"], pose_matrix(pose)))
        return found

    def forget_surfaces(self):
        """Meshes of an earlier run would be shown as those of this one."""
        shutil.rmtree(self.at("surface"), ignore_errors=True)

    def can_resume(self):
        return os.path.exists(self.at("scene.yaml")) and bool(numbered_checkpoints(self.at("checkpoint")))

    def is_whole(self, frames, meshed):
        """Whether all frames are there, with the surfaces of these materials."""
        return os.path.exists(self.particle_file(frames)) and all(
            os.path.exists(self.surface_of(name, frames, meshed)) for name in meshed)

    def free(self):
        """Removes what a run writes, and nothing else; the folder too if nothing is left in it."""
        if not os.path.isdir(self.path):
            return
        for name in FOLDERS:
            shutil.rmtree(self.at(name), ignore_errors=True)
        for name in FILES:
            if os.path.exists(self.at(name)):
                os.remove(self.at(name))
        if not os.listdir(self.path):
            os.rmdir(self.path)


def numbered_checkpoints(folder):
    return [name for name in os.listdir(folder) if name.endswith(".h5")] if os.path.isdir(folder) else []


def pose_matrix(pose):
    """A pose of run.json as a matrix (4, 4)."""
    w, x, y, z = (pose[k] for k in ("qw", "qx", "qy", "qz"))
    m = numpy.eye(4)
    m[:3, :3] = [[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                 [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                 [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]]
    m[:3, 3] = [pose[k] for k in ("x", "y", "z")]
    return m

"""A run as one Alembic file (.abc), for programs that read it: Blender, Houdini, Maya, Unreal.

    python -m dreampm.alembic out/dam-break
    dreampm.alembic.export("out/dam-break", "dam.abc", up="z", scale=100)

It holds the mesh of each material and of each collider, the particles of each material and the foam, with ids and
velocities, what vertices and particles hold besides, and the camera. Frames come from `dreampm export --to ply`. The
file is written by the package alembic3d (pip install alembic3d), an unofficial build of Alembic's own bindings.
"""
from __future__ import annotations

import argparse
import json
import math
import os
import pathlib
import shutil
import struct
import subprocess
import sys
import tempfile

import numpy as np

__all__ = ["export"]

_AT_ONCE = 16  # frames that lie in the temporary folder
_TYPES = {"char": "i1", "uchar": "u1", "short": "<i2", "ushort": "<u2", "int": "<i4", "uint": "<u4", "float": "<f4",
          "double": "<f8"}
_TRIPLES = {("x", "y", "z"): "P", ("nx", "ny", "nz"): "N", ("vx", "vy", "vz"): "v", ("red", "green", "blue"): "Cd"}


def export(run: str | os.PathLike, file: str | os.PathLike | None = None, *, up: str = "y", scale: float = 1.0,
           frames: str | None = None, what: str | None = None) -> pathlib.Path:
    """Writes frames of a run into one .abc and returns its path.

    file: RUN/export/NAME.abc if None. up: the axis that points up, "y" or "z". scale: units of the file a meter.
    frames: "A-B", else all. what: as `dreampm export --what`. Frame n is at n/fps, so that it is frame n of a program
    that shows fps frames a second. What stands at `file` is replaced once all of it is written. Raises ImportError
    without alembic3d, ValueError for a folder that is no run or lacks the frames, RuntimeError with the command's
    message where it refuses, OSError where the file cannot be written.
    """
    try:
        import alembic3d  # noqa: F401
    except ImportError as e:
        raise ImportError(f"alembic3d writes Alembic files, and cannot be imported ({e}): pip install alembic3d") from e
    folder = pathlib.Path(run)
    try:
        record = json.loads((folder / "run.json").read_text())
        there = [f["frame"] for f in record["frames"]]
    except (OSError, ValueError, KeyError, TypeError) as e:
        raise ValueError(f"{folder}: is no run's folder; dreampm run SCENE makes one: {e}") from e
    numbers = _chosen(there, frames, folder)
    target = pathlib.Path(file) if file is not None else folder / "export" / f"{_name_of(folder)}.abc"
    if target.suffix != ".abc":
        raise ValueError(f"{target}: an Alembic file ends with .abc")
    if target.is_dir():
        raise ValueError(f"{target}: is a folder; name a file")
    if target.parent.exists() and not target.parent.is_dir():
        raise ValueError(f"{target}: {target.parent} is no folder")
    options = ["--up", up, "--scale", repr(float(scale)), *(["--what", what] if what else [])]
    beside = target.with_name(f".{target.name}.{os.getpid()}.tmp")
    try:
        with tempfile.TemporaryDirectory(prefix="dreampm-alembic-") as temporary:
            _write(folder, record, numbers, options, up, scale, pathlib.Path(temporary), beside)
        os.replace(beside, target)
    except OSError as e:
        if e.filename != str(beside):
            raise
        raise OSError(e.errno, e.strerror, str(target)) from e  # the name that was asked for
    finally:
        if beside.is_file():
            beside.unlink()
    return target


def _name_of(folder: pathlib.Path) -> str:
    """The name of the scene, as the command calls its files."""
    for line in (folder / "scene.yaml").read_text().splitlines():
        if line.startswith("name:"):
            return line.split(":", 1)[1].strip().strip("\"'")
    return folder.name


def _chosen(there: list[int], wanted: str | None, folder: pathlib.Path) -> list[int]:
    if wanted is None:
        if not there:
            raise ValueError(f"{folder}: no frame is simulated; dreampm run makes them")
        return there
    ends = wanted.replace(":", "-").split("-")
    if not all(e.isdigit() for e in ends) or len(ends) > 2 or int(ends[0]) > int(ends[-1]):
        raise ValueError(f"frames is '{wanted}': must be A-B, such as 10-20")
    numbers = list(range(int(ends[0]), int(ends[-1]) + 1))
    missing = [n for n in numbers if n not in there]
    if missing:
        raise ValueError(f"{folder}: frame {missing[0]} is not simulated; it has {len(there)} frames")
    return numbers


def _command() -> str:
    """The command of this package, or the one that DREAMPM_COMMAND names, or that of the path."""
    own = pathlib.Path(__file__).parent / "bin" / "dreampm"
    found = os.environ.get("DREAMPM_COMMAND") or (str(own) if os.access(own, os.X_OK) else shutil.which("dreampm"))
    if not found:
        raise RuntimeError("the command dreampm is nowhere: put it into the PATH, or name it in DREAMPM_COMMAND")
    return found


def _run(folder, to, first, last, options, out) -> None:
    done = subprocess.run([_command(), "export", str(folder), "--to", to, "--frames", f"{first}-{last}", "--out",
                           str(out), *options], capture_output=True, text=True)
    if done.returncode != 0:
        raise RuntimeError(done.stderr.strip())


def _read_ply(file: pathlib.Path) -> tuple[dict[str, np.ndarray], np.ndarray | None, dict]:
    """Values of vertices by name, triangles or None, and what the header says: shift, materials, fps."""
    data = file.read_bytes()
    head, _, body = data.partition(b"end_header\n")
    about = {"shift": np.zeros(3), "materials": {}, "fps": None}
    fields, counts, element = [], {}, ""
    for words in (line.split() for line in head.decode().splitlines()):
        if words[:2] == ["comment", "shift"]:
            about["shift"] = np.array([float(w) for w in words[2:5]])
        elif words[:2] == ["comment", "material"]:
            about["materials"][int(words[2])] = words[3]
        elif words[:1] == ["comment"] and "frames a second" in " ".join(words):
            about["fps"] = float(words[words.index("frames") - 1])
        elif words[:1] == ["element"]:
            element, counts[words[1]] = words[1], int(words[2])
        elif words[:1] == ["property"] and element == "vertex":
            fields.append((words[2], _TYPES[words[1]]))
    kind = np.dtype(fields)
    rows = np.frombuffer(body, kind, counts["vertex"])
    columns = {name: rows[name] for name, _ in fields}
    faces = None
    if "face" in counts:
        corners = np.dtype([("count", "u1"), ("at", "<i4", (3,))])
        faces = np.frombuffer(body, corners, counts["face"], kind.itemsize * counts["vertex"])["at"]
    return columns, faces, about


def _joined(columns: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
    """Triples of columns as one, with three numbers a row; colors linear."""
    rest = dict(columns)
    out = {}
    vectors = {tuple(f"{n[:-2]}_{a}" for a in "xyz"): n[:-2] for n in columns if n.endswith("_x")}
    for names, name in {**_TRIPLES, **vectors}.items():
        if all(n in rest for n in names):
            out[name] = np.stack([np.asarray(rest.pop(n), np.float32) for n in names], axis=1)
    if "Cd" in out:
        srgb = out["Cd"] / 255
        out["Cd"] = np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055)**2.4).astype(np.float32)
    rest.pop("alpha", None)
    return {**out, **rest}


class _Thing:
    """A mesh or points of the file, below a transform that holds where places count from."""

    def __init__(self, top, time: int, name: str, is_mesh: bool, shift: np.ndarray):
        import imath
        from alembic3d import AbcGeom
        place = AbcGeom.OXform(top, name, time)
        sample = AbcGeom.XformSample()
        sample.setTranslation(imath.V3d(*map(float, shift)))
        place.getSchema().set(sample)
        self.is_mesh, self.time = is_mesh, time
        self.object = (AbcGeom.OPolyMesh if is_mesh else AbcGeom.OPoints)(place, f"{name}Shape", time)
        self.params: dict[str, object] = {}

    def add(self, values: dict[str, np.ndarray], faces: np.ndarray | None, width: float) -> None:
        from alembic3d import AbcGeom
        arrays = _Arrays()
        values = dict(values)
        places = arrays.vectors(values.pop("P"))
        velocity = values.pop("v", None)
        scope = AbcGeom.GeometryScope.kVertexScope
        if self.is_mesh:
            # A polygon of Alembic goes round the other way than one of PLY.
            corners = arrays.whole(faces[:, ::-1].reshape(-1))
            sample = AbcGeom.OPolyMeshSchemaSample(places, corners, arrays.whole(np.full(len(faces), 3)))
            if (normals := values.pop("N", None)) is not None:
                sample.setNormals(AbcGeom.ON3fGeomParamSample(arrays.vectors(normals), scope))
        else:
            sample = AbcGeom.OPointsSchemaSample(places, arrays.whole(values.pop("id")))
            radius = values.pop("radius", np.full(len(places), width / 2))
            sample.setWidths(AbcGeom.OFloatGeomParamSample(arrays.numbers(2 * radius), scope))
        if velocity is not None:
            sample.setVelocities(arrays.vectors(velocity))
        schema = self.object.getSchema()
        schema.set(sample)
        for name, column in values.items():
            kind, sample_kind, data = _param(arrays, name, column)
            if name not in self.params:
                self.params[name] = kind(schema.getArbGeomParams(), name, False, scope, 1, self.time)
            self.params[name].set(sample_kind(data, scope))


def _param(arrays: "_Arrays", name: str, column: np.ndarray):
    """What holds a column: the class of the parameter, of its sample, and the values."""
    from alembic3d import AbcGeom
    if name == "Cd":
        return AbcGeom.OC3fGeomParam, AbcGeom.OC3fGeomParamSample, arrays.colors(column)
    if column.ndim == 2:
        return AbcGeom.OV3fGeomParam, AbcGeom.OV3fGeomParamSample, arrays.vectors(column)
    if column.dtype.kind in "iu":
        return AbcGeom.OInt32GeomParam, AbcGeom.OInt32GeomParamSample, arrays.whole(column)
    return AbcGeom.OFloatGeomParam, AbcGeom.OFloatGeomParamSample, arrays.numbers(column)


class _Arrays:
    """Arrays as Alembic takes them. Samples look into their memory and do not own it: this does, until all is written."""

    def __init__(self):
        self.kept: list[object] = []

    def _from(self, values: np.ndarray, kind, make):
        memory = np.array(values, dtype=kind, order="C")
        self.kept += [memory, make(memory)]
        return self.kept[-1]

    def vectors(self, values: np.ndarray):
        import imath
        return self._from(values, np.float32, imath.V3fArrayFromBuffer)

    def numbers(self, values: np.ndarray):
        import imath
        return self._from(values, np.float32, imath.FloatArrayFromBuffer)

    def whole(self, values: np.ndarray):
        import imath
        return self._from(values, np.int32, imath.IntArrayFromBuffer)

    def colors(self, values: np.ndarray):
        import imath
        out = imath.C3fArray(len(values))
        for i, c in enumerate(values.tolist()):
            out[i] = imath.Color3f(*c)
        self.kept.append(out)
        return out


class _Archive:
    """Its file is whole once nothing refers to it."""

    def __init__(self, file: pathlib.Path, fps: float, first: int):
        from alembic3d import Abc, AbcCoreAbstract
        file.parent.mkdir(parents=True, exist_ok=True)
        file.touch()  # its error says more than Alembic's
        self.archive = Abc.OArchive(str(file))
        self.time = self.archive.addTimeSampling(AbcCoreAbstract.TimeSampling(1 / fps, first / fps))
        self.things: dict[str, _Thing] = {}

    def add(self, name: str, values, faces, shift, width: float) -> None:
        if name not in self.things:
            self.things[name] = _Thing(self.archive.getTop(), self.time, name, faces is not None, shift)
        self.things[name].add(_joined(values), faces, width)


def _write(folder, record, numbers, options, up, scale, temporary, file) -> None:
    width = record["spacing"] * scale
    archive = None
    for start in range(0, len(numbers), _AT_ONCE):
        part = numbers[start:start + _AT_ONCE]
        _run(folder, "ply", part[0], part[-1], options, temporary)
        for number in part:
            for path in sorted(temporary.glob(f"*_{number:06}.ply")):
                values, faces, about = _read_ply(path)
                archive = archive or _Archive(file, about["fps"], numbers[0])
                stem = path.name.rsplit("_", 1)[0]
                kinds = values.pop("material", None)
                if stem == "particles":
                    for m, name in about["materials"].items():
                        archive.add(name, {k: v[kinds == m] for k, v in values.items()}, None, about["shift"], width)
                else:
                    archive.add(stem, values, faces, about["shift"], width)
                path.unlink()
    _add_camera(archive, folder, numbers[0], options, up, scale, temporary)


def _add_camera(archive, folder, number, options, up, scale, temporary) -> None:
    import imath
    from alembic3d import AbcGeom
    what = options[options.index("--what"):] if "--what" in options else []
    _run(folder, "gltf", number, number, ["--scale", repr(float(scale)), *what], temporary)
    [glb] = temporary.glob("*.glb")
    data = glb.read_bytes()
    size, = struct.unpack_from("<I", data, 12)
    document = json.loads(data[20:20 + size])
    lens = document["cameras"][0]["perspective"]
    [node] = [n for n in document["nodes"] if "camera" in n]
    rows = np.array(node["matrix"]).reshape(4, 4)  # Alembic multiplies from the left, too
    if up == "z":
        rows = rows @ np.array([[1, 0, 0, 0], [0, 0, 1, 0], [0, -1, 0, 0], [0, 0, 0, 1.0]])
    place = AbcGeom.OXform(archive.archive.getTop(), "camera", archive.time)
    sample = AbcGeom.XformSample()
    sample.setMatrix(imath.M44d(*[float(v) for v in rows.reshape(-1)]))
    place.getSchema().set(sample)
    camera = AbcGeom.OCamera(place, "cameraShape", archive.time)
    film = 2.4  # cm, the height
    view = AbcGeom.CameraSample()
    view.setVerticalAperture(film)
    view.setHorizontalAperture(film * lens["aspectRatio"])
    view.setFocalLength(10 * film / 2 / math.tan(lens["yfov"] / 2))  # mm
    view.setNearClippingPlane(lens["znear"])
    view.setFarClippingPlane(lens["zfar"])
    camera.getSchema().set(view)


def main() -> int:
    parser = argparse.ArgumentParser(prog="python -m dreampm.alembic", description="Write a run as one Alembic file.")
    parser.add_argument("run", help="a run's folder")
    parser.add_argument("--out", help="the file (default: RUN/export/NAME.abc)")
    parser.add_argument("--up", choices=["y", "z"], default="y", help="the axis that points up in the file")
    parser.add_argument("--scale", type=float, default=1.0, help="units of the file a meter")
    parser.add_argument("--frames", help="only frames A-B, both included")
    parser.add_argument("--what", help="particles, surface, foam, colliders or all (default: what there is)")
    a = parser.parse_args()
    try:
        print(export(a.run, a.out, up=a.up, scale=a.scale, frames=a.frames, what=a.what))
    except (ImportError, OSError, ValueError, RuntimeError) as e:
        print(f"dreampm.alembic: {e}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())

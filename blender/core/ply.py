# SPDX-License-Identifier: GPL-3.0-or-later
"""PLY files: meshes for a scene, and the meshes and particles that the command writes."""
import os

import numpy

from .errors import DreampmError

TYPES = {"char": "i1", "int8": "i1", "uchar": "u1", "uint8": "u1", "short": "i2", "int16": "i2", "ushort": "u2",
         "uint16": "u2", "int": "i4", "int32": "i4", "uint": "u4", "uint32": "u4", "float": "f4", "float32": "f4",
         "double": "f8", "float64": "f8"}


def write_mesh(path, vertices, triangles):
    """Writes a mesh, (n, 3) [m] and (m, 3), under a temporary name and renames it."""
    vertices = numpy.ascontiguousarray(vertices, dtype="<f8").reshape(-1, 3)
    triangles = numpy.ascontiguousarray(triangles, dtype="<i4").reshape(-1, 3)
    faces = numpy.empty(len(triangles), dtype=[("n", "u1"), ("v", "<i4", 3)])
    faces["n"], faces["v"] = 3, triangles
    head = ("ply\nformat binary_little_endian 1.0\ncomment written by DreaMPM for Blender, meters, Y up\n"
            f"element vertex {len(vertices)}\nproperty double x\nproperty double y\nproperty double z\n"
            f"element face {len(triangles)}\nproperty list uchar int vertex_indices\nend_header\n")
    temporary = f"{path}.tmp"
    with open(temporary, "wb") as out:
        out.write(head.encode())
        out.write(vertices.tobytes())
        out.write(faces.tobytes())
    os.replace(temporary, path)


class Ply:
    """A file that was read: columns of its vertices by name, triangles, and the material names of particles."""

    def __init__(self, columns, triangles, comments):
        self.columns = columns
        self.triangles = triangles
        self.materials, self.shift = {}, numpy.zeros(3)
        for comment in comments:
            words = comment.split(" ")
            if words[0] == "material" and len(words) > 2:
                self.materials[int(words[1])] = " ".join(words[2:])
            elif words[0] == "shift" and len(words) == 4:
                self.shift = numpy.array([float(w) for w in words[1:]])

    def vectors(self, names):
        """Three columns as (n, 3) float32, or None where one is not there."""
        if any(name not in self.columns.dtype.names for name in names):
            return None
        return numpy.stack([self.columns[name].astype("f4") for name in names], axis=1)

    def places(self):
        """Where the vertices are in the scene [m]: float32, but double where the file has a shift."""
        places = self.vectors(("x", "y", "z"))
        return places + self.shift if self.shift.any() else places

    def velocities(self):
        return self.vectors(("vx", "vy", "vz"))

    def normals(self):
        return self.vectors(("nx", "ny", "nz"))

    def __len__(self):
        return len(self.columns)


def read_header(file, path):
    """The elements [(name, count, [(property, type or None for a list of triangles)])], and the comments."""
    if file.readline().strip() != b"ply":
        raise DreampmError(f"{path}: no PLY file")
    elements, comments, binary = [], [], False
    while True:
        line = file.readline()
        if not line:
            raise DreampmError(f"{path}: ends within its header")
        words = line.decode("utf-8", "replace").rstrip("\r\n").split(" ")
        if words[0] == "end_header":
            break
        if words[0] == "format":
            binary = words[1] == "binary_little_endian"
        elif words[0] == "comment":
            comments.append(" ".join(words[1:]))
        elif words[0] == "element":
            elements.append((words[1], int(words[2]), []))
        elif words[0] == "property" and elements:
            if words[1] == "list":
                if TYPES.get(words[2]) != "u1" or TYPES.get(words[3]) not in ("i4", "u4"):
                    raise DreampmError(f"{path}: faces of {words[2]} and {words[3]}; uchar and int are read")
                elements[-1][2].append((words[4], None))
            elif words[1] in TYPES:
                elements[-1][2].append((words[2], "<" + TYPES[words[1]]))
            else:
                raise DreampmError(f"{path}: a property of the unknown type {words[1]}")
    if not binary:
        raise DreampmError(f"{path}: only binary little-endian PLY files are read here, as dreampm writes them")
    return elements, comments


def read(path):
    """Reads what dreampm writes: binary little-endian, plain values for vertices, triangles for faces."""
    try:
        with open(path, "rb") as file:
            elements, comments = read_header(file, path)
            columns, triangles = None, numpy.empty((0, 3), dtype="i4")
            for name, count, properties in elements:
                rows = numpy.fromfile(file, count=count, dtype=[
                    field for p, kind in properties
                    for field in ([(p, kind)] if kind else [(p + "_n", "u1"), (p, "<i4", 3)])])
                if len(rows) != count:
                    raise DreampmError(f"{path}: holds {len(rows)} of {count} rows of {name}: it was cut off")
                if name == "vertex":
                    columns = rows
                elif name == "face":
                    corners = next((p for p, kind in properties if kind is None), None)
                    if corners is None or not (rows[corners + "_n"] == 3).all():
                        raise DreampmError(f"{path}: only faces of three corners are read")
                    triangles = rows[corners]
    except OSError as error:
        raise DreampmError(f"{path}: {error.strerror}") from error
    if columns is None:
        raise DreampmError(f"{path}: has no vertices")
    return Ply(columns, triangles, comments)

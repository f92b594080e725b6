"""Particles of other programs: written by VTK, or by the layout of a format, read by `dreampm`."""
import os
import pathlib
import struct
import subprocess

import numpy as np
import pytest
import trimesh
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData, vtkUnstructuredGrid
from vtkmodules.vtkFiltersSources import vtkSphereSource
from vtkmodules.vtkIOHDF import vtkHDFWriter
from vtkmodules.vtkIOLegacy import vtkPolyDataWriter
from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter, vtkXMLUnstructuredGridWriter

from test_export import COMMAND, SCENE, columns, dreampm, read_ply

N = 1000
RANDOM = np.random.default_rng(1)
POINTS = (np.stack(np.meshgrid(*[np.arange(10)] * 3), axis=-1).reshape(-1, 3) * 0.1 +
          RANDOM.uniform(-0.01, 0.01, (N, 3))).astype("f4")
VELOCITY = RANDOM.normal(size=(N, 3)).astype("f4")
IDS = RANDOM.permutation(N).astype("i4") + 7
COLORS = RANDOM.integers(0, 256, (N, 3)).astype("u1")


def named(values, name):
    array = numpy_to_vtk(values, deep=True)
    array.SetName(name)
    return array


def with_arrays(data):
    points = vtkPoints()
    points.SetData(numpy_to_vtk(POINTS, deep=True))
    data.SetPoints(points)
    for array in (named(np.arange(N, dtype="f8"), "pressure"), named(VELOCITY, "Velocity"), named(IDS, "id"),
                  named(COLORS, "rgb")):
        data.GetPointData().AddArray(array)
    data.GetPointData().SetActiveScalars("pressure")
    data.GetPointData().SetActiveVectors("Velocity")
    return data


def cloud(verts=True):
    data = with_arrays(vtkPolyData())
    if verts:
        cells = vtkCellArray()
        for i in range(N):
            cells.InsertNextCell(1, [i])
        data.SetVerts(cells)
    return data


def write(writer, data, file):
    writer.SetFileName(str(file))
    writer.SetInputData(data)
    assert writer.Write()


def legacy(binary, version):
    def save(folder):
        writer = vtkPolyDataWriter()
        writer.SetFileVersion(version)
        writer.SetFileTypeToBinary() if binary else writer.SetFileTypeToASCII()
        write(writer, cloud(), folder / "cloud.vtk")
        return folder / "cloud.vtk"
    return save


def xml(mode, encoded=True, packed=True, wide=True, big=False, unstructured=False):
    def save(folder):
        writer = vtkXMLUnstructuredGridWriter() if unstructured else vtkXMLPolyDataWriter()
        getattr(writer, f"SetDataModeTo{mode}")()
        writer.SetEncodeAppendedData(encoded)
        writer.SetCompressorTypeToZLib() if packed else writer.SetCompressorTypeToNone()
        writer.SetHeaderTypeToUInt64() if wide else writer.SetHeaderTypeToUInt32()
        writer.SetByteOrderToBigEndian() if big else writer.SetByteOrderToLittleEndian()
        writer.SetBlockSize(1024)
        file = folder / ("cloud.vtu" if unstructured else "cloud.vtp")
        write(writer, with_arrays(vtkUnstructuredGrid()) if unstructured else cloud(verts=False), file)
        return file
    return save


def hdf(folder):
    write(vtkHDFWriter(), cloud(), folder / "cloud.vtkhdf")
    return folder / "cloud.vtkhdf"


def bgeo(folder):
    """By SideFX's description of the classic format, as Partio writes it."""
    text = lambda s: struct.pack(">H", len(s)) + s.encode()
    out = b"BgeoV" + struct.pack(">9i", 5, N, 1, 0, 0, 3, 0, 1, 0)
    out += text("v") + struct.pack(">Hi3f", 3, 5, 0, 0, 0)
    out += text("id") + struct.pack(">Hii", 1, 1, 0)
    out += text("Cd") + struct.pack(">Hi3f", 3, 5, 0, 0, 0)
    for x, v, i, c in zip(POINTS, VELOCITY, IDS, COLORS):
        out += struct.pack(">4f3fi3f", *x, 1, *v, i, *(c / 255))
    out += text("generator") + struct.pack(">Hii", 1, 4, 1) + text("papi") + struct.pack(">ii", 0x8000, N)
    (folder / "cloud.bgeo").write_bytes(out)
    return folder / "cloud.bgeo"


WRITERS = {"vtk-ascii": legacy(False, 51), "vtk-binary": legacy(True, 51), "vtk-4-binary": legacy(True, 42),
           "vtk-4-ascii": legacy(False, 42), "vtp-ascii": xml("Ascii"), "vtp-binary": xml("Binary"),
           "vtp-binary-plain": xml("Binary", packed=False, wide=False), "vtp-appended": xml("Appended"),
           "vtp-raw": xml("Appended", encoded=False), "vtp-raw-big": xml("Appended", encoded=False, packed=False, big=True),
           "vtu": xml("Appended", wide=False, unstructured=True), "vtkhdf": hdf, "bgeo": bgeo}


@pytest.mark.parametrize("name", WRITERS)
def test_points_velocities_ids_and_colors(tmp_path, name):
    file = WRITERS[name](tmp_path)
    dreampm(tmp_path, "points", file, "--spacing", "0.1", "--scale", "2", "--out", "back.ply")
    _, back = read_ply(tmp_path / "back.ply")
    near = dict(rtol=1e-5, atol=1e-6)
    np.testing.assert_allclose(columns(back, "x y z"), 2 * POINTS, **near)
    np.testing.assert_allclose(columns(back, "vx vy vz"), 2 * VELOCITY, **near)
    np.testing.assert_array_equal(back["id"], IDS)
    np.testing.assert_array_equal(columns(back, "red green blue"), COLORS)


def test_a_scene_takes_them_with_their_velocities(tmp_path):
    xml("Appended")(tmp_path)
    (tmp_path / "scene.yaml").write_text("""dreampm: 1
name: cloud
space: {min: [0, 0, 0], max: [2, 2, 2], spacing: 0.1}
time: {fps: 50, frames: 1}
gravity: [0, 0, 0]
materials: {jelly: {type: elastic, youngs_modulus: 1e4, poissons_ratio: 0.3}}
bodies: {cloud: {material: jelly, shape: {points: cloud.vtp, center: [1, 1, 1]}}}
output: {folder: run}
""")
    dreampm(tmp_path, "run", "scene.yaml")
    _, start = read_ply(tmp_path / "run/particles/particles_000001.ply")
    middle = (POINTS.min(axis=0) + POINTS.max(axis=0)) / 2
    np.testing.assert_allclose(columns(start, "x y z"), POINTS - middle + 1, atol=1e-5)
    np.testing.assert_allclose(columns(start, "vx vy vz"), VELOCITY, atol=1e-4)


def test_surfaces_of_a_sequence(tmp_path):
    files = []
    for n, save in enumerate((xml("Appended"), legacy(True, 51), bgeo)):
        file = save(tmp_path)
        files.append(file.rename(tmp_path / f"fluid.{n}{file.suffix}"))
    made = dreampm(tmp_path, "surface", *files, "--spacing", "0.1", "--out", "meshes")
    assert made == [f"meshes/fluid.{n}.ply" for n in range(3)]
    volumes = []
    for name in made:
        mesh = trimesh.load(tmp_path / name, process=False)
        assert mesh.is_watertight
        volumes.append(mesh.volume)
        _, vertices = read_ply(tmp_path / name)
        assert {"vx", "vy", "vz"} <= set(vertices.dtype.names)
    assert volumes == pytest.approx([1, 1, 1], rel=0.1) and np.ptp(volumes) < 1e-6


def test_what_export_wrote(tmp_path):
    """Of a time series the first step is taken, of particles and of surfaces."""
    (tmp_path / "scene.yaml").write_text(SCENE)
    dreampm(tmp_path, "run", "scene.yaml")
    dreampm(tmp_path, "surface", "run")
    particles, surface = dreampm(tmp_path, "export", "run", "--to", "vtkhdf")
    _, own = read_ply(tmp_path / "run/particles/particles_000001.ply")
    dreampm(tmp_path, "points", particles, "--spacing", "0.03", "--out", "back.ply")
    _, back = read_ply(tmp_path / "back.ply")
    for names in ("x y z", "vx vy vz", "id", "red green blue alpha"):
        np.testing.assert_array_equal(columns(back, names), columns(own, names))
    faces = sum(len(trimesh.load(tmp_path / f"run/surface/{name}_000001.ply", process=False).faces)
                for name in ("water", "jelly"))
    words = dreampm(tmp_path, "info", surface)
    assert words[words.index("triangles") + 1] == f"{faces:,}"


def test_a_mesh_of_vtk(tmp_path):
    sphere = vtkSphereSource()
    sphere.SetRadius(0.5)
    sphere.Update()
    write(vtkXMLPolyDataWriter(), sphere.GetOutput(), tmp_path / "ball.vtp")
    legacy_writer = vtkPolyDataWriter()
    legacy_writer.SetFileTypeToBinary()
    write(legacy_writer, sphere.GetOutput(), tmp_path / "ball2.vtk")
    for file in ("ball.vtp", "ball2.vtk"):
        said = " ".join(dreampm(tmp_path, "info", file))
        assert said.startswith("kind mesh count 50") and said.endswith("open_edges 0 triangles 96"), said
    refused = subprocess.run([COMMAND, "surface", "ball.vtp", "--spacing", "0.1"], cwd=tmp_path, capture_output=True,
                             text=True)
    assert refused.returncode == 2 and "ball.vtp: is a mesh; dreampm surface wraps particles" in refused.stderr

"""What `dreampm export` writes, read back by the programs that it is for."""
import json
import os
import pathlib
import struct
import subprocess

import numpy as np
import pytest
import trimesh
from pxr import Gf, Usd, UsdGeom, UsdShade
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOHDF import vtkHDFReader

COMMAND = pathlib.Path(os.environ["DREAMPM_COMMAND"])
FPS = 50
SCALE = 100  # centimeters
SCENE = pathlib.Path(__file__).with_name("two-things.yaml").read_text() + """\
output: {folder: run, particles: {attributes: [velocity, j, f, color]}}
render: {size: [64, 36], samples: 4, noise: 0.1}
"""


ORANGE = (1, ((0.5 + 0.055) / 1.055)**2.4, 0)  # what the cube's color in sRGB is in linear light


def dreampm(folder, *words):
    done = subprocess.run([COMMAND, *map(str, words)], cwd=folder, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return done.stdout.split()


def read_ply(file):
    """Header lines, and the vertices as a structured array."""
    data = file.read_bytes()
    head, body = data.split(b"end_header\n", 1)
    lines = head.decode().splitlines()
    types = {"float": "<f4", "int": "<i4", "uchar": "u1"}
    count, fields = 0, []
    for line in lines:
        words = line.split()
        if words[:2] == ["element", "vertex"]:
            count = int(words[2])
        elif words[0] == "element":
            break
        elif words[0] == "property":
            fields.append((words[2], types[words[1]]))
    return lines, np.frombuffer(body, np.dtype(fields), count)


def columns(vertices, names):
    return np.stack([vertices[n] for n in names.split()], axis=1)


def z_up(v):
    return np.stack([v[:, 0], -v[:, 2], v[:, 1]], axis=1)


class Run:
    """A run of three frames, and what its own files say of them."""

    def __init__(self, folder):
        self.folder = folder
        (folder / "scene.yaml").write_text(SCENE)
        dreampm(folder, "run", "scene.yaml")
        dreampm(folder, "surface", "run")
        self.particles = [read_ply(folder / f"run/particles/particles_{n:06}.ply")[1] for n in (1, 2, 3)]
        self.meshes = {name: [trimesh.load(folder / f"run/surface/{name}_{n:06}.ply", process=False)
                              for n in (1, 2, 3)] for name in ("water", "jelly")}

    def export(self, to, *more):
        return [self.folder / name for name in dreampm(self.folder, "export", "run", "--to", to, *more)]

    def of(self, frame, material):
        return self.particles[frame][self.particles[frame]["material"] == material]


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    return Run(tmp_path_factory.mktemp("export"))


@pytest.fixture(scope="module")
def stage(run):
    return Usd.Stage.Open(str(run.export("usd", "--up", "z", "--scale", SCALE, "--out", "z.usda")[0]))


def test_usd_has_units_axis_and_rate(stage):
    assert UsdGeom.GetStageUpAxis(stage) == "Z"
    assert UsdGeom.GetStageMetersPerUnit(stage) == pytest.approx(0.01)
    assert stage.GetTimeCodesPerSecond() == FPS and stage.GetFramesPerSecond() == FPS
    assert (stage.GetStartTimeCode(), stage.GetEndTimeCode()) == (1, 3)
    assert stage.GetDefaultPrim().GetPath() == "/two_things"


@pytest.mark.parametrize("material,name", [(0, "water"), (1, "jelly")])
def test_usd_points(run, stage, material, name):
    points = UsdGeom.Points.Get(stage, f"/two_things/{name}")
    assert points.GetPointsAttr().GetTimeSamples() == [1, 2, 3]
    assert list(points.GetWidthsAttr().Get()) == pytest.approx([0.03 * SCALE])
    for n in (1, 2, 3):
        own = run.of(n - 1, material)
        where = z_up(columns(own, "x y z")) * SCALE
        np.testing.assert_allclose(points.GetPointsAttr().Get(n), where, rtol=1e-6, atol=1e-4)
        np.testing.assert_allclose(points.GetVelocitiesAttr().Get(n), z_up(columns(own, "vx vy vz")) * SCALE,
                                   rtol=1e-6, atol=1e-4)
        np.testing.assert_array_equal(points.GetIdsAttr().Get(n), own["id"])
        low, high = points.GetExtentAttr().Get(n)
        assert np.all(np.array(low) < where.min(axis=0)) and np.all(np.array(high) > where.max(axis=0))
        j = UsdGeom.PrimvarsAPI(points).GetPrimvar("j")
        assert j.GetInterpolation() == "vertex"
        np.testing.assert_allclose(j.Get(n), own["j"])
    color = UsdGeom.PrimvarsAPI(points).GetPrimvar("displayColor").Get(1)
    assert len(color) == len(run.of(0, material))
    look = UsdShade.Shader.Get(stage, f"/two_things/Looks/{name}/shader").GetInput("diffuseColor").Get()
    assert np.allclose(color, ORANGE if name == "jelly" else look, atol=1e-6)
    assert name == "jelly" or tuple(look) != (1, 1, 1)


@pytest.mark.parametrize("name", ["water", "jelly"])
def test_usd_mesh(run, stage, name):
    mesh = UsdGeom.Mesh.Get(stage, f"/two_things/{name}_surface")
    assert mesh.GetSubdivisionSchemeAttr().Get() == "none"
    for n in (1, 2, 3):
        own = run.meshes[name][n - 1]
        points = np.array(mesh.GetPointsAttr().Get(n))
        np.testing.assert_allclose(points, z_up(own.vertices) * SCALE, rtol=1e-6, atol=1e-4)
        assert list(mesh.GetFaceVertexCountsAttr().Get(n)) == [3] * len(own.faces)
        faces = np.array(mesh.GetFaceVertexIndicesAttr().Get(n)).reshape(-1, 3)
        np.testing.assert_array_equal(faces, own.faces)
        # Faces still look outward: a turn of the axes is no reflection.
        assert trimesh.Trimesh(points, faces, process=False).volume == pytest.approx(own.volume * SCALE**3, rel=1e-4)
        assert len(mesh.GetVelocitiesAttr().Get(n)) == len(points)
        assert len(mesh.GetNormalsAttr().Get(n)) == len(points)
    fastest = np.linalg.norm(mesh.GetVelocitiesAttr().Get(2), axis=1).max()
    assert 0.2 * SCALE < fastest < 5 * SCALE if name == "water" else fastest > 0
    bound = UsdShade.MaterialBindingAPI(mesh).ComputeBoundMaterial()[0]
    assert bound.GetPath() == f"/two_things/Looks/{name}"
    assert UsdShade.Shader(bound.ComputeSurfaceSource()[0]).GetIdAttr().Get() == "UsdPreviewSurface"


def test_usd_camera_sees_the_basin(stage):
    camera = UsdGeom.Camera.Get(stage, "/two_things/camera").GetCamera(1)
    assert camera.GetFieldOfView(Gf.Camera.FOVVertical) == pytest.approx(34, abs=1e-3)
    assert camera.aspectRatio == pytest.approx(64 / 36)
    for corner in np.ndindex(2, 2, 2):
        x, y, z = np.array(corner) * (0.6, 0.4, 0.3) * SCALE
        seen = camera.frustum.ComputeViewMatrix().Transform(Gf.Vec3d(x, -z, y))
        assert seen[2] < 0, "before the camera"
        assert camera.frustum.Intersects(Gf.Vec3d(x, -z, y))


def step(file, n):
    reader = vtkHDFReader()
    reader.SetFileName(str(file))
    reader.UpdateInformation()
    info = reader.GetOutputInformation(0)
    from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline as Pipeline
    times = [info.Get(Pipeline.TIME_STEPS(), i) for i in range(info.Length(Pipeline.TIME_STEPS()))]
    reader.UpdateTimeStep(times[n])
    return times, reader.GetOutputDataObject(0)


def array(data, name):
    return vtk_to_numpy(data.GetPointData().GetArray(name))


def test_vtkhdf(run):
    particles, surface = run.export("vtkhdf")
    for n in range(3):
        own = run.particles[n]
        times, data = step(particles, n)
        assert times == pytest.approx([0, 1 / FPS, 2 / FPS])
        assert data.GetNumberOfVerts() == data.GetNumberOfPoints() == len(own)
        np.testing.assert_array_equal(vtk_to_numpy(data.GetPoints().GetData()), columns(own, "x y z"))
        np.testing.assert_array_equal(array(data, "velocity"), columns(own, "vx vy vz"))
        for name in ("id", "material", "j", "f_01"):
            np.testing.assert_array_equal(array(data, name), own[name])
        np.testing.assert_array_equal(array(data, "color"), columns(own, "red green blue alpha"))

        times, data = step(surface, n)
        assert len(times) == 3
        parts = [run.meshes[name][n] for name in ("water", "jelly")]
        assert data.GetNumberOfPolys() == sum(len(p.faces) for p in parts)
        points = vtk_to_numpy(data.GetPoints().GetData())
        np.testing.assert_array_equal(points, np.concatenate([p.vertices for p in parts]).astype("f4"))
        faces = vtk_to_numpy(data.GetPolys().GetConnectivityArray()).reshape(-1, 3)
        np.testing.assert_array_equal(faces[-len(parts[1].faces):], parts[1].faces + len(parts[0].vertices))
        assert list(np.bincount(array(data, "material"))) == [len(p.vertices) for p in parts]
        assert array(data, "velocity").shape == array(data, "Normals").shape == points.shape


def test_vtkhdf_of_one_kind_and_some_frames(run):
    [file] = run.export("vtkhdf", "--what", "particles", "--frames", "2:3", "--scale", "10", "--up", "z", "--out",
                        "some.vtkhdf")
    times, data = step(file, 0)
    assert times == pytest.approx([1 / FPS, 2 / FPS])
    np.testing.assert_allclose(vtk_to_numpy(data.GetPoints().GetData()),
                               10 * z_up(columns(run.particles[1], "x y z")), rtol=1e-6, atol=1e-6)


def test_gltf(run):
    [folder] = run.export("gltf", "--scale", "2")
    files = sorted(folder.iterdir())
    assert [f.name for f in files] == [f"two-things_{n:06}.glb" for n in (1, 2, 3)]
    for n, file in enumerate(files):
        scene = trimesh.load(file, process=False)
        for name in ("water", "jelly"):
            mesh, own = scene.geometry[f"{name}-surface"], run.meshes[name][n]
            np.testing.assert_allclose(mesh.vertices, 2 * own.vertices, rtol=1e-6)
            np.testing.assert_array_equal(mesh.faces, own.faces)
            assert np.asarray(mesh.vertex_attributes["_VELOCITY"]).shape == mesh.vertices.shape
        points = scene.geometry["jelly"]
        np.testing.assert_allclose(points.vertices, 2 * columns(run.of(n, 1), "x y z"), rtol=1e-6)
        assert scene.camera.fov[1] == pytest.approx(34, abs=1e-3)
        data = file.read_bytes()
        length = struct.unpack_from("<I", data, 12)[0]
        tree, buffer = json.loads(data[20:20 + length]), data[28 + length:]
        assert tree["asset"]["extras"] == {"frame": n + 1, "time": pytest.approx(n / FPS), "fps": FPS, "units": "a unit of 0.5 m, Y up"}
        water = next(m for m in tree["materials"] if m["name"] == "water")["pbrMetallicRoughness"]["baseColorFactor"][:3]
        for name, linear in (("jelly", ORANGE), ("water", water)):
            [points] = [m["primitives"][0] for m in tree["meshes"] if m["name"] == name]
            accessor = tree["accessors"][points["attributes"]["COLOR_0"]]
            assert (accessor["componentType"], accessor["type"], accessor.get("normalized")) == (5126, "VEC3", None)
            view = tree["bufferViews"][accessor["bufferView"]]
            colors = np.frombuffer(buffer, "<f4", 3 * accessor["count"], view["byteOffset"]).reshape(-1, 3)
            np.testing.assert_allclose(colors, np.tile(linear, (len(colors), 1)), atol=1e-6)
            # Programs multiply both.
            assert tree["materials"][points["material"]]["pbrMetallicRoughness"]["baseColorFactor"] == [1, 1, 1, 1]


def test_ply_and_obj(run):
    [ply] = run.export("ply", "--up", "z", "--scale", SCALE)
    [obj] = run.export("obj", "--up", "z", "--scale", SCALE)
    for n in (1, 2, 3):
        own = run.particles[n - 1]
        head, back = read_ply(ply / f"particles_{n:06}.ply")
        assert f"comment dreampm particles, a unit of 0.01 m, Z up; frame {n}, time {(n - 1) / FPS:g} s, 50 frames a second" in head
        np.testing.assert_allclose(columns(back, "x y z"), SCALE * z_up(columns(own, "x y z")), rtol=1e-6, atol=1e-4)
        np.testing.assert_allclose(columns(back, "vx vy vz"), SCALE * z_up(columns(own, "vx vy vz")), rtol=1e-6,
                                   atol=1e-4)
        turn = np.array([[1, 0, 0], [0, 0, -1], [0, 1, 0]])
        gradient = lambda v: np.stack([v[f"f_{i}{j}"] for i in range(3) for j in range(3)], axis=1).reshape(-1, 3, 3)
        np.testing.assert_allclose(gradient(back), turn @ gradient(own) @ turn.T, atol=1e-6)
        cloud = trimesh.load(obj / f"particles_{n:06}.obj", process=False)
        np.testing.assert_allclose(cloud.vertices, SCALE * z_up(columns(own, "x y z")), rtol=1e-6, atol=1e-4)
        for name in ("water", "jelly"):
            mesh = run.meshes[name][n - 1]
            for file in (ply / f"{name}-surface_{n:06}.ply", obj / f"{name}-surface_{n:06}.obj"):
                back = trimesh.load(file, process=False)
                assert len(back.faces) == len(mesh.faces) and back.is_watertight
                np.testing.assert_allclose(back.bounds, trimesh.PointCloud(SCALE * z_up(mesh.vertices)).bounds,
                                           rtol=1e-5, atol=1e-3)
                assert back.volume == pytest.approx(mesh.volume * SCALE**3, rel=1e-4)


ZOO = """dreampm: 1
name: zoo
space: {min: [0, 0, 0], max: [0.4, 0.4, 0.4], spacing: 0.04}
time: {fps: 50, frames: 3}
materials: {water: {type: newtonian, max_compression: 0.05}}
bodies: {pool: {material: water, shape: {box: {min: [0, 0, 0], max: [0.4, 0.08, 0.12]}}}}
colliders: {post: {shape: {box: {min: [0.3, 0, 0.3], max: [0.36, 0.2, 0.36]}}}}
rigid: {crate: {shape: {box: {size: [0.1, 0.1, 0.1]}}, density: 400, position: [0.2, 0.3, 0.25], spin: [0, 20, 0]}}
"""


def test_crates_stand_in_usd_and_vtkhdf_where_the_run_has_them(tmp_path):
    (tmp_path / "zoo.yaml").write_text(ZOO)
    dreampm(tmp_path, "run", "zoo.yaml", "--out", "run")
    dreampm(tmp_path, "export", "run", "--to", "usd", "--what", "colliders", "--up", "z", "--scale", SCALE)
    dreampm(tmp_path, "export", "run", "--to", "vtkhdf", "--what", "colliders")
    poses = [frame["poses"] for frame in json.loads((tmp_path / "run/run.json").read_text())["frames"]]
    assert len(poses) == 3 and all(one["name"] == "crate" for (one,) in poses)
    stage = Usd.Stage.Open(str(tmp_path / "run/export/zoo.usda"))
    crate = UsdGeom.Mesh(stage.GetPrimAtPath("/zoo/crate"))
    reader = vtkHDFReader()
    reader.SetFileName(str(tmp_path / "run/export/zoo.vtkhdf"))
    for n in (1, 2, 3):
        matrix = UsdGeom.Xformable(crate).ComputeLocalToWorldTransform(n)
        placed = np.array([matrix.Transform(Gf.Vec3d(*map(float, p))) for p in crate.GetPointsAttr().Get(n)])
        reader.SetStep(n - 1)
        reader.Update()
        out = reader.GetOutput()
        all_points = vtk_to_numpy(out.GetPoints().GetData())
        mine = all_points[vtk_to_numpy(out.GetPointData().GetArray("collider")) == 1]
        assert len(mine) == len(placed)
        np.testing.assert_allclose(placed / SCALE, z_up(mine), atol=2e-6)
    # It fell by g t^2/2 in 0.04 s, and turned by 0.8 rad about the upright.
    middle = mine.mean(axis=0)
    assert abs(middle[1] - (0.3 - 0.5 * 9.81 * 0.04**2)) < 1e-3
    reach = np.abs(mine - middle).max(axis=0)
    assert abs(reach[0] - 0.05 * (np.cos(0.8) + np.sin(0.8))) < 1e-3 and abs(reach[1] - 0.05) < 1e-6
    post = UsdGeom.Mesh(stage.GetPrimAtPath("/zoo/post"))
    assert not UsdGeom.Xformable(post).GetOrderedXformOps()
    assert UsdShade.MaterialBindingAPI(post).GetDirectBindingRel().GetTargets()


@pytest.fixture(scope="module")
def foaming(tmp_path_factory):
    """A run of twelve frames with foam, and its own foam files. Nothing is emitted in the first frame."""
    folder = tmp_path_factory.mktemp("foaming")
    scene = pathlib.Path(__file__).with_name("two-things.yaml").read_text() + "foam: {amount: 0.1, radius: 0.02}\n"  # wider than a spacing
    (folder / "scene.yaml").write_text(scene.replace("frames: 3", "frames: 12"))
    dreampm(folder, "run", "scene.yaml", "--out", "run")
    dreampm(folder, "foam", "run")
    own = [read_ply(folder / f"run/foam/foam_{n:06}.ply")[1] for n in range(1, 13)]
    assert len(own[0]) == 0 and len(own[11]) > 1000
    assert set(own[11]["type"]) == {0, 1, 2}, "spray, foam and bubbles"
    return folder, own


def test_usd_foam(foaming):
    folder, foam = foaming
    dreampm(folder, "export", "run", "--to", "usd", "--what", "foam", "--up", "z", "--scale", SCALE)
    stage = Usd.Stage.Open(str(folder / "run/export/two-things.usda"))
    [points] = [UsdGeom.Points(p) for p in stage.Traverse() if p.IsA(UsdGeom.Points)]
    assert points.GetPath() == "/two_things/foam"
    assert points.GetPointsAttr().GetTimeSamples() == list(range(1, 13))
    assert points.GetWidthsInterpolation() == "vertex"
    for n, own in enumerate(foam, 1):
        where, widths = z_up(columns(own, "x y z")) * SCALE, 2 * own["radius"] * SCALE
        count = len(own)
        assert len(points.GetPointsAttr().Get(n)) == points.GetPointCount(n) == count
        read = lambda values, width=1: np.array(values).reshape(-1, width) if width > 1 else np.array(values)
        np.testing.assert_allclose(read(points.GetPointsAttr().Get(n), 3), where, rtol=1e-6, atol=1e-4)
        np.testing.assert_allclose(read(points.GetWidthsAttr().Get(n)), widths, rtol=1e-6)
        np.testing.assert_allclose(read(points.GetVelocitiesAttr().Get(n), 3), z_up(columns(own, "vx vy vz")) * SCALE,
                                   rtol=1e-6, atol=1e-4)
        np.testing.assert_array_equal(read(points.GetIdsAttr().Get(n)), own["id"])
        for name in ("type", "age"):
            primvar = UsdGeom.PrimvarsAPI(points).GetPrimvar(name)
            assert primvar.GetInterpolation() == "vertex"
            np.testing.assert_allclose(read(primvar.Get(n)), own[name], rtol=1e-6)
        if count:
            low, high = map(np.array, points.GetExtentAttr().Get(n))
            assert np.all(low <= (where - widths[:, None] / 2).min(axis=0) + 1e-4)
            assert np.all(high >= (where + widths[:, None] / 2).max(axis=0) - 1e-4)


def test_vtkhdf_foam(foaming):
    folder, foam = foaming
    [file] = dreampm(folder, "export", "run", "--to", "vtkhdf", "--what", "foam")
    for n, own in enumerate(foam):
        times, data = step(folder / file, n)
        assert times == pytest.approx([i / FPS for i in range(12)])
        assert data.GetNumberOfPoints() == data.GetNumberOfVerts() == len(own)
        if not len(own):
            continue
        np.testing.assert_array_equal(vtk_to_numpy(data.GetPoints().GetData()), columns(own, "x y z"))
        np.testing.assert_array_equal(array(data, "velocity"), columns(own, "vx vy vz"))
        for name in ("id", "type", "age", "radius"):
            np.testing.assert_array_equal(array(data, name), own[name])


PAINTS = """dreampm: 1
name: paints
space: {max: [0.6, 0.5, 0.2], spacing: 0.025, walls: {ceiling: {type: open}}}
time: {fps: 50, frames: 6}
materials: {paint: {type: newtonian, viscosity: 1, max_compression: 0.1}}
bodies: {pool: {material: paint, color: [0, 0.13, 0.52], shape: {box: {min: [0, 0, 0], max: [0.6, 0.1, 0.2]}}}}
emitters:
  tap: {material: paint, color: [0.99, 0.83, 0], pool: 9000, velocity: [0.5, -2, 0],
        shape: {box: {size: [0.2, 0.06, 0.2]}, center: [0.3, 0.2, 0.1]}}
surface: {attributes: [velocity, color, source, age, j, vorticity]}
render: {looks: {paint: {type: opaque}}}
"""


@pytest.fixture(scope="module")
def paints(tmp_path_factory):
    folder = tmp_path_factory.mktemp("paints")
    (folder / "paints.yaml").write_text(PAINTS)
    dreampm(folder, "run", "paints.yaml", "--out", "run")
    dreampm(folder, "surface", "run")
    return folder


def to_linear(srgb):
    return np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055)**2.4)


def test_attributes_of_vertices_in_all_formats(paints):
    n = 6
    own = read_ply(paints / f"run/surface/surface_{n:06}.ply")[1]
    color = to_linear(columns(own, "red green blue") / 255)
    assert set(own["source"]) == {0, 1} and own["age"].max() == pytest.approx((n - 1) / 50, rel=1e-4)
    vorticity = columns(own, "vorticity_x vorticity_y vorticity_z")
    assert np.abs(vorticity).max() > 1
    # Green is where yellow meets blue.
    green = (color[:, 1] > 1.1 * color[:, 0]) & (color[:, 1] > 1.1 * color[:, 2])
    assert 5 < green.sum() < len(own) / 2

    dreampm(paints, "export", "run", "--to", "usd", "--up", "z", "--scale", SCALE)
    stage = Usd.Stage.Open(str(paints / "run/export/paints.usda"))
    mesh = UsdGeom.PrimvarsAPI(UsdGeom.Mesh.Get(stage, "/paints/surface"))
    for name, wanted, kind in (("displayColor", color, "color3f[]"), ("age", own["age"], "float[]"),
                               ("j", own["j"], "float[]"), ("source", own["source"], "int[]"),
                               ("vorticity", z_up(vorticity), "vector3f[]")):
        primvar = mesh.GetPrimvar(name)
        assert primvar.GetInterpolation() == "vertex" and primvar.GetTypeName() == kind
        np.testing.assert_allclose(primvar.Get(n), wanted, rtol=1e-5, atol=1e-5)

    dreampm(paints, "export", "run", "--to", "vtkhdf", "--what", "surface")
    times, data = step(paints / "run/export/paints.vtkhdf", n - 1)
    np.testing.assert_array_equal(array(data, "color"), columns(own, "red green blue"))
    for name in ("age", "j", "source"):
        np.testing.assert_array_equal(array(data, name), own[name])
    assert array(data, "source").dtype == np.int32
    np.testing.assert_array_equal(array(data, "vorticity"), vorticity)

    [folder] = dreampm(paints, "export", "run", "--to", "gltf", "--what", "surface")
    mesh = trimesh.load(paints / folder / f"paints_{n:06}.glb", process=False).geometry["surface"]
    np.testing.assert_allclose(np.ravel(mesh.vertex_attributes["_AGE"]), own["age"])
    np.testing.assert_allclose(mesh.vertex_attributes["_VORTICITY"], vorticity)
    [folder] = dreampm(paints, "export", "run", "--to", "obj", "--what", "surface")
    lines = (paints / folder / f"surface_{n:06}.obj").read_text().splitlines()
    back = np.array([[float(w) for w in line.split()[4:]] for line in lines if line.startswith("v ")])
    np.testing.assert_allclose(back * 255, columns(own, "red green blue"), atol=0.05)
    [folder] = dreampm(paints, "export", "run", "--to", "ply", "--up", "z")
    head, back = read_ply(paints / folder / f"surface_{n:06}.ply")
    np.testing.assert_allclose(columns(back, "vorticity_x vorticity_y vorticity_z"), z_up(vorticity), rtol=1e-6)
    np.testing.assert_array_equal(columns(back, "red green blue"), columns(own, "red green blue"))
    head, back = read_ply(paints / folder / f"particles_{n:06}.ply")
    assert "comment source 0 tap" in head and "comment source 1 pool" in head
    np.testing.assert_array_equal(np.unique(back["source"]), [0, 1])

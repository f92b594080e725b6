"""A run as an Alembic file, by python/dreampm/alembic.py in a process of its own, read back by Blender."""
import os
import subprocess
import sys

import bpy
import numpy
import pytest
from conftest import COMMAND, SOURCE

sys.path.insert(0, str(SOURCE / "blender"))
from core import ply  # noqa: E402

FPS = 50
SCENE = (SOURCE / "tests/python/two-things.yaml").read_text() + """\
colliders: {post: {shape: {box: {min: [0.3, 0, 0.1], max: [0.33, 0.2, 0.2]}}}}
surface: {attributes: [velocity, color, age]}
render: {size: [64, 36]}
"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("alembic")
    (folder / "scene.yaml").write_text(SCENE)
    for call in (["run", "scene.yaml", "--out", "run", "--set", "time.frames=4"], ["surface", "run"]):
        subprocess.run([COMMAND, *call], cwd=folder, check=True, capture_output=True)
    return folder


def convert(folder, *more):
    script = SOURCE / "python/dreampm/alembic.py"
    return subprocess.run([sys.executable, str(script), "run", *more], cwd=folder, capture_output=True, text=True,
                          env={**os.environ, "DREAMPM_COMMAND": COMMAND})


def opened(file):
    bpy.ops.wm.read_homefile(use_empty=True)
    bpy.context.scene.render.fps = FPS
    bpy.ops.wm.alembic_import(filepath=str(file), as_background_job=False, set_frame_range=True)


def at(frame, name):
    """The evaluated data of an object, and where its points are in Blender."""
    bpy.context.scene.frame_set(frame)
    thing = bpy.data.objects[name].evaluated_get(bpy.context.evaluated_depsgraph_get())
    data = thing.data
    places = numpy.array(vectors(data, "position"), dtype=float)
    world = numpy.array(thing.matrix_world)
    return data, places @ world[:3, :3].T + world[:3, 3]


def vectors(data, name):
    values = numpy.empty(3 * len(data.attributes[name].data), "f4")
    data.attributes[name].data.foreach_get("vector", values)
    return values.reshape(-1, 3)


def numbers(data, name):
    values = numpy.empty(len(data.attributes[name].data), "f4")
    data.attributes[name].data.foreach_get("value", values)
    return values


def turned(v):
    return numpy.stack([v[:, 0], -v[:, 2], v[:, 1]], axis=1)


def test_meshes_points_and_camera(folder):
    done = convert(folder)
    assert done.returncode == 0, done.stderr
    assert done.stdout == "run/export/two-things.abc\n"
    opened(folder / "run/export/two-things.abc")
    assert (bpy.context.scene.frame_start, bpy.context.scene.frame_end) == (1, 4)
    for frame in (1, 3, 4):
        own = ply.read(folder / f"run/surface/water_{frame:06}.ply")
        mesh, places = at(frame, "water-surface")
        numpy.testing.assert_allclose(places, turned(own.places()), atol=1e-5)
        numpy.testing.assert_allclose(vectors(mesh, "velocity"), turned(own.velocities()), atol=1e-4)
        a, b, c = (places[[v.vertices[i] for v in mesh.polygons]] for i in range(3))
        assert (a * numpy.cross(b, c)).sum() > 0  # outside is outside
        particles = ply.read(folder / f"run/particles/particles_{frame:06}.ply")
        chosen = particles.columns["material"] == [m for m, n in particles.materials.items() if n == "jelly"][0]
        cloud, places = at(frame, "jelly")
        numpy.testing.assert_allclose(places, turned(particles.places())[chosen], atol=1e-5)
        numpy.testing.assert_allclose(numbers(cloud, "radius"), 0.015, rtol=1e-5)
        numpy.testing.assert_allclose(vectors(cloud, "velocity"), turned(particles.velocities())[chosen], atol=1e-5)
    jelly, _ = at(4, "jelly-surface")
    # Linear, as Houdini has it; Blender takes colors of meshes from Alembic for sRGB.
    color = jelly.attributes["Cd"].data[0].color_srgb
    numpy.testing.assert_allclose(color[:3], (1, ((0.5 + 0.055) / 1.055)**2.4, 0), atol=0.01)
    _, post = at(2, "collider-post")
    numpy.testing.assert_allclose(post.min(axis=0), (0.3, -0.2, 0), atol=2e-3)
    camera = bpy.data.objects["camera"].evaluated_get(bpy.context.evaluated_depsgraph_get())
    assert camera.data.angle_y == pytest.approx(numpy.radians(34), rel=1e-4)
    ahead = -numpy.array(camera.matrix_world)[:3, 2]
    middle = numpy.array([0.3, -0.15, 0.2]) - numpy.array(camera.matrix_world)[:3, 3]
    assert ahead @ middle / numpy.linalg.norm(middle) > 0.98


# Blender reads colors alone of what the vertices of a mesh hold besides.
READ = """
import alembic3d
from alembic3d import Abc, AbcGeom
archive = Abc.IArchive("run/export/two-things.abc")
mesh = AbcGeom.IPolyMesh(archive.getTop().getChild("jelly-surface"), "jelly-surfaceShape").getSchema()
points = AbcGeom.IPoints(archive.getTop().getChild("jelly"), "jellyShape").getSchema()
print(mesh.getNumSamples(), mesh.getTimeSampling().getSampleTime(3))
for schema, name in ((mesh, "age"), (points, "age")):
    param = AbcGeom.IFloatGeomParam(schema.getArbGeomParams(), name)
    values = list(param.getExpandedValue(Abc.ISampleSelector(3)).getVals())
    print(len(values), min(values), max(values))
print(*points.getValue(Abc.ISampleSelector(3)).getIds())
"""


def test_what_blender_does_not_read(folder):
    assert convert(folder).returncode == 0
    done = subprocess.run([sys.executable, "-c", READ], cwd=folder, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    first, of_mesh, of_points, ids = ([float(w) for w in line.split()] for line in done.stdout.splitlines())
    assert first == [4, pytest.approx(4 / FPS)]
    surface = ply.read(folder / "run/surface/jelly_000004.ply")
    assert of_mesh == [len(surface), pytest.approx(3 / FPS), pytest.approx(3 / FPS)]
    particles = ply.read(folder / "run/particles/particles_000004.ply")
    own = particles.columns["id"][particles.columns["material"] == 1]
    assert of_points == [len(own), pytest.approx(3 / FPS), pytest.approx(3 / FPS)]
    assert ids == own.tolist()


def test_other_axes_and_some_frames(folder):
    assert convert(folder, "--up", "z", "--scale", "100", "--frames", "2-3", "--out", "z.abc").returncode == 0
    opened(folder / "z.abc")
    assert (bpy.context.scene.frame_start, bpy.context.scene.frame_end) == (2, 3)
    # Blender turns what it takes for Y up; the file has Z up and centimeters.
    thing = bpy.data.objects["water-surface"]
    bpy.context.scene.frame_set(3)
    data = thing.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
    own = ply.read(folder / "run/surface/water_000003.ply")
    places = vectors(data, "position")
    numpy.testing.assert_allclose(sorted(numpy.ptp(places, axis=0)), sorted(numpy.ptp(own.places(), axis=0) * 100),
                                  rtol=1e-4)


@pytest.mark.parametrize("more,why", [(["--frames", "3-9"], "frame 5 is not simulated; it has 4 frames"),
                                      (["--frames", "4-2"], "must be A-B"),
                                      (["--out", "film.usd"], "ends with .abc"),
                                      (["--out", "folder.abc"], "folder.abc: is a folder"),
                                      (["--out", "scene.yaml/film.abc"], "film.abc: scene.yaml is no folder"),
                                      (["--out", "/proc/film.abc"], "directory: '/proc/film.abc'"),
                                      (["--scale", "0"], "--scale"),
                                      (["--what", "foam"], "the scene has no foam")])
def test_what_cannot_be_written(folder, more, why):
    (folder / "folder.abc").mkdir(exist_ok=True)
    done = convert(folder, *more)
    assert done.returncode == 2 and why in done.stderr, done.stderr
    assert not (folder / "film.usd").exists() and not list((folder / "run/export").glob(".*"))


def test_no_run(folder):
    done = subprocess.run([sys.executable, str(SOURCE / "python/dreampm/alembic.py"), "."], cwd=folder,
                          capture_output=True, text=True)
    assert done.returncode == 2 and "is no run" in done.stderr
    (folder / "other").mkdir()
    for text in ("{", "{}", "[1]"):
        (folder / "other/run.json").write_text(text)
        done = subprocess.run([sys.executable, str(SOURCE / "python/dreampm/alembic.py"), "other"], cwd=folder,
                              capture_output=True, text=True)
        assert done.returncode == 2 and "other: is no run" in done.stderr


def test_the_command_says_who_writes_it(folder):
    done = subprocess.run([COMMAND, "export", "run", "--to", "alembic"], cwd=folder, capture_output=True, text=True)
    assert done.returncode == 2 and "python -m dreampm.alembic" in done.stderr

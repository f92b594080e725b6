"""The guide's script: a cube of water falls into a bowl, baked, looked at as numbers, and rendered by Cycles."""
import os
import re
import runpy
import shutil
import subprocess
import sys
import types

import bpy
import numpy
import pytest
from conftest import BUILD, COMMAND, MODULE, SOURCE
from mathutils import Vector

G, FPS = 9.81, 24


@pytest.fixture(scope="module")
def film(tmp_path_factory):
    """Typed as the guide has it, but coarser, with the command on PATH."""
    folder = tmp_path_factory.mktemp("bowl")
    guide = (SOURCE / "docs/guide/blender.md").read_text()
    words = re.search(r"^blender .*docs/guide/blender.py -- (.*)$", guide, re.MULTILINE)[1].split()
    preferences = bpy.context.preferences.addons[MODULE].preferences
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("PATH", f"{BUILD}{os.pathsep}{os.environ['PATH']}")
        patch.chdir(folder)
        patch.setattr(sys, "argv", ["blender", "--", *words, "--spacing", "0.025", "--size", "160", "--samples", "8"])
        preferences.command = ""
        try:
            assert shutil.which("dreampm") == COMMAND
            runpy.run_path(str(SOURCE / "docs/guide/blender.py"))
        finally:
            preferences.command = COMMAND
    return types.SimpleNamespace(folder=folder, scene=bpy.context.scene)


@pytest.fixture
def water(film):
    """The object that shows it, in the file as the script saved it."""
    bpy.ops.wm.open_mainfile(filepath=str(film.folder / "bowl.blend"))
    film.scene = bpy.context.scene
    return bpy.data.objects["DreaMPM water"]


def numbers(mesh, what):
    data, name, size = {"co": (mesh.vertices, "co", 3),
                        "velocity": (mesh.attributes["velocity"].data, "vector", 3)}[what]
    out = numpy.empty(len(data) * size, dtype="f4")
    data.foreach_get(name, out)
    return out.reshape(-1, size)


def test_the_scene_is_what_blender_shows(film, water):
    text = (film.folder / "dreampm/scene.yaml").read_text()
    box = bpy.data.objects["Domain"].bound_box
    low, high = numpy.array(box[0]), numpy.array(box[6])
    found = [[float(x) for x in re.search(rf"{name}: \[(.*)\]", text)[1].split(",")] for name in ("min", "max")]
    assert numpy.allclose(found, [(low[0], low[2], -high[1]), (high[0], high[2], -low[1])], atol=1e-6)
    assert "gravity: [0.0, -9.81, 0.0]" in text and "frames: 24" in text and "fps: 24.0" in text
    assert "Bowl:" in text and "type: newtonian, preset: water" in text and "spacing: 0.025" in text
    assert len(list((film.folder / "dreampm/run/surface").glob("surface_*.ply"))) == 24


def test_the_cube_falls_as_a_stone_does(film, water):
    film.scene.frame_set(1)
    points = numbers(water.data, "co")
    # The mesh wraps particles, half a spacing inside of the cube's faces at most.
    assert numpy.allclose(points.min(axis=0), (-0.14, -0.17, 0.58), atol=0.025)
    assert numpy.allclose(points.max(axis=0), (0.26, 0.23, 0.98), atol=0.025)
    assert not numbers(water.data, "velocity").any() and len(water.data.polygons) > 1000
    film.scene.frame_set(5)
    t = 4 / FPS
    assert numbers(water.data, "velocity").mean(axis=0) == pytest.approx((0, 0, -G * t), abs=0.03)
    fallen = numbers(water.data, "co").max(axis=0) - points.max(axis=0)
    assert fallen == pytest.approx((0, 0, -G / 2 * t * t), abs=0.01)


def test_the_bowl_holds_water(film, water):
    film.scene.frame_set(24)
    points = numbers(water.data, "co")
    inside = points[(points[:, 2] < 0.55) & (numpy.linalg.norm(points[:, :2], axis=1) < 0.5)]
    radius = numpy.linalg.norm(inside - (0, 0, 0.6), axis=1)
    # Nothing is within the bowl's wall, 0.5 to 0.58 about the middle of its ball, but for half a cell.
    assert numpy.percentile(radius, 99) < 0.525 and len(inside) > 1000


def test_velocities_move_vertices_to_where_the_next_frame_is(film, water):
    """The next frame's top is where velocity and gravity take this one's."""
    film.scene.frame_set(3)
    top, v = numbers(water.data, "co")[:, 2].max(), numbers(water.data, "velocity")[:, 2].mean()
    film.scene.frame_set(4)
    assert numbers(water.data, "co")[:, 2].max() == pytest.approx(top + v / FPS - G / 2 / FPS ** 2, abs=0.005)


def test_a_saved_film_opens_again(film, water):
    assert water.dreampm_result.folder == "//dreampm/run" and water.dreampm_result.first_frame == 1
    film.scene.frame_set(2)
    two = len(water.data.vertices)
    film.scene.frame_set(24)
    last = len(water.data.vertices)
    assert last > 1.5 * two  # it has splashed
    film.scene.frame_set(500)
    assert len(water.data.vertices) == last
    film.scene.frame_set(-3)
    assert len(water.data.vertices) != last and water.data.validate() is False
    # What it shows comes from the run, not from the file.
    water.data.clear_geometry()
    bpy.ops.wm.save_as_mainfile(filepath=str(film.folder / "empty.blend"))
    bpy.ops.wm.open_mainfile(filepath=str(film.folder / "empty.blend"))
    assert bpy.data.objects["DreaMPM water"].data.polygons


def camera(scene, place, target, **lens):
    data = bpy.data.cameras.new("Camera")
    for key, value in lens.items():
        setattr(data, key, value)
    thing = bpy.data.objects.new("Camera", data)
    scene.collection.objects.link(thing)
    thing.location = place
    thing.rotation_euler = (Vector(target) - Vector(place)).to_track_quat("-Z", "Y").to_euler()
    scene.camera = thing


def render(scene, file, width, height, samples, blur=False):
    scene.render.engine = "CYCLES"
    scene.cycles.samples, scene.cycles.use_denoising, scene.cycles.use_adaptive_sampling = samples, False, False
    scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = width, height, 100
    scene.render.use_motion_blur, scene.render.motion_blur_shutter = blur, 0.5
    scene.render.filepath = str(file)
    bpy.ops.render.render(write_still=True)
    return pixels_of(file)


def pixels_of(file):
    image = bpy.data.images.load(str(file))
    pixels = numpy.array(image.pixels[:], dtype="f4").reshape(image.size[1], image.size[0], 4)
    bpy.data.images.remove(image)
    return pixels


def edge_variances(alpha):
    """How wide the lower and the upper edge of something in a picture are, which is 1 unit high [units^2]."""
    profile = alpha.mean(axis=1)
    rows = (numpy.arange(len(profile) - 1) + 0.5) / len(profile)
    middle = len(profile) * 2 // 5
    out = []
    for part in (slice(0, middle), slice(middle, None)):
        weight = numpy.abs(numpy.diff(profile)[part])
        mean = (weight * rows[part]).sum() / weight.sum()
        out.append((weight * (rows[part] - mean) ** 2).sum() / weight.sum())
    return numpy.array(out)


def test_motion_blur_is_as_long_as_the_velocity_says(film, water, tmp_path):
    """A falling cube against nothing, seen from the side: its edges smear over v times the shutter."""
    scene = film.scene
    water.data.materials[0] = bpy.data.materials.new("Opaque")
    scene.render.film_transparent = True
    bpy.data.objects["Bowl"].hide_render = bpy.data.objects["Plane"].hide_render = True
    camera(scene, (0, -3, 0.6), (0, 0, 0.6), type="ORTHO", ortho_scale=1.0)
    scene.frame_set(6)
    v = -numbers(water.data, "velocity")[:, 2].mean()
    assert v == pytest.approx(G * 5 / FPS, rel=0.03)
    sharp, blurred = (edge_variances(render(scene, tmp_path / f"blur{blur}.png", 20, 200, 128, blur)[:, 8:12, 3])
                      for blur in (False, True))
    # An edge that moves by w while the shutter is open becomes a ramp, whose variance is w^2/12.
    assert numpy.sqrt(12 * (blurred - sharp)) == pytest.approx(v * 0.5 / FPS, rel=0.05)


def test_the_picture_shows_water(film, water):
    """The script rendered the frame; without the water it looks otherwise, where the splash is."""
    with_water = pixels_of(film.folder / "bowl.png")
    assert with_water.shape == (120, 160, 4)
    water.hide_render = True
    without = render(film.scene, film.folder / "without.png", 160, 120, 8, blur=True)
    seen = numpy.abs(with_water - without)[..., :3].max(axis=2) > 0.05
    assert 0.03 < seen.mean() < 0.5, seen.mean()


def test_the_extension_is_one(film):
    tool = os.path.join(bpy.utils.system_resource("SCRIPTS"), "addons_core", "bl_pkg", "cli", "blender_ext.py")
    [archive] = BUILD.glob("dreampm-blender-*.zip")
    done = subprocess.run([sys.executable, tool, "validate", archive], capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    assert MODULE in bpy.context.preferences.addons

"""A cube of water falls into a bowl: baked, looked at as numbers, and rendered by Cycles."""
import os
import time

import bmesh
import bpy
import numpy
import pytest
from conftest import MODULE, Studio
from mathutils import Vector

G, FPS = 9.81, 24


def bowl(studio):
    """Half a ball with a wall, its rim at z = 0.57."""
    bpy.ops.mesh.primitive_uv_sphere_add(radius=0.5, location=(0, 0, 0.57), segments=32, ring_count=16)
    thing = bpy.context.object
    thing.name = "Bowl"
    mesh = bmesh.new()
    mesh.from_mesh(thing.data)
    bmesh.ops.delete(mesh, geom=[v for v in mesh.verts if v.co.z > 0.02], context="VERTS")
    mesh.to_mesh(thing.data)
    mesh.free()
    wall = thing.modifiers.new("Wall", "SOLIDIFY")
    wall.thickness, wall.offset = 0.08, 1
    thing.dreampm.role = "COLLIDER"
    return thing


@pytest.fixture(scope="module")
def film(tmp_path_factory):
    studio = Studio(tmp_path_factory.mktemp("bowl"))
    bowl(studio)
    studio.box("Water", (-0.2, -0.2, 0.55), (0.2, 0.2, 0.95), "LIQUID")
    studio.domain((-0.7, -0.7, 0), (0.7, 0.7, 1.4), 0.025)
    assert bpy.ops.dreampm.bake() == {"FINISHED"}
    bpy.ops.wm.save_mainfile()
    return studio


@pytest.fixture
def water(film):
    if bpy.data.filepath != str(film.folder / "film.blend"):
        bpy.ops.wm.open_mainfile(filepath=str(film.folder / "film.blend"))
        film.scene = bpy.context.scene
    return bpy.data.objects["DreaMPM water"]


def numbers(mesh, what):
    data, name, size = {"co": (mesh.vertices, "co", 3),
                        "velocity": (mesh.attributes["velocity"].data, "vector", 3)}[what]
    out = numpy.empty(len(data) * size, dtype="f4")
    data.foreach_get(name, out)
    return out.reshape(-1, size)


def test_the_scene_is_what_blender_shows(film):
    text = film.scene_text
    assert "min: [-0.7, 0.0, -0.7]" in text and "max: [0.7, 1.4, 0.7]" in text and "spacing: 0.025" in text
    assert "gravity: [0.0, -9.81, 0.0]" in text and "frames: 24" in text and "fps: 24.0" in text
    assert "Bowl:" in text and "type: newtonian, preset: water" in text
    assert len(list((film.folder / "dreampm/run/surface").glob("surface_*.ply"))) == 24


def test_the_cube_falls_as_a_stone_does(film, water):
    film.scene.frame_set(1)
    points = numbers(water.data, "co")
    # The mesh wraps particles, half a spacing inside of the cube's faces at most.
    assert numpy.allclose(points.min(axis=0), (-0.2, -0.2, 0.55), atol=0.025)
    assert numpy.allclose(points.max(axis=0), (0.2, 0.2, 0.95), atol=0.025)
    assert not numbers(water.data, "velocity").any() and len(water.data.polygons) > 1000
    film.scene.frame_set(5)
    t = 4 / FPS
    assert numbers(water.data, "velocity").mean(axis=0) == pytest.approx((0, 0, -G * t), abs=0.03)
    fallen = numbers(water.data, "co").max(axis=0) - points.max(axis=0)
    assert fallen == pytest.approx((0, 0, -G / 2 * t * t), abs=0.01)


def test_the_bowl_holds_water(film, water):
    film.scene.frame_set(24)
    points = numbers(water.data, "co")
    # Inside the bowl's wall nothing is lower than its hollow, 0.57 - 0.5.
    assert 0.05 < points[:, 2].min() < 0.12
    below_rim = points[points[:, 2] < 0.5]
    radius = numpy.linalg.norm(below_rim - (0, 0, 0.57), axis=1)
    assert numpy.percentile(radius, 95) < 0.53 and len(below_rim) > 1000


def test_velocities_move_vertices_to_where_the_next_frame_is(film, water):
    """Of a falling cube: the next frame's top is where velocity and gravity take this one's."""
    film.scene.frame_set(3)
    top, v = numbers(water.data, "co")[:, 2].max(), numbers(water.data, "velocity")[:, 2].mean()
    film.scene.frame_set(4)
    assert numbers(water.data, "co")[:, 2].max() == pytest.approx(top + v / FPS - G / 2 / FPS ** 2, abs=0.005)


def test_a_saved_film_opens_again(film, water):
    bpy.ops.wm.open_mainfile(filepath=str(film.folder / "film.blend"))
    film.scene = bpy.context.scene
    thing = bpy.data.objects["DreaMPM water"]
    assert thing.dreampm_result.folder == "//dreampm/run" and thing.dreampm_result.first_frame == 1
    film.scene.frame_set(2)
    two = len(thing.data.vertices)
    film.scene.frame_set(24)
    assert len(thing.data.vertices) > 1.5 * two  # it has splashed
    film.scene.frame_set(500)
    last = len(thing.data.vertices)
    film.scene.frame_set(-3)
    assert len(thing.data.vertices) != last and thing.data.validate() is False


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
    scene.cycles.samples, scene.cycles.use_denoising, scene.cycles.seed = samples, False, 1
    scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = width, height, 100
    scene.render.use_motion_blur, scene.render.motion_blur_shutter = blur, 0.5
    scene.render.filepath = str(file)
    bpy.ops.render.render(write_still=True)
    image = bpy.data.images.load(str(file))
    pixels = numpy.array(image.pixels[:], dtype="f4").reshape(height, width, 4)
    bpy.data.images.remove(image)
    return pixels


def test_motion_blur_is_as_long_as_the_velocity_says(film, water, tmp_path):
    """A falling cube against nothing, seen from the side: its edges smear over v times the shutter."""
    scene = film.scene
    water.data.materials[0] = bpy.data.materials.new("Opaque")
    scene.render.film_transparent = True
    bpy.data.objects["Bowl"].hide_render = bpy.data.objects["Domain"].hide_render = True
    camera(scene, (0, -3, 0.6), (0, 0, 0.6), type="ORTHO", ortho_scale=1.0)
    scene.frame_set(6)
    v = -numbers(water.data, "velocity")[:, 2].mean()
    assert v == pytest.approx(G * 5 / FPS, rel=0.03)
    heights = []
    for blur in (False, True):
        pixels = render(scene, tmp_path / f"blur{blur}.png", 20, 200, 32, blur)
        covered = pixels[:, 8:12, 3].mean(axis=1)
        heights.append((covered > 0.02).sum() / 200)
    # The picture is 1 unit high; a row is half a hundredth.
    assert heights[1] - heights[0] == pytest.approx(v * 0.5 / FPS, abs=0.012), heights


def test_a_picture(film, water):
    """What DREAMPM_PICTURE names is for a person to look at."""
    bpy.ops.wm.open_mainfile(filepath=str(film.folder / "film.blend"))
    scene = film.scene = bpy.context.scene
    picture = os.environ.get("DREAMPM_PICTURE", str(film.folder / "picture.png"))
    camera(scene, (1.6, -1.9, 1.7), (0, 0, 0.5))
    sun = bpy.data.objects.new("Sun", bpy.data.lights.new("Sun", "SUN"))
    sun.data.energy, sun.rotation_euler = 3, (0.7, 0.2, 0.5)
    scene.collection.objects.link(sun)
    bpy.ops.mesh.primitive_plane_add(size=20, location=(0, 0, -0.02))
    bpy.data.objects["Domain"].hide_render = True
    scene.frame_set(14)
    start = time.monotonic()
    shown = render(scene, picture, 160, 120, 8)
    bpy.data.objects["DreaMPM water"].hide_render = True
    without = render(scene, film.folder / "without.png", 160, 120, 8)
    # The water is seen, and no more than the middle of the picture is taken by it.
    seen = numpy.abs(shown - without)[..., :3].max(axis=2) > 0.05
    assert 0.03 < seen.mean() < 0.6, seen.mean()
    print(f"rendered in {time.monotonic() - start:.1f} s")


def test_the_extension_is_one(film):
    import subprocess
    import sys
    from conftest import BUILD
    tool = os.path.join(bpy.utils.system_resource("SCRIPTS"), "addons_core", "bl_pkg", "cli", "blender_ext.py")
    [archive] = BUILD.glob("dreampm-blender-*.zip")
    done = subprocess.run([sys.executable, tool, "validate", archive], capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    assert MODULE in bpy.context.preferences.addons

"""Roles, materials, motion, errors, cancel and resume, floating bodies, particles, panels."""
import importlib
import math
import subprocess
import sys
import time

import bpy
import numpy
import pytest
from conftest import COMMAND, MODULE, SOURCE

sys.path.insert(0, str(SOURCE / "blender"))
from core import ply  # noqa: E402

baking = importlib.import_module(f"{MODULE}.baking")
panels = importlib.import_module(f"{MODULE}.panels")


def pool(studio, **settings):
    """A small pool in a box without a lid."""
    water = studio.box("Pool", (0, 0, 0), (0.2, 0.2, 0.1), "LIQUID", **settings)
    studio.domain((0, 0, 0), (0.4, 0.2, 0.4), 0.02)
    return water


def test_roles_and_materials(studio):
    cube = studio.box("Cube", (0, 0, 0), (1, 1, 1))
    s = cube.dreampm
    s.role = "LIQUID"
    assert s.material == "newtonian/water" and cube.display_type == "WIRE" and cube.hide_render
    s.material = "newtonian/honey"
    assert s.material_key == "newtonian/honey"
    bpy.ops.dreampm.value_add(key="viscosity")
    bpy.ops.dreampm.value_add(key="tension")
    assert s.values["viscosity"].number == pytest.approx(8.55) and s.values["tension"].word == "false"
    with pytest.raises(TypeError):
        s.material = "snow/packed"  # no liquid
    s.role = "MATERIAL"
    assert s.material.startswith("elastic/") and len(s.values) == 0
    s.material = "snow/packed"
    s.role = "EMITTER"  # keeps what it can be made of
    assert s.material == "snow/packed"
    s.role = "COLLIDER"
    assert cube.display_type == "TEXTURED" and not cube.hide_render
    bpy.ops.object.select_all(action="SELECT")
    bpy.ops.dreampm.mark(role="OUTFLOW")
    assert s.role == "OUTFLOW"


def test_domain_about_what_takes_part(studio):
    studio.box("A", (0, 0, 0), (1, 1, 1), "LIQUID")
    studio.box("B", (2, 0, 0), (3, 1, 0.5), "COLLIDER")
    studio.box("Far", (50, 0, 0), (51, 1, 1))
    bpy.ops.dreampm.add_domain()
    corners = [tuple(c) for c in studio.settings.domain.bound_box]
    assert numpy.allclose(numpy.min(corners, axis=0), (-0.3, -0.3, 0))
    assert numpy.allclose(numpy.max(corners, axis=0), (3.3, 1.3, 1.3))
    assert studio.settings.spacing == pytest.approx(3.6 / 64)


@pytest.mark.parametrize("break_it, why", [
    (lambda studio: setattr(studio.settings, "domain", None), "there is no domain"),
    (lambda studio: setattr(studio.settings, "spacing", 0), "spacing is 0"),
    (lambda studio: [setattr(studio.settings, "frame_end", -2), setattr(studio.settings, "scene_range", False)],
     "the last frame, -2, lies before the first, 1"),
    (lambda studio: setattr(bpy.data.objects["Pool"].dreampm, "role", "NONE"), "nothing to simulate"),
    (lambda studio: setattr(bpy.data.objects["Pool"].dreampm, "role", "EMITTER"), "emitter without a velocity"),
    (lambda studio: bpy.data.objects["Pool"].data.clear_geometry(), "Pool has no faces"),
    (lambda studio: setattr(bpy.data.objects["Pool"], "location", (5, 0, 0)), "Pool"),
    (lambda studio: setattr(studio.settings, "folder", ""), "folder is empty"),
])
def test_errors_say_what_to_do(studio, break_it, why):
    pool(studio)
    break_it(studio)
    with pytest.raises(RuntimeError, match=why):
        bpy.ops.dreampm.bake()
    assert why in baking.session.error
    assert not (studio.folder / "dreampm/run").exists()
    bpy.ops.dreampm.dismiss()
    assert not baking.session.error


def test_errors_of_the_command(studio):
    water = pool(studio)
    bpy.context.view_layer.objects.active = water
    bpy.ops.dreampm.value_add(key="viscosity")
    water.dreampm.values["viscosity"].number = -1
    with pytest.raises(RuntimeError, match=r"scene.yaml:\d+:\d+: error: .*viscosity.* is -1"):
        bpy.ops.dreampm.bake()
    addon = bpy.context.preferences.addons[MODULE].preferences
    addon.command = "/nowhere/dreampm"
    try:
        with pytest.raises(RuntimeError, match="preferences of the add-on"):
            bpy.ops.dreampm.bake()
    finally:
        addon.command = COMMAND


def test_a_command_that_is_another_program(studio, tmp_path):
    pool(studio)
    other = tmp_path / "other"
    other.write_text("#!/bin/sh\necho hello\n")
    other.chmod(0o755)
    addon = bpy.context.preferences.addons[MODULE].preferences
    addon.command = str(other)
    try:
        for press in (bpy.ops.dreampm.bake, bpy.ops.dreampm.estimate):
            with pytest.raises(RuntimeError, match="printed no list of materials"):
                press()
        seen = []
        panels.DREAMPM_PT_bake.draw(type("Panel", (), {"layout": Sheet(seen)}), bpy.context)
        assert any("printed no list" in " ".join(seen[i:i + 3]) for i in range(len(seen))), seen
        assert "dreampm.bake" not in seen and "preferences.addon_show" in seen
    finally:
        addon.command = COMMAND


def test_an_unsaved_file(studio):
    bpy.ops.wm.read_homefile(use_empty=True)
    with pytest.raises(RuntimeError, match="save the .blend file first"):
        bpy.ops.dreampm.bake()


def test_check_says_what_it_takes(studio):
    pool(studio)
    bpy.ops.dreampm.estimate()
    particles, memory = baking.session.notes[:2]
    assert int(particles.split()[0]) == pytest.approx(500, rel=0.05) and "of memory" in memory


def key(thing, path, frame, value):
    setattr(thing, path, value)
    thing.keyframe_insert(path, frame=frame)


def test_animation_moves_colliders(studio):
    pool(studio)
    studio.scene.frame_start = 5
    door = studio.box("Door", (0.3, 0, 0), (0.32, 0.2, 0.3), "COLLIDER")
    door.rotation_mode = "XYZ"
    key(door, "location", 5, (0.31, 0.1, 0.15))
    key(door, "location", 24, (0.25, 0.1, 0.15))
    key(door, "rotation_euler", 5, (0, 0, 0))
    key(door, "rotation_euler", 24, (0, 0, 1))
    still = studio.box("Still", (0.36, 0, 0), (0.38, 0.1, 0.1), "COLLIDER")
    still.modifiers.new("Bevel", "BEVEL").width = 0.002
    swells = studio.box("Swells", (0.36, 0.12, 0), (0.38, 0.18, 0.1), "COLLIDER")
    key(swells, "scale", 5, (0.02, 0.06, 0.1))
    key(swells, "scale", 24, (0.02, 0.06, 0.2))
    bends = studio.box("Bends", (0.36, 0.12, 0.3), (0.38, 0.18, 0.38), "COLLIDER")
    bends.shape_key_add(name="Basis")
    bends.shape_key_add(name="Up").data[0].co.z += 0.5
    block = bends.data.shape_keys.key_blocks["Up"]
    block.value = 0
    block.keyframe_insert("value", frame=5)
    block.value = 1
    block.keyframe_insert("value", frame=24)
    studio.scene.frame_set(12)
    bpy.ops.dreampm.estimate()
    assert studio.scene.frame_current == 12
    text = studio.scene_text
    # Turning about Blender's z by one radian is turning about y; the origin is where it turns about.
    assert "about: [0.31, 0.15, -0.1]" in text and f"angle: {math.degrees(1):.6}"[:13] in text
    assert "axis: [0.0, 1.0, 0.0]" in text and "position: [-0.06" in text and text.count("motion:") == 1
    assert text.count("meshes:") == 2 and "Swells.000020.ply" in text and "Bends.000020.ply" in text
    assert "frames: 20" in text


def test_a_mirrored_object_is_not_inside_out(studio):
    water = pool(studio)
    water.scale.x *= -1
    bpy.ops.dreampm.estimate()
    said = subprocess.run([COMMAND, "info", studio.folder / "dreampm/models/Pool.ply"], capture_output=True, text=True)
    assert "volume           0.004 m^3" in said.stdout, said


def test_cut_and_shell_and_open_meshes(studio):
    pool(studio)
    studio.box("Post", (0.05, 0.05, 0), (0.11, 0.11, 0.2), "COLLIDER")
    wall = studio.box("Wall", (0.24, 0, 0), (0.35, 0.2, 0.2), "COLLIDER", shell=True, thickness=0.04)
    bpy.ops.dreampm.estimate()
    text = studio.scene_text
    assert "cut: [Post]" in text and "difference" not in text
    assert wall.dreampm.thickness == pytest.approx(0.04) and "thickness: 0.04" in text
    bpy.ops.mesh.primitive_plane_add(size=0.1, location=(0.3, 0.1, 0.3))
    bpy.context.object.dreampm.role = "COLLIDER"
    with pytest.raises(RuntimeError, match="Plane"):
        bpy.ops.dreampm.estimate()
    assert baking.session.error.startswith("scene.yaml:") and ": models/Plane.ply: encloses" in baking.session.error
    assert any("Plane is not closed" in note and "Shell" in note for note in baking.session.notes)


def test_what_has_no_faces_takes_no_part_and_is_named(studio):
    pool(studio)
    studio.box("Post", (0.05, 0.05, 0), (0.11, 0.11, 0.2), "NONE")
    group = bpy.data.collections.new("Posts")
    empty, instance = bpy.data.objects.new("Nothing", None), bpy.data.objects.new("Copies", None)
    instance.instance_type, instance.instance_collection = "COLLECTION", group
    for thing in (empty, instance):
        studio.scene.collection.objects.link(thing)
        thing.dreampm.role = "COLLIDER"
    bpy.context.view_layer.update()
    bpy.ops.dreampm.estimate()
    assert "colliders:" not in studio.scene_text
    assert any(note.startswith("Nothing is no mesh (empty) and takes no part") for note in baking.session.notes)
    assert any("Copies is an instance of a collection" in note and "Make Instances Real" in note
               for note in baking.session.notes)


def test_cancel_then_resume_then_free(studio):
    pool(studio)
    studio.scene.frame_end = 300
    program = baking.preferences.find_command()
    captured, folder, materials = baking.write(bpy.context)
    run = baking.run_of(studio.scene)
    bake = baking.Bake(studio.scene, baking.job.bake_calls(program, f"{folder}/scene.yaml", run.path, 2),
                       baking.Baked(captured, materials))
    baking.session.bake = bake
    bake.start()
    assert not bpy.ops.dreampm.bake.poll() and bpy.ops.dreampm.cancel.poll()
    end = time.monotonic() + 60
    while bake.poll() and bake.job.progress.done < 4:
        assert time.monotonic() < end
        time.sleep(0.02)
    # While it goes on, what is there is shown: particles, since no surface is.
    result = bpy.data.objects["DreaMPM water"]
    assert len(result.data.vertices) == pytest.approx(500, rel=0.05) and not result.data.polygons
    bpy.ops.dreampm.cancel()
    while bake.poll():
        time.sleep(0.02)
    reached = run.last_frame()
    assert bake.job.state == "stopped" and 3 < reached < 300

    studio.scene.frame_end = reached + 2
    bpy.ops.wm.save_mainfile()
    bpy.ops.wm.open_mainfile(filepath=bpy.data.filepath)  # a restart forgets nothing
    offers_resume = panels.DREAMPM_PT_bake.can_resume
    assert offers_resume(bpy.context.scene)
    bpy.ops.dreampm.bake(resume=True)
    assert not offers_resume(bpy.context.scene)
    assert baking.session.bake.job.state == "done" and run.last_frame() == reached + 2
    bpy.context.scene.frame_set(reached + 2)
    assert bpy.data.objects["DreaMPM water"].data.polygons

    bpy.ops.dreampm.free()
    assert "DreaMPM water" not in bpy.data.objects and not (studio.folder / "dreampm/run").exists()
    assert not bpy.context.scene.dreampm.baked
    with pytest.raises(RuntimeError, match="nothing to go on from"):
        bpy.ops.dreampm.bake(resume=True)


def test_a_fault_stops_the_command(studio, monkeypatch):
    pool(studio)
    studio.scene.frame_end = 300

    def fails(scene):
        raise KeyError("socket")

    monkeypatch.setattr(baking.playback, "refresh", fails)
    with pytest.raises(RuntimeError, match="socket"):
        bpy.ops.dreampm.bake()
    assert not baking.session.busy and "fault of the add-on" in baking.session.error
    assert baking.run_of(studio.scene).record()["status"] == "interrupted"


def test_a_floating_body_gets_keyframes(studio):
    pool(studio)
    studio.scene.frame_start, studio.scene.frame_end = 11, 16
    crate = studio.box("Crate", (0.05, 0.05, 0.2), (0.15, 0.15, 0.26), "FLOATING", density=400)
    bpy.context.view_layer.update()
    before = numpy.array(crate.matrix_world)
    bpy.ops.dreampm.bake()
    studio.scene.frame_set(11)
    assert numpy.allclose(crate.matrix_world, before, atol=1e-6)
    studio.scene.frame_set(12)
    assert crate.location.z == pytest.approx(0.23 - 9.81 / 2 / 24 ** 2, rel=0.01)
    assert crate.location.x == pytest.approx(0.1)
    bpy.ops.dreampm.bake()  # from the same place again
    studio.scene.frame_set(11)
    assert numpy.allclose(crate.matrix_world, before, atol=1e-6)
    bpy.ops.dreampm.free()
    assert crate.animation_data is None and numpy.allclose(crate.matrix_world, before, atol=1e-6)
    key(crate, "location", 1, (0, 0, 1))
    with pytest.raises(RuntimeError, match="Crate is animated"):
        bpy.ops.dreampm.bake()


def test_sand_is_shown_as_points_and_units_are_kept(studio):
    """A scene in centimeters: sizes, speeds and the radius of the points are in its units."""
    studio.scene.unit_settings.scale_length = 0.01
    studio.scene.frame_end = 4
    heap = studio.box("Heap", (5, 5, 10), (15, 15, 20), "MATERIAL", velocity=(0.2, 0, 0))
    heap.dreampm.material = "sand/dry"
    # The panel shows the number that is stored, without the scene's unit in it: it is in m/s.
    assert heap.dreampm.bl_rna.properties["velocity"].unit == "NONE"
    studio.domain((0, 0, 0), (20, 20, 30), 2)
    bpy.ops.dreampm.bake()
    assert "min: [0.0, 0.0, -0.2]" in studio.scene_text and "spacing: 0.02" in studio.scene_text
    result = bpy.data.objects["DreaMPM dry"]
    studio.scene.frame_set(4)
    co = numpy.array([v.co[:] for v in result.data.vertices])
    speed = numpy.array([v.vector[:] for v in result.data.attributes["velocity"].data])
    assert len(co) == pytest.approx(125, rel=0.2)
    assert len(set(v.value for v in result.data.attributes["id"].data)) == len(co)
    assert "velocity: [0.2, 0.0, 0.0]" in studio.scene_text
    assert speed[:, 0].mean() == pytest.approx(20, rel=0.03)
    assert speed[:, 2].mean() == pytest.approx(-981 * 3 / 24, rel=0.03)
    assert co[:, 2].max() == pytest.approx(20 - 981 / 2 / 64, abs=1.2) and co[:, 2].min() > 0
    evaluated = result.evaluated_get(bpy.context.evaluated_depsgraph_get())
    if bpy.app.version < (5, 0):  # they have no door to the points
        return
    geometry = evaluated.evaluated_geometry()
    cloud = geometry.pointcloud
    assert len(cloud.points) == len(co) and cloud.points[0].radius == pytest.approx(1)
    assert "velocity" in cloud.attributes


def test_two_materials_and_a_look_of_ones_own(studio):
    pool(studio)
    studio.scene.frame_end = 2
    jelly = studio.box("Jelly", (0.28, 0.05, 0), (0.36, 0.15, 0.1), "MATERIAL")
    jelly.dreampm.material = "elastic/jelly"
    bpy.ops.dreampm.bake()
    water, wobble = bpy.data.objects["DreaMPM water"], bpy.data.objects["DreaMPM jelly"]
    assert water.data.polygons and wobble.data.polygons and water.data.materials[0] != wobble.data.materials[0]
    assert min(v.co.x for v in wobble.data.vertices) > 0.26
    mine = bpy.data.materials.new("Mine")
    water.data.materials[0] = mine
    bpy.ops.dreampm.bake()
    studio.scene.frame_set(2)
    assert water.data.materials[0] == mine
    jelly.dreampm.role = "NONE"
    bpy.ops.dreampm.bake()
    assert "DreaMPM jelly" not in bpy.data.objects and water.data.polygons


def test_an_emitter_starts_with_nothing(studio):
    studio.box("Tap", (0.05, 0.05, 0.3), (0.15, 0.15, 0.34), "EMITTER", velocity=(0, 0, -1), start=3)
    studio.domain((0, 0, 0), (0.2, 0.2, 0.4), 0.02)
    studio.scene.frame_end = 8
    bpy.ops.dreampm.bake()
    result = bpy.data.objects["DreaMPM water"]
    studio.scene.frame_set(1)
    assert not result.data.vertices and "velocity" in result.data.attributes
    studio.scene.frame_set(8)
    assert result.data.polygons and max(v.co.z for v in result.data.vertices) < 0.36


def test_a_run_of_the_command_opens(studio, tmp_path):
    pool(studio)
    studio.scene.frame_end = 3
    bpy.ops.dreampm.bake()
    run = str(studio.folder / "dreampm/run")
    bpy.ops.wm.read_homefile(use_empty=True)
    bpy.ops.dreampm.load(directory=run)
    assert bpy.data.objects["DreaMPM water"].data.polygons
    with pytest.raises(RuntimeError, match="no folder of a run"):
        bpy.ops.dreampm.load(directory=str(tmp_path))


PAINTS = """dreampm: 1
name: paints
space: {max: [0.8, 0.5, 0.2], spacing: 0.02, walls: {ceiling: {type: open}}}
time: {fps: 24, frames: 14}
materials: {paint: {type: newtonian, preset: water}}
bodies:
  blue: {material: paint, color: [0, 0.13, 0.52], shape: {box: {min: [0, 0, 0], max: [0.2, 0.4, 0.2]}}}
  yellow: {material: paint, color: [0.99, 0.83, 0], shape: {box: {min: [0.6, 0, 0], max: [0.8, 0.4, 0.2]}}}
surface: {attributes: [velocity, color, source, age, vorticity]}
foam: {amount: 0.05, radius: 0.002}
render: {looks: {paint: {type: opaque}}}
"""


def column(data, name, member, width):
    values = numpy.empty(width * len(data.attributes[name].data), "f4")
    data.attributes[name].data.foreach_get(member, values)
    return values.reshape(-1, width)


@pytest.fixture(scope="module")
def paints(tmp_path_factory):
    folder = tmp_path_factory.mktemp("paints")
    (folder / "scene.yaml").write_text(PAINTS)
    for call in (["run", "scene.yaml", "--out", "run"], ["foam", "run"], ["surface", "run"]):
        subprocess.run([COMMAND, *call], cwd=folder, check=True, capture_output=True)
    return folder / "run"


def test_foam_of_a_run_is_points_of_their_own_radii(studio, paints):
    bpy.ops.dreampm.load(directory=str(paints))
    scene = bpy.context.scene
    scene.frame_set(scene.frame_start + 13)
    foam = bpy.data.objects["DreaMPM foam"]
    file = ply.read(paints / "foam/foam_000014.ply")
    assert len(file) > 100
    assert len(foam.data.vertices) == len(file)
    numpy.testing.assert_allclose(column(foam.data, "radius", "value", 1)[:, 0], file.columns["radius"], rtol=1e-6)
    assert foam.data.attributes["type"].data_type == "INT" and "age" in foam.data.attributes
    geometry = foam.evaluated_get(bpy.context.evaluated_depsgraph_get()).evaluated_geometry()
    cloud = geometry.pointcloud
    assert len(cloud.points) == len(file)
    numpy.testing.assert_allclose(column(cloud, "radius", "value", 1)[:, 0], file.columns["radius"], rtol=1e-6)
    assert cloud.materials[0].name == "DreaMPM foam"
    scene.frame_set(scene.frame_start)
    assert len(foam.data.vertices) == 0  # nothing has moved yet
    # Opened again it is the same object.
    bpy.ops.dreampm.load(directory=str(paints))
    assert [o.name for o in bpy.data.objects if o.dreampm_result.foam] == ["DreaMPM foam"]


def test_vertices_hold_what_the_surface_does(studio, paints):
    bpy.ops.dreampm.load(directory=str(paints))
    scene = bpy.context.scene
    scene.frame_set(scene.frame_start + 13)
    data = bpy.data.objects["DreaMPM paint"].data
    file = ply.read(paints / "surface/surface_000014.ply")
    assert data.attributes["source"].data_type == "INT"
    assert set(column(data, "source", "value", 1)[:, 0]) == {0, 1}
    numpy.testing.assert_allclose(column(data, "age", "value", 1), 13 / 24, rtol=1e-5)
    colors = column(data, "color", "color_srgb", 4)
    numpy.testing.assert_allclose(colors[:, :3] * 255, file.vectors(("red", "green", "blue")), atol=0.51)
    vorticity = column(data, "vorticity", "vector", 3)
    numpy.testing.assert_allclose(vorticity[:, 2], file.columns["vorticity_y"], rtol=1e-6)


class Sheet:
    """Takes the place of a layout: what is drawn must exist. It notes texts and names."""

    def __init__(self, seen):
        object.__setattr__(self, "seen", seen)

    def __getattr__(self, name):
        assert name in bpy.types.UILayout.bl_rna.functions or name in bpy.types.UILayout.bl_rna.properties, name
        return lambda *words, **more: Sheet(self.seen)

    def __setattr__(self, name, value):
        assert name in bpy.types.UILayout.bl_rna.properties, name

    def prop(self, data, name, **_):
        assert name in data.bl_rna.properties, name
        self.seen.append(name)

    def label(self, text="", icon="NONE"):
        self.seen.append(text)

    def operator(self, name, **_):
        rna = getattr(getattr(bpy.ops, name.split(".")[0]), name.split(".")[1]).get_rna_type()
        self.seen.append(name)
        return type("Settings", (), {"__setattr__": lambda _, key, value: self.known(rna, key)})()

    def operator_menu_enum(self, name, key):
        self.operator(name)

    def progress(self, factor, type, text):
        self.seen.append(text)

    @staticmethod
    def known(rna, key):
        assert key in rna.properties, key


@pytest.mark.parametrize("role", ["NONE", "LIQUID", "MATERIAL", "EMITTER", "COLLIDER", "FLOATING", "OUTFLOW"])
def test_panels_draw_what_exists(studio, role):
    water = pool(studio)
    water.dreampm.role = role
    water.dreampm.shell = True
    bpy.context.view_layer.objects.active = water
    if role in ("LIQUID", "EMITTER"):
        bpy.ops.dreampm.value_add(key="viscosity")
        bpy.ops.dreampm.value_add(key="tension")
    seen = []
    for panel in panels.CLASSES:
        panel.draw(type("Panel", (), {"layout": Sheet(seen), "can_resume": staticmethod(lambda scene: True)}),
                   bpy.context)
    assert {"dreampm.bake", "domain", "spacing", "voxel", "folder", "role"} <= set(seen)
    assert ("material" in seen) == (role in ("LIQUID", "MATERIAL", "EMITTER"))
    assert ("thickness" in seen) == (role == "COLLIDER") and ("density" in seen) == (role == "FLOATING")


def test_panels_show_errors_and_progress(studio, monkeypatch):
    pool(studio)
    baking.session.clear()
    baking.session.error = "scene.yaml:1:2: error: " + "a long line " * 20
    seen = []
    panel = type("Panel", (), {"layout": Sheet(seen), "can_resume": staticmethod(lambda scene: False)})
    panels.DREAMPM_PT_bake.draw(panel, bpy.context)
    assert "Error" in seen and max(len(text) for text in seen) < 80 and "dreampm.dismiss" in seen
    bake = baking.Bake(studio.scene, [["true"]], baking.Baked.__new__(baking.Baked))
    bake.job.state, bake.job.progress.stage = "running", "simulate"
    bake.job.progress.done, bake.job.progress.total = 3, 12
    monkeypatch.setattr(baking.session, "bake", bake)
    seen.clear()
    panels.DREAMPM_PT_bake.draw(panel, bpy.context)
    assert seen[0].startswith("Simulating 3/12") and "dreampm.cancel" in seen and "dreampm.bake" not in seen

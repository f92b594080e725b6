"""How runs are opened by hand, typed as the page has it; test_bowl.py types the guide."""
import os
import re
import subprocess

import bpy
import numpy
import pytest
from conftest import COMMAND, SOURCE
from mathutils import Vector
from test_addon import pool


def blocks(page, language):
    text = (SOURCE / "docs" / page).read_text()
    return re.findall(rf"^```{language}\n(.*?)^```", text, re.MULTILINE | re.DOTALL)


@pytest.fixture
def run(studio, monkeypatch):
    """A small run, whose frame 2 the extension shows."""
    pool(studio)
    studio.scene.frame_end = 3
    bpy.ops.dreampm.bake()
    studio.scene.frame_set(2)
    monkeypatch.chdir(studio.folder / "dreampm/run")
    return studio


def vectors(mesh, name):
    data = mesh.vertices if name == "co" else mesh.attributes[name].data
    out = numpy.empty(3 * len(data), dtype="f4")
    data.foreach_get("co" if name == "co" else "vector", out)
    return out.reshape(-1, 3)


def turned(thing, name):
    """In the axes of the world."""
    return vectors(thing.data, name) @ numpy.array(thing.matrix_world)[:3, :3].T


def test_by_hand_it_is_what_the_extension_shows(run):
    one, velocity, sequence = blocks("howto/open-in-blender.md", "python")
    shown = bpy.data.objects["DreaMPM water"]
    names = {}
    exec(one, names)
    thing = bpy.context.object
    assert numpy.allclose(turned(thing, "co"), vectors(shown.data, "co"), atol=1e-6)
    exec(velocity, names)
    assert numpy.allclose(turned(thing, "velocity"), vectors(shown.data, "velocity"), atol=1e-6)
    assert vectors(shown.data, "velocity")[:, 2].min() < -0.1
    exec(sequence, names)
    try:
        for frame in (1, 3):
            bpy.context.scene.frame_set(frame)
            assert numpy.allclose(turned(bpy.data.objects["Film"], "co"), vectors(shown.data, "co"), atol=1e-6)
    finally:
        bpy.app.handlers.frame_change_post.remove(names["show"])


@pytest.mark.parametrize("kind,setting", [("obj", "format=obj"), ("vdb", "type=fog")])
def test_other_files(run, kind, setting):
    subprocess.run([COMMAND, "run", "scene.yaml", "--out", ".", "--set", f"surface.{setting}", "--resume"],
                   check=True, capture_output=True)
    subprocess.run([COMMAND, "surface", "."], check=True, capture_output=True)
    shown = bpy.data.objects["DreaMPM water"]
    high, low = vectors(shown.data, "co").max(axis=0), vectors(shown.data, "co").min(axis=0)
    file = os.path.abspath(f"surface/surface_000002.{kind}")
    if kind == "obj":
        bpy.ops.wm.obj_import(filepath=file, forward_axis="NEGATIVE_Z", up_axis="Y")
    else:
        bpy.ops.object.volume_import(filepath=file, directory=os.path.dirname(file), files=[
            {"name": f"surface_{i:06}.vdb"} for i in (1, 2, 3)], use_sequence_detection=True, align="WORLD",
            location=(0, 0, 0))
        assert bpy.context.object.data.is_sequence
        bpy.context.object.rotation_euler.x = numpy.pi / 2
    bpy.context.view_layer.update()
    thing = bpy.context.object
    corners = numpy.array([tuple(thing.matrix_world @ Vector(c)) for c in thing.bound_box])
    # A level set reaches some cells beyond the surface, in whole blocks of 8 voxels.
    room = 0.005 if kind == "obj" else 0.25
    for beyond in (corners.max(axis=0) - high, low - corners.min(axis=0)):
        assert beyond.min() > -0.005 and beyond.max() < room

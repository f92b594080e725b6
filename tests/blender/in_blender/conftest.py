"""Blender as a module of Python, with the extension installed from its zip as a user does."""
import glob
import os
import pathlib

import bpy
import pytest

SOURCE = pathlib.Path(__file__).parents[3]
BUILD = pathlib.Path(os.environ.get("DREAMPM_COMMAND", SOURCE / "build/dreampm")).parent
COMMAND = str(BUILD / "dreampm")
MODULE = "bl_ext.user_default.dreampm"


def pytest_sessionstart():
    if "BLENDER_USER_RESOURCES" not in os.environ:
        pytest.exit("set BLENDER_USER_RESOURCES to an empty folder: else the tests install into your own Blender", 2)
    [archive] = glob.glob(str(BUILD / "dreampm-blender-*.zip"))
    bpy.ops.extensions.package_install_files(filepath=archive, repo="user_default", enable_on_install=True)
    bpy.context.preferences.addons[MODULE].preferences.command = COMMAND


class Studio:
    """A fresh file in a folder of its own, and what the tests do in it."""

    def __init__(self, folder, frames=24):
        bpy.ops.wm.read_homefile(use_empty=True)
        self.folder = folder
        bpy.ops.wm.save_as_mainfile(filepath=str(folder / "film.blend"))
        self.scene = bpy.context.scene
        self.scene.frame_start, self.scene.frame_end, self.scene.render.fps = 1, frames, 24
        self.settings.threads = 2

    @property
    def settings(self):
        return self.scene.dreampm

    def box(self, name, low, high, role="NONE", **settings):
        size = [h - l for l, h in zip(low, high)]
        bpy.ops.mesh.primitive_cube_add(size=1, location=[(l + h) / 2 for l, h in zip(low, high)])
        thing = bpy.context.object
        thing.name, thing.scale = name, size
        thing.dreampm.role = role
        for key, value in settings.items():
            setattr(thing.dreampm, key, value)
        return thing

    def domain(self, low, high, spacing):
        self.settings.domain = self.box("Domain", low, high)
        self.settings.spacing = spacing
        return self.settings.domain

    @property
    def scene_text(self):
        return (self.folder / "dreampm/scene.yaml").read_text()


@pytest.fixture
def studio(tmp_path):
    return Studio(tmp_path)

# SPDX-License-Identifier: GPL-3.0-or-later
"""Bakes in the background: writes the scene, runs the command, shows frames as they come."""
import atexit
import json
import os
import time

import bpy
from bpy.app.handlers import persistent

from . import floating, playback, preferences
from .capture import Capture, scale_of
from .core import command, job, setup
from .core.errors import DreampmError
from .core.run_folder import RunFolder

SCENE, RUN = "scene.yaml", "run"
PERIOD = 0.3  # s, between two looks at the command


def folder_of(scene):
    """Where a scene's simulation lies. Raises DreampmError where the .blend file lies nowhere yet."""
    folder = scene.dreampm.folder
    if folder.startswith("//") and not bpy.data.filepath:
        raise DreampmError("save the .blend file first: the simulation is written beside it")
    if not folder:
        raise DreampmError("the folder is empty: say where the simulation is to be written")
    return os.path.normpath(bpy.path.abspath(folder))


def run_of(scene):
    return RunFolder(os.path.join(folder_of(scene), RUN))


def write(context):
    """Writes the scene as it is now: the capture, its folder, and the name of each material."""
    preferences.known_materials(again=True)  # where the command fails it says why
    folder = folder_of(context.scene)
    try:
        os.makedirs(folder, exist_ok=True)
        captured = Capture(context, folder).run()
        materials = setup.write_scene(os.path.join(folder, SCENE), captured.setup)
    except OSError as error:
        raise DreampmError(f"{error.filename or folder}: {error.strerror}") from error
    return captured, folder, materials


class Baked:
    """What the frames in a folder are of; kept in the scene as text, so that a bake can go on after a restart."""

    def __init__(self, captured, materials):
        self.first_frame, self.scale = captured.first, captured.scale
        self.radius = captured.setup.spacing / 2
        self.materials = [{"name": name, "type": m.type, "preset": m.preset, "particles": m.particles}
                          for m, name in materials.items()]
        self.rigid = dict(captured.rigid)

    @classmethod
    def of(cls, scene):
        if not scene.dreampm.baked:
            return None
        self = cls.__new__(cls)
        self.__dict__.update(json.loads(scene.dreampm.baked))
        return self

    def frames_to(self, scene):
        """How many frames the run has when it reaches the last one that the scene asks for now."""
        return scene.dreampm.frames()[1] - self.first_frame + 1

    def meshed(self):
        return [m["name"] for m in self.materials if not m["particles"]]

    def keep(self, scene):
        scene.dreampm.baked = json.dumps(self.__dict__)


class Bake:
    """One bake of one scene, from its start to its end."""

    def __init__(self, scene, calls, baked, warnings=(), fresh=True):
        self.scene_name, self.baked, self.fresh = scene.name, baked, fresh
        self.run = run_of(scene)
        self.warnings = list(warnings)
        self.job = job.Job(calls, self._file_of)
        self.started = False
        self.seen = None

    @property
    def scene(self):
        return bpy.data.scenes.get(self.scene_name)

    def _file_of(self, stage, frame):
        if stage == "surface":
            meshed = self.baked.meshed()
            # A frame is done when its last mesh is.
            return self.run.surface_of(meshed[-1] if meshed else "", frame, meshed)
        return self.run.particle_file(frame)

    def start(self):
        self.job.start()

    def poll(self):
        """Looks at the command; shows what is new. Whether it still works."""
        working = self.job.poll()
        scene = self.scene
        if not scene:
            self.job.cancel()
            return working
        if self.job.progress.stage and not self.started:
            self._begin(scene)
        if self.started:
            at = (self.job.progress.stage, self.job.progress.done)
            if at != self.seen or not working:
                self.seen = at
                self.warnings += playback.refresh(scene)
        if not working:
            self._end(scene)
        return working

    def _begin(self, scene):
        """The command has taken the scene: what was there before is gone."""
        self.started = True
        if self.fresh:
            self.run.forget_surfaces()
            for name, _ in self.baked.rigid.values():
                if name in scene.objects:
                    floating.release(scene.objects[name])
        self.baked.keep(scene)
        playback.remove_results(scene, self.run.path, keep=[m["name"] for m in self.baked.materials])
        for m in self.baked.materials:
            playback.make_result(scene, self.run.path, m["name"], self.baked.first_frame, self.baked.scale,
                                 m["particles"], m["type"], m["preset"], self.baked.radius)

    def _end(self, scene):
        folder = os.path.dirname(self.run.path)
        self.warnings += [command.shorter(w, folder) for w in self.job.progress.warnings]
        if not self.started:
            return
        poses = self.run.poses()
        for name, (thing, rest) in self.baked.rigid.items():
            if name in poses and thing in scene.objects:
                floating.animate(scene.objects[thing], rest, poses[name], self.baked.first_frame, self.baked.scale)


class Session:
    """The bake that goes on, or the last one; one at a time."""

    def __init__(self):
        self.bake = None
        self.error, self.notes = "", []

    @property
    def busy(self):
        return self.bake is not None and self.bake.job.running

    def clear(self):
        self.error, self.notes = "", []

    def begin(self, bake):
        self.clear()
        self.bake = bake
        bake.start()
        if bpy.app.background:
            while self._look() is not None:
                time.sleep(0.05)
        else:
            bpy.app.timers.register(self._look, first_interval=0.1, persistent=True)

    def _look(self):
        """For Blender's timers: seconds to the next look, or None at the end."""
        if not self.bake:  # stopped
            return None
        try:
            working = self.bake.poll()
        except Exception as error:
            # Blender ends a timer that fails: nobody would look at the command any more.
            self.stop()
            self.error = f"a fault of the add-on, the bake is stopped: {error!r}"
            raise
        redraw()
        if working:
            return PERIOD
        self.notes = self.bake.warnings
        if self.bake.job.state == "failed":
            self.error = command.shorter(self.bake.job.error, os.path.dirname(self.bake.run.path))
            if not bpy.app.background:
                pop_up(self.error)
        return None

    def stop(self):
        """Lets the command save its state: Blender ends, opens another file, or switches the add-on off."""
        if self.busy:
            self.bake.job.cancel()
            self.bake.job.wait(30)
        self.bake = None


session = Session()


def redraw():
    for window in bpy.context.window_manager.windows if bpy.context.window_manager else []:
        for area in window.screen.areas:
            if area.type in ("VIEW_3D", "PROPERTIES"):
                area.tag_redraw()


def pop_up(text):
    windows = bpy.context.window_manager.windows
    if not windows:
        return

    def draw(menu, _context):
        for line in text.splitlines():
            menu.layout.label(text=line)

    with bpy.context.temp_override(window=windows[0]):
        bpy.context.window_manager.popup_menu(draw, title="DreaMPM: the bake failed", icon="ERROR")


def bake(context):
    """From the start."""
    program = preferences.find_command()
    captured, folder, materials = write(context)
    scene_file, out = os.path.join(folder, SCENE), os.path.join(folder, RUN)
    settings = context.scene.dreampm
    session.begin(Bake(context.scene, job.bake_calls(program, scene_file, out, settings.threads, settings.backend),
                       Baked(captured, materials), captured.warnings))


def resume(context):
    """Goes on with the scene of the frames that are there, to the last frame that is asked for."""
    scene = context.scene
    run, baked = run_of(scene), Baked.of(scene)
    if not run.can_resume() or not baked:
        raise DreampmError("there is nothing to go on from: bake first")
    settings = scene.dreampm
    calls = job.resume_calls(preferences.find_command(), run.path, baked.frames_to(scene), settings.threads,
                             settings.backend)
    session.begin(Bake(scene, calls, baked, fresh=False))


def free(scene):
    """Removes the frames, what shows them, and the keyframes of floating bodies."""
    run, baked = run_of(scene), Baked.of(scene)
    run.free()
    playback.remove_results(scene, run.path)
    for name, _ in baked.rigid.values() if baked else ():
        if name in scene.objects:
            floating.release(scene.objects[name])
    scene.dreampm.baked = ""
    session.clear()


def load(scene, folder):
    """Shows a run that was made elsewhere, from the first frame of the scene on."""
    run = RunFolder(os.path.normpath(folder))
    spacing = run.record().get("spacing", 0.02)
    scale = scale_of(scene)
    for name in run.materials():
        surface = os.path.exists(run.surface_of(name, run.last_frame()))
        playback.make_result(scene, run.path, name, scene.frame_start, scale, not surface, radius=spacing / scale / 2)
    if run.has_foam():
        playback.make_foam(scene, run.path, scene.frame_start, scale)
    for error in playback.refresh(scene):
        raise DreampmError(error)


@persistent
def before_load(_path):
    session.stop()
    session.clear()


def register():
    atexit.register(session.stop)
    bpy.app.handlers.load_pre.append(before_load)


def unregister():
    bpy.app.handlers.load_pre.remove(before_load)
    session.stop()
    atexit.unregister(session.stop)

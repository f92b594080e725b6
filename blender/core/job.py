# SPDX-License-Identifier: GPL-3.0-or-later
"""Calls of the command, one after the other, while Blender goes on."""
import os
import queue
import signal
import subprocess
import threading

from .command import duration
from .errors import DreampmError
from .progress import TITLES, Progress

INTERRUPTED = 130


class Job:
    """`poll` now and then, from one thread: it reads what was printed and starts the next call."""

    def __init__(self, calls, file_of=None):
        self.calls = list(calls)
        self.progress = Progress(file_of)
        self.state = "waiting"  # running, stopping, done, failed, stopped
        self.error = ""
        self._process, self._lines = None, queue.Queue()
        self._reader = None

    @property
    def running(self):
        return self.state in ("running", "stopping")

    def start(self):
        self.state = "running"
        self._next()

    def _next(self):
        # A group of its own: Ctrl-C in the terminal of Blender is not meant for it.
        options = {"creationflags": subprocess.CREATE_NEW_PROCESS_GROUP} if os.name == "nt" else {
            "start_new_session": True}
        call = self.calls.pop(0)
        try:
            self._process = subprocess.Popen(call, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                                             stderr=subprocess.PIPE, text=True, errors="replace", **options)
        except OSError as error:
            self.state, self.error = "failed", f"{call[0]}: cannot be run: {error.strerror}"
            return
        self._reader = threading.Thread(target=self._read, args=(self._process.stderr,), daemon=True)
        self._reader.start()

    def _read(self, stream):
        for line in stream:
            self._lines.put(line)
        stream.close()

    def _take_lines(self):
        while not self._lines.empty():
            self.progress.read(self._lines.get())

    def poll(self):
        """Whether it still works."""
        if not self.running:
            return False
        self._take_lines()
        self.progress.count_files()
        code = self._process.poll()
        if code is None:
            return True
        self._reader.join()
        self._take_lines()
        if self.state == "stopping" or code == INTERRUPTED:
            self.state = "stopped"
        elif code:
            self.state, self.error = "failed", self._reason(code)
        elif self.calls:
            self._next()
        else:
            self.state = "done"
        return self.running

    def _reason(self, code):
        if self.progress.errors:
            return "\n".join(self.progress.errors)
        if code < 0:
            return f"the command was ended by {signal.Signals(-code).name}"
        return "\n".join(self.progress.lines[-3:]) or f"the command ended with exit code {code}"

    def cancel(self):
        """Asks it to stop: it ends its step, saves its state, and can go on from there."""
        if self.state != "running":
            return
        self.state = "stopping"
        if self._process.poll() is None:
            self._process.send_signal(signal.CTRL_BREAK_EVENT if os.name == "nt" else signal.SIGINT)

    def wait(self, seconds=None):
        """For a Blender without a window, and for its end."""
        try:
            self._process.wait(seconds)
        except subprocess.TimeoutExpired as error:
            raise DreampmError(f"the command did not end within {seconds} s") from error

    def text(self):
        """The state in a few words."""
        p = self.progress
        if self.state == "stopping":
            return "Stopping: saves its state"
        if not p.stage:
            return "Preparing"
        left = p.seconds_left()
        return f"{TITLES.get(p.stage, p.stage)} {p.done}/{p.total}" + (f", {duration(left)} left" if left else "")


def bake_calls(command, scene, out, threads=0, backend="cpu"):
    """Simulates from the start, in place of what was baked before, then meshes."""
    limit = ["--threads", str(threads)] if threads else []
    return [[command, "run", scene, "--out", out, "--overwrite", "--backend", backend, *limit],
            [command, "surface", out, *limit]]


def resume_calls(command, out, frames, threads=0, backend="cpu"):
    """Goes on with what lies in the folder, whatever became of the scene since, up to that number of frames."""
    limit = ["--threads", str(threads)] if threads else []
    scene = os.path.join(out, "scene.yaml")
    return [[command, "run", scene, "--set", f"time.frames={frames}", "--out", out, "--resume", "--backend", backend,
             *limit],
            [command, "surface", out, *limit]]

# SPDX-License-Identifier: GPL-3.0-or-later
"""How far the command is, from the lines that it prints and the files that it writes."""
import os
import re
import time

LINE = re.compile(r"(?P<stage>[a-z]+): frame (?P<done>\d+)/(?P<total>\d+)")
ERROR = re.compile(r"(?:.+?: )?error: ")
WARNING = re.compile(r"(?:.+?: )?warning: ")
TITLES = {"simulate": "Simulating", "surface": "Meshing"}


class Progress:
    """Lines come every ten seconds or so; files of frames are counted in between. `file_of(stage, frame)` is the file
    that a frame leaves."""

    def __init__(self, file_of=None, clock=time.monotonic):
        self.file_of, self.clock = file_of, clock
        self.stage, self.done, self.total = "", 0, 0
        self.errors, self.warnings, self.lines = [], [], []
        self._first, self._since = 0, clock()

    def read(self, line):
        line = line.rstrip()
        if not line:
            return
        found = LINE.match(line)
        if found:
            self._at(found["stage"], int(found["done"]), int(found["total"]))
        elif ERROR.match(line):
            self.errors.append(line)
        elif WARNING.match(line):
            self.warnings.append(line)
        self.lines.append(line)
        del self.lines[:-200]

    def _at(self, stage, done, total):
        if stage != self.stage:
            # What a resumed stage found done must not flatter the pace.
            self.stage, self._first, self._since, self.done = stage, done, self.clock(), 0
        self.done, self.total = max(self.done, done), total

    def count_files(self):
        """Frames that were finished since the last line."""
        if not self.file_of or not self.stage:
            return
        while self.done < self.total and os.path.exists(self.file_of(self.stage, self.done + 1)):
            self.done += 1

    @property
    def factor(self):
        return self.done / self.total if self.total else 0.0

    def seconds_left(self):
        """At the pace of this stage so far, or None before there is one."""
        made = self.done - self._first
        if made <= 0 or self.done >= self.total:
            return None
        return (self.clock() - self._since) * (self.total - self.done) / made

"""The command `dreampm` of a wheel."""
import os
import sys

from dreampm._video import find_ffmpeg


def main() -> None:
    command = os.path.join(os.path.dirname(os.path.abspath(__file__)), "bin", "dreampm")
    if not os.access(command, os.X_OK):
        sys.exit(f"{command}: no such command: the package is not of a wheel; build/dreampm is the command there")
    find_ffmpeg()
    os.execv(command, ["dreampm", *sys.argv[1:]])

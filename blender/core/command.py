# SPDX-License-Identifier: GPL-3.0-or-later
"""The command `dreampm`: where it is, and what materials it knows."""
import dataclasses
import importlib.util
import json
import os
import shutil
import subprocess

from . import axes
from .errors import DreampmError
from .progress import ERROR


def in_package():
    """The command of the Python package dreampm, if that is installed here."""
    try:
        spec = importlib.util.find_spec("dreampm")
    except (ImportError, ValueError):
        return None
    for folder in (spec.submodule_search_locations or []) if spec else []:
        path = os.path.join(folder, "bin", "dreampm")
        if os.access(path, os.X_OK):
            return path
    return None


def find(preference=""):
    """The path of the command: the one of the preferences, else on PATH, else of the Python package."""
    if preference:
        path = os.path.expanduser(preference)
        if os.path.isdir(path):
            path = os.path.join(path, "dreampm")
        if os.access(path, os.X_OK) and os.path.isfile(path):
            return path
        raise DreampmError(f"{preference}: no such command; the preferences of the add-on say where dreampm is")
    path = shutil.which("dreampm") or in_package()
    if not path:
        raise DreampmError("the command dreampm is not on PATH: install it, or say in the preferences of the add-on "
                           "where it is")
    return path


@dataclasses.dataclass(frozen=True)
class Parameter:
    key: str
    unit: str
    default: object  # a number, a word, or None where it is derived
    low: float
    high: float
    help: str
    words: tuple


@dataclasses.dataclass(frozen=True)
class Choice:
    """A type of material, or one of its presets."""
    type: str
    preset: str
    help: str
    liquid: bool
    parameters: tuple
    values: dict

    @property
    def key(self):
        return f"{self.type}/{self.preset}"

    @property
    def label(self):
        name = self.preset or self.type
        return name.replace("_", " ").capitalize()

    def parameter(self, key):
        return next((p for p in self.parameters if p.key == key), None)


def ask(command, *words):
    """What a verb that only prints says. Raises DreampmError with its own words."""
    try:
        done = subprocess.run([command, *words], capture_output=True, text=True, timeout=60, stdin=subprocess.DEVNULL)
    except OSError as error:
        raise DreampmError(f"{command}: cannot be run: {error.strerror}") from error
    except subprocess.TimeoutExpired as error:
        raise DreampmError(f"{command} {' '.join(words)}: no answer within a minute") from error
    if done.returncode:
        said = [line for line in done.stderr.splitlines() if line.strip()]
        errors = [line for line in said if ERROR.match(line)] or said
        raise DreampmError("\n".join(errors) or f"{command} {' '.join(words)}: exit code {done.returncode}")
    return done.stdout


def shorter(text, folder):
    """What the command says, as a user of Blender reads it: names of files beside the scene without their folder,
    which is long and known, and sides of the domain by Blender's axes."""
    return axes.sides_in_blender(text.replace(os.path.join(folder, ""), ""))


def choices(command):
    """Every preset of every material, and each type with its defaults where it has no preset: liquids first."""
    said = ask(command, "materials", "--json")
    try:
        return choices_in(json.loads(said))
    except (ValueError, KeyError, TypeError) as error:
        raise DreampmError(f"{command} materials --json: printed no list of materials: this is another program, or "
                           "another version than the add-on's") from error


def choices_in(materials):
    found = []
    for m in materials:
        parameters = tuple(Parameter(p["key"], "" if p["unit"] == "1" else p["unit"], p["default"], p["min"], p["max"],
                                     p["help"], tuple(p.get("words", ()))) for p in m["parameters"])
        for preset in m["presets"] or [m["defaults"]]:
            name = preset["name"] if m["presets"] else ""
            about = f"{m['help']}; {preset['source']}" if preset["source"] else m["help"]
            found.append(Choice(m["name"], name, about[:1].upper() + about[1:], m["liquid"], parameters,
                                preset["values"]))
    return sorted(found, key=lambda c: not c.liquid)


_known = {}


def known_choices(command, again=False):
    """The same, asked once for each version of the command, since panels are drawn all the time. That it failed is kept,
    too; `again`: it is asked anew then."""
    key = (command, os.stat(command).st_mtime_ns)
    if key not in _known or (again and isinstance(_known[key], str)):
        _known.clear()
        try:
            _known[key] = choices(command)
        except DreampmError as error:
            _known[key] = str(error)
    if isinstance(_known[key], str):
        raise DreampmError(_known[key])
    return _known[key]


def estimate(command, scene):
    """What `dreampm check --json` says of a scene that has no error."""
    return json.loads(ask(command, "check", scene, "--json"))


def estimate_lines(said):
    """The same in lines for a person."""
    def size(n):
        return f"{n / 1e9:.1f} GB" if n >= 1e9 else f"{n / 1e6:.0f} MB"

    seconds = said["seconds"]["simulate"] + said["seconds"]["surface"]
    lines = [f"{said['particles']:,} particles" + (f", up to {said['inflow']:,} come in" if said.get("inflow") else ""),
             f"{size(said['memory_bytes'])} of memory, {size(said['disk_bytes'])} on disk",
             f"about {duration(seconds)}"]
    return lines + said.get("warnings", [])


def duration(seconds):
    s = round(max(0, seconds))
    if s < 60:
        return f"{s} s"
    if s < 3600:
        return f"{s // 60} min {s % 60:02} s"
    return f"{s // 3600} h {s // 60 % 60:02} min"

"""The scenes of tools/gpu_check, and what it reads and looks for."""
import json
import os
import pathlib
import re
import shutil
import signal
import struct
import subprocess

ROOT = pathlib.Path(__file__).resolve().parent.parent
MATERIALS = {
    "newtonian": "", "viscoplastic": ", yield_stress: 40", "elastic": ", youngs_modulus: 2.0e4",
    "neo_hookean": ", youngs_modulus: 2.0e4, transfer: asflip", "snow": "", "sand": ", youngs_modulus: 1.0e5",
}
SMALL = """dreampm: 1
name: small
space: {{max: [0.24, 0.2, 0.16], spacing: 0.02}}
time: {{fps: 50, frames: 4}}
materials: {{matter: {{type: {material}{values}}}, water: {{type: newtonian}}}}
bodies:
  thrown: {{material: matter, shape: {{box: {{min: [0.02, 0.06, 0.02], max: [0.1, 0.14, 0.12]}}}}, velocity: [1, 0, 0]}}
  pool: {{material: water, shape: {{box: {{min: [0, 0, 0], max: [0.24, 0.04, 0.16]}}}}, cut: [ball]}}
colliders: {{ball: {{shape: {{sphere: {{radius: 0.04}}, center: [0.18, 0.06, 0.08]}}, friction: 0.3}}}}
"""
# What a scene may hold, as far as a device computes it: two velocity fields, viscosity in stages, boundary layers, images,
# colliders that stand, move and are thin, rigid bodies, force fields, an emitter, a sink.
ALL_KINDS = """dreampm: 1
name: all-kinds
space: {max: [0.24, 0.2, 0.16], spacing: 0.02, walls: {all: {type: separate, skin_friction: true}, x_max: {type: stick}}}
time: {fps: 100, frames: 4, damping: 1}
materials:
  honey: {type: newtonian, viscosity: 1000, density: 1400, bulk_modulus: 1.0e5, transfer: flip, flip_memory: 0.03}
  sand: {type: sand, youngs_modulus: 1.0e5}
bodies:
  pool: {material: honey, shape: {box: {min: [0, 0, 0], max: [0.24, 0.05, 0.16]}}, cut: [ball, plate, crate]}
  heap: {material: sand, shape: {box: {min: [0.04, 0.06, 0.02], max: [0.12, 0.12, 0.08]}}, velocity: [1, -2, 0]}
emitters:
  tap: {material: honey, shape: {cylinder: {radius: 0.03, height: 0.02}, center: [0.12, 0.16, 0.08]}, velocity: [0, -1, 0], pool: 400}
sinks: {drain: {shape: {box: {min: [0, 0, 0], max: [0.05, 0.03, 0.16]}}}}
colliders:
  ball: {shape: {sphere: {radius: 0.04}, center: [0.18, 0.04, 0.08]}, friction: 0.3, motion: {velocity: [-0.3, 0, 0]}}
  plate: {shape: {box: {size: [0.01, 0.1, 0.1]}, center: [0.14, 0.05, 0.06]}, type: stick}
rigid:
  crate: {shape: {box: {size: [0.06, 0.06, 0.06]}, center: [0.06, 0.05, 0.12]}, density: 500}
  float: {shape: {sphere: {radius: 0.03}, center: [0.2, 0.13, 0.12]}, density: 700}
fields:
  pull: {type: attractor, point: [0.2, 0.1, 0.08], strength: 0.2, radius: 0.05}
  hand: {type: brush, point: [0.08, 0.06, 0.08], radius: 0.05, velocity: [0, 1, 0]}
"""
COLUMN = """dreampm: 1
name: column
space: {{max: [{wide}, {high}, {deep}], spacing: 0.01}}
time: {{fps: 60, frames: 1000}}
materials: {{matter: {{type: newtonian}}}}
bodies: {{column: {{material: matter, shape: {{box: {{min: [0, 0, 0], max: [{half}, {tall}, {deep}]}}}}}}}}
"""


def end(process):
    """Ends a command and what it started."""
    for sign, wait in ((signal.SIGTERM, 3), (signal.SIGKILL, None)):
        try:
            os.killpg(process.pid, sign)
            process.communicate(timeout=wait)
            return
        except ProcessLookupError:
            return
        except subprocess.TimeoutExpired:
            continue


def sanitizer_program():
    """compute-sanitizer of the path, of CUDA's usual place, or of the environments that tools/python_env makes."""
    places = [shutil.which("compute-sanitizer"), "/usr/local/cuda/bin/compute-sanitizer",
              *sorted(ROOT.glob("build/*-env/lib/python3*/site-packages/nvidia/cu13/bin/compute-sanitizer"))]
    return next((p for p in places if p and pathlib.Path(p).exists()), None)


def available_memory():
    """Bytes, or None where the system does not say."""
    try:
        return int(re.search(r"MemAvailable:\s*(\d+) kB", pathlib.Path("/proc/meminfo").read_text()).group(1)) * 1024
    except (OSError, AttributeError):
        return None


def record_of(folder):
    return json.loads((folder / "run.json").read_text())


def distance(one, other):
    """Root of the mean square distance of particles [cells of 0.02 m]."""
    if one.keys() != other.keys():
        return float("inf")
    total = sum(sum((a - b) ** 2 for a, b in zip(one[i], other[i])) for i in one)
    return (total / len(one)) ** 0.5 / 0.02


def last_positions(folder):
    """Positions by id in the last particle file."""
    head, body = sorted((folder / "particles").iterdir())[-1].read_bytes().split(b"end_header\n", 1)
    sizes = {"float": "f", "uint": "I", "int": "i", "uchar": "B", "double": "d", "ushort": "H"}
    columns, count = [], 0
    for line in head.decode().splitlines():
        words = line.split()
        if words[:2] == ["element", "vertex"]:
            count = int(words[2])
        elif words and words[0] == "property":
            columns.append((words[2], sizes[words[1]]))
    row = struct.Struct("<" + "".join(c for _, c in columns))
    at = {name: n for n, (name, _) in enumerate(columns)}
    return {v[at["id"]]: (v[at["x"]], v[at["y"]], v[at["z"]]) for v in row.iter_unpack(body[:row.size * count])}

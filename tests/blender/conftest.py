"""What the tests of the add-on share: meshes, and a bake of a second by the command itself."""
import os
import pathlib
import sys

import numpy
import pytest

SOURCE = pathlib.Path(os.environ.get("DREAMPM_SOURCE", pathlib.Path(__file__).parents[2]))
COMMAND = os.environ.get("DREAMPM_COMMAND", str(SOURCE / "build/dreampm"))
sys.path.insert(0, str(SOURCE / "blender"))

from core import job, ply  # noqa: E402
from core.setup import Body, Collider, Material, Rigid, Setup, write_scene  # noqa: E402

WATER, JELLY = Material("newtonian", "water"), Material("elastic", "jelly")
CORNERS = numpy.array([(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)], dtype=float)
SIDES = [(0, 1, 3), (0, 3, 2), (4, 6, 7), (4, 7, 5), (0, 4, 5), (0, 5, 1), (2, 3, 7), (2, 7, 6), (0, 2, 6), (0, 6, 4),
         (1, 5, 7), (1, 7, 3)]


def box_file(folder, name, low, high):
    """A box between corners in Blender's axes, as the add-on writes it."""
    from core import axes
    low, high = numpy.array(low, dtype=float), numpy.array(high, dtype=float)
    (folder / "models").mkdir(exist_ok=True)
    ply.write_mesh(folder / "models" / f"{name}.ply", axes.to_scene(low + CORNERS * (high - low)), SIDES)
    return f"models/{name}.ply"


def small_setup(folder, frames=6):
    """In Blender's axes: water beside jelly on the floor z = 0, a block that floats, a plate; 1,200 particles."""
    return Setup(
        name="tub", low=(0, 0, 0), high=(0.4, 0.2, 0.3), spacing=0.02, fps=24, frames=frames, walls={"ceiling": "open"},
        bodies=[Body("water", WATER, box_file(folder, "water", (0, 0, 0), (0.2, 0.2, 0.1))),
                Body("jelly", JELLY, box_file(folder, "jelly", (0.28, 0.06, 0.1), (0.36, 0.14, 0.18)))],
        rigid=[Rigid("block", box_file(folder, "block", (0.05, 0.05, 0.2), (0.15, 0.15, 0.26)), (0.1, 0.1, 0.23),
                     density=400)],
        colliders=[Collider("plate", [box_file(folder, "plate", (0.24, 0, 0), (0.4, 0.2, 0.04))])])


def finish(one, seconds=120):
    """Polls a job to its end, as Blender's timer does."""
    import time
    end = time.monotonic() + seconds
    one.start()
    while one.poll():
        assert time.monotonic() < end, one.progress.lines
        time.sleep(0.02)
    return one


@pytest.fixture(scope="session")
def baked(tmp_path_factory):
    """(folder, materials, job) of the small setup, baked."""
    folder = tmp_path_factory.mktemp("baked")
    materials = write_scene(folder / "scene.yaml", small_setup(folder))
    done = finish(job.Job(job.bake_calls(COMMAND, str(folder / "scene.yaml"), str(folder / "run"), 2)))
    assert done.state == "done", done.error
    return folder, materials, done

"""What the tests share: small scenes of seconds, and where the tree and its build are."""
import os
import pathlib

import pytest

import dreampm as dm

SOURCE = pathlib.Path(os.environ["DREAMPM_SOURCE"])
COMMAND = pathlib.Path(os.environ["DREAMPM_COMMAND"])


@pytest.fixture
def dam():
    """The scene of the dam break at 2,900 particles."""
    return dm.Scene.load(SOURCE / "scenes/dam-break.yaml", variant="tiny")


@pytest.fixture
def tank():
    """A tank of water and a cube of jelly, a gate that moves, and a wall that can open."""
    return dm.Scene(
        space={"min": [0, 0, 0], "max": [0.4, 0.4, 0.2], "spacing": 0.02},
        time={"fps": 50, "frames": 11},
        materials={"water": {"type": "newtonian", "preset": "water"},
                   "jelly": {"type": "neo_hookean", "youngs_modulus": 2e4, "poissons_ratio": 0.4}},
        bodies={"pool": {"material": "water", "shape": {"box": {"min": [0, 0, 0], "max": [0.2, 0.2, 0.2]}}},
                "cube": {"material": "jelly", "color": [1, 0, 0],
                         "shape": {"box": {"min": [0.28, 0.04, 0.04], "max": [0.36, 0.12, 0.12]}}}},
        colliders={"gate": {"shape": {"box": {"min": [0.22, 0, 0], "max": [0.24, 0.3, 0.2]}}}})

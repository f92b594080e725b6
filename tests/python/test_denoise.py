"""Pictures without noise: by Open Image Denoise, which pip installs."""
import os
import pathlib
import subprocess

import numpy
import pyoidn
import pytest
from conftest import COMMAND

LIBRARY = pathlib.Path(pyoidn.__file__).parent / "oidn/lib/libOpenImageDenoise.so.2"
SCENE = """dreampm: 1
name: still
space: {min: [0, 0, 0], max: [0.4, 0.3, 0.4], spacing: 0.04}
time: {fps: 24, frames: 1}
materials: {jelly: {type: elastic, preset: jelly}}
bodies: {cube: {material: jelly, shape: {box: {min: [0.12, 0, 0.12], max: [0.28, 0.16, 0.28]}}}}
render: {size: [160, 120], noise: 1e-6, stage: {place: studio}}
"""


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    folder = tmp_path_factory.mktemp("denoise")
    (folder / "still.yaml").write_text(SCENE)
    for line in ("run still.yaml --out run", "surface run"):
        subprocess.run([COMMAND, *line.split()], cwd=folder, check=True, capture_output=True)
    return folder / "run"


def drawn(run, samples, *options, **environment):
    """The picture with that many samples, from 0 to 1."""
    scene = run / "scene.yaml"
    before = scene.read_text()
    scene.write_text("".join(line for line in before.splitlines(keepends=True) if "samples:" not in line)
                     .replace("render:\n", f"render:\n  samples: {samples}\n"))
    subprocess.run([COMMAND, "render", run, *options], check=True, capture_output=True,
                   env={**os.environ, "DREAMPM_OIDN": str(LIBRARY), **environment})
    import matplotlib.image
    return matplotlib.image.imread(next((run / "render").glob("*.png")))[..., :3].astype(float)


def test_it_takes_noise_out_the_same_for_any_number_of_threads(run):
    good, noisy = drawn(run, 256), drawn(run, 4)
    clean = drawn(run, 4, "--denoise", "--threads", "1")
    (run / "render").joinpath("frames.csv").unlink()
    again = drawn(run, 4, "--denoise", "--threads", "2")
    error = lambda picture: numpy.sqrt(numpy.mean((picture - good) ** 2))
    assert error(clean) < 0.7 * error(noisy)
    assert numpy.array_equal(clean, again)


def test_info_names_it():
    said = subprocess.run([COMMAND, "info"], check=True, capture_output=True, text=True,
                          env={**os.environ, "DREAMPM_OIDN": str(LIBRARY)})
    assert "Open Image Denoise 2." in said.stdout

"""The guide and the examples run as they stand, and come to what they say."""
import re
import subprocess
import sys
import xml.etree.ElementTree as xml

import pytest

from conftest import SOURCE


def run(file, folder, *words):
    done = subprocess.run([sys.executable, SOURCE / file, *words], cwd=folder, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_the_guide(tmp_path):
    run("docs/guide/python.py", tmp_path)
    for plot in ("dam", "fronts", "futures", "traced"):
        assert (tmp_path / f"{plot}.png").stat().st_size > 10_000, plot


def test_sweep(tmp_path):
    fronts = [float(line.split()[1]) for line in run("examples/python/sweep.py", tmp_path).splitlines()[1:]]
    assert len(fronts) == 5 and fronts == sorted(fronts, reverse=True) and fronts[0] > fronts[-1] + 0.1


def test_build(tmp_path):
    text = run("examples/python/build.py", tmp_path)
    assert "refused: bodies.drop.material: no material 'watr'; did you mean 'water'?" in text
    assert int(re.search(r"(\d+) % of the water", text)[1]) > 80


def test_fit(tmp_path):
    assert float(run("examples/python/fit.py", tmp_path).split()[0]) == pytest.approx(20, rel=0.01)


def test_rain(tmp_path):
    text = run("examples/python/rain.py", tmp_path)
    masses = [float(kg) for kg in re.findall(r"([0-9.]+) kg", text)]
    assert masses == sorted(masses) and masses[-1] > masses[0] + 1
    assert int(re.search(r"(\d+) particles ran out", text)[1]) > 100
    assert (tmp_path / "rain.png").stat().st_size > 10_000


def test_vtk(tmp_path):
    run("examples/python/write_vtk.py", tmp_path, "out")
    steps = xml.parse(tmp_path / "out/water.pvd").getroot().findall(".//DataSet")
    assert [float(s.get("timestep")) for s in steps] == pytest.approx([i / 25 for i in range(1, 9)])
    piece = xml.parse(tmp_path / "out" / steps[-1].get("file")).getroot().find(".//Piece")
    n = int(piece.get("NumberOfPoints"))
    numbers = {a.get("Name"): [float(x) for x in a.text.split()] for a in piece.iter("DataArray")}
    assert n == 16 * 16 * 8 and len(numbers["position"]) == len(numbers["velocity"]) == 3 * n
    assert len(numbers["J"]) == len(numbers["connectivity"]) == len(numbers["types"]) == n
    assert 0 <= min(numbers["position"]) and max(numbers["position"]) <= 0.6 and max(numbers["velocity"]) > 0.5

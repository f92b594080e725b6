import re
import subprocess

import numpy as np
import pytest

import dreampm as dm
from conftest import COMMAND, SOURCE


def test_make_goes_the_whole_way_and_knows_what_is_done(tmp_path, caplog):
    scene = dict(variant="tiny", set={"time.frames": 2, "render.size": [64, 48], "render.samples": 4},
                 out=str(tmp_path / "film"))
    with caplog.at_level("INFO", "dreampm"):
        film = dm.make(SOURCE / "scenes/dam-break.yaml", **scene)
    assert film == tmp_path / "film/dam-break.mp4" and film.stat().st_size > 500
    assert any("frame" in record.message for record in caplog.records)
    when = film.stat().st_mtime_ns
    assert dm.make(SOURCE / "scenes/dam-break.yaml", **scene).stat().st_mtime_ns == when


def test_make_refuses_as_the_command_does(tmp_path, monkeypatch):
    with pytest.raises(dm.InputError, match="no-such.yaml"):
        dm.make(tmp_path / "no-such.yaml")
    monkeypatch.setenv("DREAMPM_CUDA", "/nowhere.so")
    with pytest.raises(dm.InputError, match="no CUDA"):
        dm.make(SOURCE / "scenes/dam-break.yaml", variant="tiny", out=str(tmp_path / "film"), backend="cuda")
    assert not (tmp_path / "film").exists()


def test_validate(tmp_path):
    [case] = dm.validate("still-column", out=tmp_path)
    assert case["name"] == "still-column" and isinstance(case["pass"], bool) and case["metrics"]
    assert list(tmp_path.glob("still-column*.svg"))
    with pytest.raises(dm.InputError, match="still-column"):
        dm.validate("still-colum")
    with pytest.raises(dm.InputError, match="computes in double"):
        dm.validate("still-column", backend="reference")
    with pytest.raises(TypeError):
        dm.validate()


def test_the_page_says_where_a_body_is(tmp_path, monkeypatch):
    """By its pose in run.json, as the page computes it: where the probe of its center says."""
    monkeypatch.chdir(tmp_path)
    scene = dm.Scene(name="pond", space={"max": [1, 1, 0.4], "spacing": 0.05}, time={"fps": 24, "frames": 7},
                     materials={"water": {"type": "newtonian"}},
                     bodies={"w": {"material": "water", "shape": {"box": {"min": [0, 0, 0], "max": [1, 0.1, 0.4]}}}},
                     rigid={"crate": {"shape": {"box": {"size": [0.16, 0.12, 0.14]}}, "density": 400,
                                      "position": [0.5, 0.75, 0.2], "spin": [1, 2, 6], "velocity": [0.5, 0, 0]}},
                     probes={"at": {"type": "pose", "on": "crate"}})
    (tmp_path / "pond.yaml").write_text(scene.yaml())
    subprocess.run([COMMAND, "run", "pond.yaml"], check=True, capture_output=True)
    page = (SOURCE / "docs/reference/run-folder.md").read_text()
    [code] = re.findall(r"^```python\n(.*?)^```", page, re.MULTILINE | re.DOTALL)
    found = {}
    exec(code, found)
    row = np.genfromtxt("out/pond/probes/at.csv", delimiter=",", names=True)[-1]
    assert found["center"] == pytest.approx([row["x"], row["y"], row["z"]], abs=1e-9)
    assert row["y"] < 0.7 and abs(found["p"]["x"]) > 0.1

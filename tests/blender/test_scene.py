"""The scene that is written is one that the command takes, and says what was asked for."""
import json
import subprocess

import numpy
import pytest

from conftest import COMMAND, JELLY, WATER, box_file, small_setup
from core import command, yaml_text
from core.errors import DreampmError
from core.setup import (Body, Emitter, Material, Names, Sink, boxes_meet, edges_are_paired, scene_of, write_scene)


def check(file):
    return subprocess.run([COMMAND, "check", file, "--json"], capture_output=True, text=True)


def test_a_scene_with_everything(tmp_path):
    setup = small_setup(tmp_path)
    setup.scale, setup.spacing = 1.0, 0.02
    setup.emitters = [Emitter("tap", Material("newtonian", "honey", (("viscosity", 3.5), ("tension", "true"))),
                              box_file(tmp_path, "tap", (0.3, 0.05, 0.2), (0.36, 0.1, 0.24)), (0, 0, -1), start=0.05,
                              stop=0.2, pool=500)]
    still = (0.0, (0, 0, 0), (0, 1, 0), 0.0)
    setup.emitters[0].keys, setup.emitters[0].about = [still, (0.2, (0.01, 0, 0), (0, 1, 0), 20.0)], (0.33, 0.22, -0.07)
    setup.sinks = [Sink("drain", box_file(tmp_path, "drain", (0.36, 0, 0.04), (0.4, 0.2, 0.06)))]
    setup.sinks[0].keys = [still, (0.2, (0, 0.05, 0), (0, 1, 0), 0.0)]
    setup.bodies[1].velocity = (0, 0.5, -1)
    names = write_scene(tmp_path / "scene.yaml", setup)
    assert names == {WATER: "water", JELLY: "jelly", setup.emitters[0].material: "honey"}
    done = check(tmp_path / "scene.yaml")
    assert done.returncode == 0, done.stderr
    said = json.loads(done.stdout)
    # Water 10 x 10 x 5 and jelly 4 x 4 x 4 spacings: jitter and edges of meshes leave a few off.
    assert said["particles"] == pytest.approx(500 + 64, rel=0.05)
    text = (tmp_path / "scene.yaml").read_text()
    assert "gravity: [0.0, -9.81, 0.0]" in text and "velocity: [0.0, -1.0, -0.5]" in text
    assert "viscosity: 3.5, tension: true" in text and "min: [0.0, 0.0, -0.2]" in text


def test_units_of_centimeters(tmp_path):
    setup = small_setup(tmp_path)
    setup.low, setup.high, setup.spacing, setup.scale = (0, 0, 0), (40, 20, 30), 2, 0.01
    space = scene_of(setup)[0]["space"]
    assert numpy.allclose(space["max"], [0.4, 0.3, 0]) and space["spacing"] == pytest.approx(0.02)


def test_what_cannot_be_a_scene(tmp_path):
    setup = small_setup(tmp_path)
    setup.high = (0.4, 0.2, 0)
    with pytest.raises(DreampmError, match="no volume"):
        write_scene(tmp_path / "scene.yaml", setup)
    setup = small_setup(tmp_path)
    setup.bodies = []
    with pytest.raises(DreampmError, match="nothing to simulate"):
        write_scene(tmp_path / "scene.yaml", setup)
    assert not (tmp_path / "scene.yaml").exists()


def test_the_command_says_what_is_wrong(tmp_path):
    setup = small_setup(tmp_path)
    setup.bodies[0].material = Material("newtonian", "water", (("viscosity", -1),))
    write_scene(tmp_path / "scene.yaml", setup)
    with pytest.raises(DreampmError, match=r"scene.yaml:\d+:\d+: error: .*viscosity"):
        command.estimate(COMMAND, str(tmp_path / "scene.yaml"))


def test_a_collider_is_cut_out(tmp_path):
    """A body that reaches into a collider is refused, and taken where the collider is cut out of it."""
    setup = small_setup(tmp_path)
    setup.rigid, setup.bodies = [], [Body("pool", WATER, box_file(tmp_path, "pool", (0, 0, 0), (0.4, 0.2, 0.1)))]
    write_scene(tmp_path / "scene.yaml", setup)
    assert check(tmp_path / "scene.yaml").returncode == 2
    setup.bodies[0].cut = (setup.colliders[0].name,)
    write_scene(tmp_path / "scene.yaml", setup)
    done = check(tmp_path / "scene.yaml")
    assert done.returncode == 0, done.stderr
    # 20 x 10 x 5 spacings without the 8 x 10 x 2 of the plate
    assert json.loads(done.stdout)["particles"] == pytest.approx(1000 - 160, rel=0.05)


def test_names():
    names = Names()
    given = [names.give(n) for n in ("Cube", "Cube.001", "cube", "Böse Kugel", "...", "", "x" * 99)]
    assert given == ["Cube", "Cube_001", "cube-2", "B_se_Kugel", "object", "object-2", "x" * 56]


def test_numbers_of_blender_read_as_typed():
    dump = yaml_text.dump({"a": float(numpy.float32(0.1)), "b": 1e-5, "c": True, "d": "true", "e": 1 / 3, "f": -0.0,
                           "g": 3, "h": "plain", "i": "two words", "j": 1e20})
    assert dump.split("\n") == ["a: 0.1", "b: 1.0e-05", "c: true", 'd: "true"', "e: 0.333333333333", "f: 0.0", "g: 3",
                                "h: plain", 'i: "two words"', "j: 1.0e+20", ""]
    with pytest.raises(ValueError):
        yaml_text.dump({"a": float("nan")})


def test_closed_and_open_meshes():
    from conftest import SIDES
    assert edges_are_paired(SIDES) and not edges_are_paired(SIDES[:-1]) and not edges_are_paired([])
    assert boxes_meet(((0, 0, 0), (1, 1, 1)), ((0.9, 0, 0), (2, 1, 1)))
    assert not boxes_meet(((0, 0, 0), (1, 1, 1)), ((1, 0, 0), (2, 1, 1)))


def test_the_command_and_its_materials(tmp_path, monkeypatch):
    assert command.find(COMMAND) == COMMAND
    with pytest.raises(DreampmError, match="preferences"):
        command.find(str(tmp_path / "dreampm"))
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.setattr(command, "in_package", lambda: None)
    with pytest.raises(DreampmError, match="not on PATH"):
        command.find()
    (tmp_path / "dreampm").write_text("#!/bin/sh\nexit 3\n")
    (tmp_path / "dreampm").chmod(0o755)
    assert command.find() == str(tmp_path / "dreampm")
    with pytest.raises(DreampmError, match="exit code 3"):
        command.choices(command.find())

    choices = command.known_choices(COMMAND)
    keys = [c.key for c in choices]
    assert keys[0].startswith("newtonian/") and {"newtonian/water", "snow/packed", "seed/"} <= set(keys)
    assert [c.liquid for c in choices] == sorted((c.liquid for c in choices), reverse=True)
    honey = next(c for c in choices if c.key == "newtonian/honey")
    assert honey.label == "Honey" and honey.parameter("viscosity").unit == "Pa s" and honey.values["viscosity"] == 8.55
    assert command.known_choices(COMMAND) is choices


@pytest.mark.parametrize("prints, why", [
    ("nothing to read", "printed no list of materials"), ('[{"name": "mud"}]', "printed no list of materials"),
    ('{"name": 3}', "printed no list of materials"), ("$(exit 4)", "exit code 4")])
def test_a_command_that_fails_is_started_once(tmp_path, prints, why):
    """Panels ask at every redraw; a bake asks again."""
    program, calls = tmp_path / "dreampm", tmp_path / "calls"
    program.write_text(f"#!/bin/sh\necho called >> '{calls}'\nsaid={prints if '$' in prints else repr(prints)}"
                       " || exit\necho \"$said\"\n")
    program.chmod(0o755)
    for again, started in ((False, 1), (False, 1), (True, 2), (False, 2)):
        with pytest.raises(DreampmError, match=why):
            command.known_choices(str(program), again)
        assert calls.read_text().count("called") == started


def test_words_for_times():
    assert [command.duration(s) for s in (0.2, 59.6, 61, 7260)] == ["0 s", "1 min 00 s", "1 min 01 s", "2 h 01 min"]

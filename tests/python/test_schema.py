"""The JSON Schema of `dreampm schema --json`, by a validator that is not ours."""
import copy
import functools
import json
import subprocess

import jsonschema
import pytest
from ruamel.yaml import YAML

import dreampm as dm
from conftest import COMMAND, SOURCE

FILES = sorted(p for p in (SOURCE / "scenes").rglob("*.yaml"))


@functools.cache
def schema():
    printed = subprocess.run([COMMAND, "schema", "--json"], check=True, capture_output=True, text=True).stdout
    return json.loads(printed)


@functools.cache
def validator():
    jsonschema.Draft202012Validator.check_schema(schema())
    return jsonschema.Draft202012Validator(schema())


def read(text):
    """YAML 1.2, as the parser of scenes and the language server of editors read it: 1e-3 is a number."""
    return YAML(typ="safe").load(text)


def errors(scene):
    return [f"{e.json_path}: {e.message}" for e in validator().iter_errors(scene)]


@pytest.mark.parametrize("path", FILES, ids=lambda p: str(p.relative_to(SOURCE / "scenes")))
def test_every_scene_passes(path):
    assert errors(read(path.read_text())) == []


@pytest.mark.parametrize("name", ["dam-break", "drifting-boxes", "flow-in-the-dragon", "jelly-in-honey", "mud-slide"])
def test_a_scene_with_all_its_defaults_passes(name):
    assert errors(read(dm.Scene.load(SOURCE / f"scenes/{name}.yaml").yaml())) == []


DROP = """
dreampm: 1
name: drop
space: {max: [1, 1, 1], spacing: 0.02}
materials:
  water: {type: newtonian, preset: water, viscosity: 1e-3}
bodies:
  drop: {material: water, shape: {sphere: {radius: 0.1}, center: [0.5, 0.5, 0.5]}}
colliders:
  ground: {shape: {union: [{box: {min: [0, 0, 0], max: [1, 0.1, 1]}}, {sphere: {radius: 0.1}, center: [0, 0, 0]}]}}
rigid:
  crate: {shape: {box: {size: [0.1, 0.1, 0.1]}}, density: 400, position: [0.5, 0.8, 0.5]}
probes:
  level: {type: height, at: [0.5, 0.5], rate: 50}
render: {looks: {water: {type: dielectric, ior: 1.3}}}
variants:
  fine: {space: {spacing: 0.01}, materials: {water: {viscosity: 0.1}}}
"""

# Each changes one thing of DROP: where, and what is put there (None: taken away).
WRONG = [
    (["tmie"], {"frames": 3}), (["space", "spcing"], 0.01), (["space", "spacing"], None), (["space", "spacing"], 0),
    (["space", "spacing"], "2 cm"), (["space", "max"], [1, 1]), (["name"], "a drop"), (["bodies"], None),
    (["time"], {"frames": 3, "seconds": 1}), (["time"], {"frames": 2.5}), (["dreampm"], 2),
    (["materials", "water", "viscosty"], 1), (["materials", "water", "type"], "water"),
    (["materials", "water", "youngs_modulus"], 1e5), (["materials", "water", "preset"], "dry"),
    (["materials", "water", "bulk_modulus"], 1e5),  # and max_compression: below
    (["bodies", "drop", "shape", "box"], {"size": [1, 1, 1]}), (["bodies", "drop", "shape", "sphere"], None),
    (["bodies", "a drop"], {}), (["colliders", "ground", "shape", "union", 0, "bx"], 1),
    (["colliders", "ground", "shape", "union", 1, "sphere", "radius"], -1), (["rigid", "crate", "mass"], 1),
    (["rigid", "crate", "density"], None), (["probes", "level", "at"], [0, 0, 0]), (["probes", "level", "radius"], 1),
    (["render", "looks", "water", "ior"], 9), (["render", "camera"], {"from": [0, 0, 0]}),
    (["variants", "fine", "space", "spcing"], 0.01), (["variants", "fine", "variants"], {}),
    (["variants", "fine", "materials", "water", "viscosty"], 1),
]


def changed(where, value):
    scene = copy.deepcopy(read(DROP))
    if where[-1] == "bulk_modulus":
        scene["materials"]["water"]["max_compression"] = 0.01
    place = scene
    for key in where[:-1]:
        place = place[key]
    if value is None:
        del place[where[-1]]
    else:
        place[where[-1]] = value
    return scene


# What YAML reads as a number or a flag is a text to the parser where it wants one.
@pytest.mark.parametrize("line, changed_line", [("name: drop", "name: 2026"), ("name: drop", "name: 1e3\nabout: true")])
def test_texts_that_look_like_other_things_pass(line, changed_line):
    text = DROP.replace(line, changed_line)
    assert text != DROP and errors(read(text)) == []
    assert dm.Scene(text).name == changed_line.split()[1]


def test_the_scene_that_is_changed_passes():
    assert errors(read(DROP)) == []
    assert dm.Scene(DROP).name == "drop"


@pytest.mark.parametrize("where, value", WRONG, ids=lambda x: ".".join(map(str, x)) if isinstance(x, list) else str(x))
def test_what_the_parser_refuses_is_refused(where, value):
    scene = changed(where, value)
    assert errors(scene), scene
    with pytest.raises(dm.InputError):
        dm.Scene(scene)

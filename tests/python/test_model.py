"""A scene of structs is the scene of its file, and what is wrong has a name."""
import copy

import numpy as np
import pytest

import dreampm as dm
from dreampm import model


def tank_of_structs():
    scene = model.Scene(name="tank", space=model.Space(max=(0.4, 0.4, 0.2), spacing=0.02))
    scene.time.fps, scene.time.frames = 50, 11
    scene.materials = [model.Material("water", "newtonian", dm.preset("newtonian", "water")),
                       model.Material("jelly", "neo_hookean", {"youngs_modulus": 2e4, "poissons_ratio": 0.4})]
    scene.bodies.append(model.Body("pool", "water", dm.box((0, 0, 0), (0.2, 0.2, 0.2))))
    scene.bodies.append(model.Body("cube", "jelly", dm.box((0.28, 0.04, 0.04), (0.36, 0.12, 0.12)), color=(1, 0, 0)))
    scene.colliders = [model.Collider("gate", dm.box((0.22, 0, 0), (0.24, 0.3, 0.2)))]
    return scene


def test_a_scene_of_structs_has_the_bits_of_its_file(tank):
    scene = tank_of_structs()
    scene.name = tank.name
    built = dm.Scene(scene)
    assert built.yaml() == tank.yaml()
    a, b = dm.Simulation(built, threads=1), dm.Simulation(tank, threads=1)
    a.advance_to(0.02), b.advance_to(0.02)
    assert a.hash() == b.hash()


def test_a_file_as_structs_may_be_changed_and_checked_again(dam):
    scene = dam.model
    scene.space.spacing *= 2
    scene.materials[0].values["viscosity"] = 3
    scene.render.looks["water"].absorption = (1, 2, 3)
    changed = dm.Scene(scene)
    assert changed.spacing == 2 * dam.spacing and dam.model.space.spacing == dam.spacing
    assert changed.model.materials[0].values["viscosity"] == 3
    assert changed.model.render.looks["water"].absorption == (1, 2, 3)


def test_members_are_shared_as_any_objects_and_copies_are_not():
    scene = tank_of_structs()
    scene.bodies[0].velocity = np.array([1, 0, 0])
    assert scene.bodies[0].velocity == (1, 0, 0) and len(scene.bodies) == 2
    other = copy.deepcopy(scene)
    other.bodies[0].material = "jelly"
    del other.bodies[1]
    assert scene.bodies[0].material == "water" and len(scene.bodies) == 2
    assert repr(model.Space(spacing=0.5)) == "Space(spacing=0.5)"
    assert "radius: 0.5" in repr(dm.box((0, 0, 0), (1, 1, 1)) - dm.sphere((0, 0, 0), 0.5))
    assert "distance between particles" in model.Space.spacing.__doc__
    first = scene.bodies[0]
    for n in range(100):
        scene.bodies.append(model.Body(f"more-{n}", "water", dm.sphere((0, 0, 0), 1)))
    first.cut.append("gate")
    assert scene.bodies[0].cut == ["gate"] and first is scene.bodies[0]
    motion = model.Motion(velocity=(1, 0, 0))
    gate, same = (model.Collider(name, motion=motion) for name in ("a", "b"))
    motion.keys.append(model.PoseKey(1, (0, 1, 0)))
    gate.motion = None
    assert len(same.motion.keys) == 1 and gate.motion is None


@pytest.mark.parametrize("wrong, error, why", [
    (lambda s: model.Body("b", velocty=1), TypeError, "has no member 'velocty'; it has name, material"),
    (lambda s: model.Body("b", name="c"), TypeError, "Body.name is given twice"),
    (lambda s: model.Body("b", pattern="jiter"), dm.InputError, "Body.pattern is 'jiter': must be one of 'jitter'"),
    (lambda s: setattr(s.space, "spacing", "fine"), TypeError, "Space.spacing: 'fine': must be of type float"),
    (lambda s: setattr(s.space, "max", (1, 2)), TypeError, r"Space.max: \(1, 2\) is no vector"),
    (lambda s: setattr(s, "bodies", 3), TypeError, "Scene.bodies: 3: must be a list of Body"),
    (lambda s: setattr(s.bodies[0], "cut", "gate"), TypeError, "a list of names"),
    (lambda s: (s.bodies.append(3), dm.Scene(s)), TypeError, r"Scene.bodies\[2\]: 3: must be of type Body"),
    (lambda s: setattr(s.bodies[0], "hue", (1, 0, 0)), AttributeError, "hue"),
    (lambda s: model.Material(values={"viscosity": "high"}), TypeError, r"values\['viscosity'\]: must be a number"),
    (lambda s: model.Probe("p", form=3), TypeError, "must be a HeightProbe"),
    (lambda s: dm.preset("newtonian", "hony"), dm.InputError, "did you mean 'honey'"),
    (lambda s: dm.Scene(model.Scene()), dm.InputError, "missing key 'materials'"),
    (lambda s: dm.Scene(s, variant="preview"), TypeError, "change the model"),
])
def test_what_is_wrong_is_named(wrong, error, why):
    with pytest.raises(error, match=why):
        wrong(tank_of_structs())


def test_check_lists_all_by_path():
    scene = tank_of_structs()
    scene.bodies[1].material = "jely"
    scene.colliders[0].friction = -1
    assert dm.check(scene) == ["bodies.cube.material: no material 'jely'; did you mean 'jelly'?",
                               "colliders.gate.friction is -1: must be between 0 and 100"]

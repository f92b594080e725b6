import numpy as np
import pytest

import dreampm as dm
from dreampm.model import Body, Collider, Look, Material, Rigid


def crate(place):
    """A cube of 4 cm of wood."""
    half = np.full(3, 0.02)
    return Collider("crate", dm.box(place - half, place + half), friction=0.4, rigid=Rigid(density=400))


def test_parameters_by_name(tank):
    sim = dm.Simulation(tank)
    water = sim.materials["water"]
    assert list(sim.materials) == ["water", "jelly"] and "water" in sim.materials and len(sim.materials) == 2
    assert water.viscosity == pytest.approx(1.0016e-3) and water.tension is False and water.bulk_modulus is None
    assert {"viscosity", "density", "gamma"} < set(dir(water))
    assert water.parameters()["viscosity"]["unit"] == "Pa s"
    before = sim.hash()
    water.viscosity = 8.5
    assert water.viscosity == 8.5 and sim.scene.yaml() != tank.yaml() and sim.hash() != before
    water.tension, water.gamma = True, "linear"
    assert water.tension is True and water.gamma == "linear"
    with pytest.raises(dm.InputError, match="'round' is no number; words: linear"):
        water.gamma = "round"
    with pytest.raises(dm.InputError, match="viscosity.*0"):
        water.viscosity = -1
    with pytest.raises(dm.InputError, match="did you mean 'viscosity'"):
        water.viscosty = 1
    with pytest.raises(AttributeError, match="it has density, viscosity"):
        water.viscosty
    with pytest.raises(dm.InputError, match="it has water, jelly"):
        sim.materials["watr"]


def test_honey_flows_slower_than_water(tank):
    fronts = []
    for viscosity in (1e-3, 50):
        sim = dm.Simulation(tank)
        sim.remove(dm.box((0.25, 0, 0), (0.4, 0.4, 0.2)))
        sim.materials["water"].viscosity = viscosity
        sim.colliders["gate"].motion = dm.Twist(velocity=(0, 5, 0))
        sim.advance_to(0.15)
        fronts.append(sim.particles["water"].position[:, 0].max())
    assert fronts[0] > fronts[1] + 0.05


def test_gravity_and_walls(tank):
    sim = dm.Simulation(tank)
    sim.gravity = np.array([0, 9.81, 0])
    assert sim.gravity == (0, 9.81, 0)
    sim.walls["y_max"] = "open"
    sim.walls["x_min"] = ("separate", 0.3)
    assert sim.walls["y_max"].type == "open" and sim.walls["x_min"].friction == 0.3
    sim.advance_to(0.4)
    assert sim.totals.left > 0
    with pytest.raises(dm.InputError, match="type"):
        sim.walls["x_min"] = "wet"
    with pytest.raises(dm.InputError, match="x_min, x_max"):
        sim.walls["floor"] = "slip"
    with pytest.raises(TypeError, match="a wall is a type"):
        sim.walls["x_min"] = 3


def test_colliders_move(tank):
    sim = dm.Simulation(tank)
    gate = sim.colliders["gate"]
    assert list(sim.colliders) == ["gate"] and gate.pose.position == (0, 0, 0) and gate.pose.rotation == (1, 0, 0, 0)
    gate.motion = dm.Twist(velocity=(0, 1, 0))
    assert gate.motion == dm.Twist(velocity=(0, 1, 0))
    sim.advance_to(0.1)
    assert gate.pose.position == pytest.approx((0, sim.time, 0))
    assert gate.pose((1, 0, 0)) == pytest.approx((1, sim.time, 0))
    gate.motion = dm.Twist()
    at = gate.pose.position
    sim.step()
    assert gate.pose.position == at


def test_matter_comes_and_goes(tank):
    sim = dm.Simulation(tank)
    count = sim.particle_count
    sim.add(Body("ball", "jelly", dm.sphere((0.32, 0.3, 0.1), 0.05), velocity=(0, -1, 0), color=(0, 0, 1)))
    jelly = sim.particles["jelly"]
    assert np.allclose(jelly.velocity[-1], (0, -1, 0)) and np.allclose(jelly.color[-1], (0, 0, 1))
    assert np.allclose(jelly.color[0], (1, 0, 0))
    added = sim.particle_count - count
    assert added > 10 and sim.totals.entered == added
    sim.add(Body("plate", "jelly", {"box": {"min": [0.3, 0.36, 0.02], "max": [0.34, 0.38, 0.06]}}))
    places = np.array([[0.3, 0.2, 0.02], [0.34, 0.2, 0.02]], dtype=np.float32)
    sim.add_particles("water", places, velocity=(1, 0, 0))
    assert np.allclose(sim.particles["water"].position[-2:], places)
    before = sim.particle_count
    taken = sim.remove(dm.box((0, 0, 0), (0.1, 0.4, 0.2)))
    assert taken > 0 and sim.particle_count == before - taken == sim.totals.particles
    with pytest.raises(dm.InputError, match="outside of the walls"):
        sim.add_particles("water", np.array([[2.0, 0, 0]]))
    with pytest.raises(dm.InputError, match="name ball"):
        sim.add(Body("ball", "jelly", dm.sphere((0.1, 0.3, 0.1), 0.05)))
    sim.add_particles("water", [(0.3, 0.24, 0.02), [0.34, 0.24, 0.02]])
    assert np.allclose(sim.particles["water"].position[-2:], [(0.3, 0.24, 0.02), (0.34, 0.24, 0.02)])
    sim.add_particles("water", [])
    with pytest.raises(TypeError, match=r"positions: shape \(2, 2\): points are of shape \(n, 3\)"):
        sim.add_particles("water", np.zeros((2, 2)))
    with pytest.raises(TypeError, match="positions: rows of other lengths than 3"):
        sim.add_particles("water", [(1, 2), (1, 2, 3)])
    sim.advance_to(0.02)


@pytest.mark.parametrize("wrong, why", [
    (lambda sim: setattr(sim, "gravity", (0, -9.81)), r"gravity: \(0, -9.81\) is no vector, which is three numbers"),
    (lambda sim: setattr(sim, "gravity", 9.81), "gravity: 9.81 is no vector"),
    (lambda sim: setattr(sim, "gravity", "down"), "gravity: 'down' is no vector"),
    (lambda sim: Body("b", "jelly", dm.sphere((0.1, 0.3, 0.1), 0.05), velocity=(0, "fast", 0)), "velocity: .*'fast'"),
    (lambda sim: Body("b", "jelly", dm.sphere((0.1, 0.3, 0.1), 0.05), color=[1, 0, 0, 1]), "color: "),
    (lambda sim: sim.add_particles("water", np.zeros((1, 3)), velocity=np.zeros(2)), "velocity: array"),
    (lambda sim: dm.box((0, 0), (1, 1, 1)), "min: "),
    (lambda sim: dm.sphere(0, 1), "center: 0 is"),
    (lambda sim: dm.Twist(spin=[[1, 2, 3]]), "spin: "),
    (lambda sim: dm.Simulation("a.yaml"), "Scene.load"),
])
def test_what_is_no_vector_is_named(tank, wrong, why):
    with pytest.raises(TypeError, match=why):
        wrong(dm.Simulation(tank))


def test_vectors_are_lists_tuples_and_arrays_of_any_numbers(tank):
    sim = dm.Simulation(tank)
    for down in ((0, -1, 0), [0, -1.0, 0], np.array([0, -1, 0]), np.float32([0, -1, 0])):
        sim.gravity = down
        assert sim.gravity == (0, -1, 0)


def test_a_material_more_and_one_without_particles(tank):
    sim = dm.Simulation(tank)
    sim.add_material(Material("honey", "newtonian", dm.preset("newtonian", "honey")),
                     look=Look(type="opaque", color=(1, 0.7, 0)))
    assert list(sim.particles) == ["water", "jelly", "honey"] and sim.materials["honey"].density == 1418
    assert sim.particles["honey"].position.shape == (0, 3) and sim.particles["honey"].id.shape == (0,)
    sim.add(Body("blob", "honey", dm.cylinder((0.1, 0.3, 0.1), 0.05, 0.1)))
    assert len(sim.particles["honey"]) > 10
    sim.materials["jelly"].reset_state()
    sim.step()


def test_a_brush_takes_matter_along(tank):
    moved = []
    for stroke in (False, True):
        sim = dm.Simulation(tank)
        if stroke:
            sim.set_brush("hand", dm.VelocityBrush(point=(0.1, 0.1, 0.1), radius=0.08, velocity=(0, 2, 0)))
        sim.advance_to(0.05)
        sim.remove_brush("hand")
        moved.append(sim.particles["water"].velocity[:, 1].max())
        sim.advance_to(0.06)
    assert moved[1] > moved[0] + 0.5


def test_surfaces_and_pictures(tank, tmp_path):
    sim = dm.Simulation(tank.with_({"render.size": [64, 48], "render.samples": 4}))
    mesh = sim.surface("water", overlap=0)
    assert mesh.vertices.dtype == np.float32 and mesh.vertices.shape[1] == 3
    assert mesh.faces.dtype == np.uint32 and mesh.faces.shape[1] == 3 and mesh.faces.max() < len(mesh.vertices)
    a, b, c = (mesh.vertices[mesh.faces[:, i]].astype(np.float64) for i in range(3))
    volume = np.einsum("ij,ij->", a, np.cross(b, c)) / 6
    assert volume == pytest.approx(0.2**3, rel=0.15)  # of coarse matter, by the divergence theorem
    vertices = mesh.vertices
    del mesh
    assert np.isfinite(vertices).all()
    with pytest.raises(dm.InputError, match="several materials"):
        sim.surface()
    image = dm.render(sim)
    assert image.shape == (48, 64, 3) and image.dtype == np.uint8 and image.std() > 5
    assert dm.render(sim, width=32, height=16).shape == (16, 32, 3)
    assert dm.render(sim.scene, width=32, height=16).shape == (16, 32, 3)
    dm.write_png(tmp_path / "now.png", image)
    assert (tmp_path / "now.png").read_bytes().startswith(b"\x89PNG")
    for wrong in (image / 255, image[..., :2], image[0], image.astype(int)):
        with pytest.raises(TypeError, match="uint8 of shape"):
            dm.write_png(tmp_path / "wrong.png", wrong)
    assert not (tmp_path / "wrong.png").exists()
    with pytest.raises(dm.InputError, match="samples"):
        dm.render(sim, samples=1)


def test_bodies_and_colliders_come_and_go(tank):
    sim = dm.Simulation(tank)
    sim.add(crate((0.1, 0.3, 0.1)))
    assert sim.colliders["crate"].mass == pytest.approx(400 * 0.04**3)
    high = sim.colliders["crate"].pose.position[1]
    sim.advance_to(0.05)
    assert sim.colliders["crate"].pose.position[1] < high - 0.005, "it falls"
    with pytest.raises(dm.InputError, match="crate"):
        sim.add(crate((0.1, 0.35, 0.1)))
    sim.remove_collider("crate")
    with pytest.raises(dm.InputError, match="crate"):
        sim.colliders["crate"]
    sim.add(Collider("post", dm.box((0.3, 0.3, 0.05), (0.35, 0.4, 0.15)), type="slip"))
    assert "post" in sim.colliders and sim.colliders["post"].mass == 0
    sim.remove_collider("post")
    assert "post" not in sim.colliders


def test_a_held_body_does_not_fall(tank):
    sim = dm.Simulation(tank)
    place = np.array([0.1, 0.3, 0.1])
    sim.add(crate(place))
    at = place - np.array(sim.colliders["crate"].pose.position)
    sim.attach("crate", at=at, to=place, stiffness=1e5, damping=100)
    there = np.array(sim.colliders["crate"].motion.center)
    sim.advance_to(0.1)
    assert np.allclose(sim.colliders["crate"].motion.center, there, atol=2e-3)
    sim.detach("crate")
    sim.advance_to(0.15)
    assert sim.colliders["crate"].motion.center[1] < there[1] - 0.005


def test_a_material_becomes_another(tank):
    sim = dm.Simulation(tank)
    count = len(sim.particles["water"])
    assert sim.convert("water", "jelly") == count and len(sim.particles["water"]) == 0

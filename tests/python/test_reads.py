"""What is set in a simulation is read back, and what there is has a name."""
import numpy as np
import pytest

import dreampm as dm
from dreampm.model import Collider, Rigid


def test_names(tank):
    sim = dm.Simulation(tank)
    names = sim.names
    assert names.materials == ["water", "jelly"] and names.bodies == ["pool", "cube"] and names.colliders == ["gate"]
    assert names.rigid == names.emitters == names.brushes == []
    sim.add(Collider("crate", dm.box((0.28, 0.2, 0.06), (0.36, 0.28, 0.14)), rigid=Rigid(density=1000)))
    sim.set_brush("hand", dm.VelocityBrush(point=(0.1, 0.1, 0.1), radius=0.05, velocity=(1, 0, 0), rate=50))
    assert sim.names.rigid == ["crate"] and "crate" in sim.names.colliders and sim.names.brushes == ["hand"]
    assert "names" in dir(sim) and "colliders=['gate'" in repr(sim.names)


def test_what_is_set_is_read_back_also_from_a_file(tank, tmp_path):
    sim = dm.Simulation(tank, threads=1)
    sim.gravity, sim.cfl = (1, -9, 0), 0.3
    sim.walls["x_max"] = ("separate", 0.3)
    sim.colliders["gate"].motion = dm.Twist(velocity=(0, 0.5, 0))
    sim.colliders["gate"].surface_tolerance = 0.1
    sim.materials["water"].viscosity = 2
    sim.step()
    sim.save(tmp_path / "kept.yaml")
    steps = []
    other = dm.Simulation(tank)
    other.on_step(lambda report: steps.append(report.step))
    other.load(tmp_path / "kept.yaml")
    assert other.hash() == sim.hash()
    for s in (sim, other):
        assert s.gravity == (1, -9, 0) and s.cfl == s.stepping.cfl == 0.3 and s.materials["water"].viscosity == 2
        assert s.walls["x_max"].friction == 0.3 and not s.walls["x_max"].skin_friction
        gate = s.colliders["gate"]
        assert gate.motion.velocity == (0, 0.5, 0) and gate.surface_tolerance == 0.1 and gate.type == "separate"
        assert gate.moves and not gate.is_rigid and not gate.deforms
    other.step()
    assert steps == [2]
    with pytest.raises(dm.InputError, match="none.yaml"):
        other.load(tmp_path / "none.yaml")
    other.on_step(lambda report: other.load(tmp_path / "kept.yaml"))
    with pytest.raises(dm.RunError):
        other.step()
    assert sim.threads == 1 and sim.backend == "cpu" and sim.isa and sim.stepping.solver == "explicit"


def test_grips_and_brushes(tank):
    sim = dm.Simulation(tank)
    sim.add(Collider("crate", dm.box((0.28, 0.2, 0.06), (0.36, 0.28, 0.14)), rigid=Rigid(density=1000)))
    assert sim.anchor("crate") is None and sim.brushes == {}
    sim.attach("crate", at=(0.3, 0.2, 0.1), to=(0.3, 0.3, 0.1), stiffness=50, damping=2)
    grip = sim.anchor("crate")
    assert grip.to == (0.3, 0.3, 0.1) and grip.stiffness == 50 and grip.damping == 2
    sim.detach()
    assert sim.anchor("crate") is None
    sim.set_brush("hand", dm.VelocityBrush(point=(0.1, 0.1, 0.1), radius=0.05, velocity=(1, 0, 0), rate=50))
    assert sim.brushes["hand"].radius == 0.05 and sim.brushes["hand"].velocity == (1, 0, 0)
    sim.remove_brush("hand")
    assert sim.brushes == {}


def test_attributes_of_particles(tank):
    sim = dm.Simulation(tank)
    sim.advance_to(0.1)
    jelly = sim.particles["jelly"]
    f = sim.attribute("jelly", "f")
    assert f.shape == (len(jelly), 3, 3) and f.dtype == np.float32 and not f.flags.writeable
    assert np.allclose(np.linalg.det(f), jelly.J, atol=1e-4)
    density = sim.attribute("jelly", "density")
    assert density.shape == (len(jelly),) and np.allclose(density * jelly.J, 1000, rtol=1e-5)
    assert np.array_equal(sim.attribute("water", "jp"), np.ones(sim.particle_count - len(jelly), np.float32))
    assert sim.attribute("water", "velocity_gradient").shape[1:] == (3, 3)
    assert "pressure" in sim.attributes("water")
    del sim
    assert np.isfinite(f).all()  # it is kept
    with pytest.raises(dm.InputError, match="did you mean 'pressure'"):
        dm.Simulation(tank).attribute("water", "presure")


def test_particles_come_with_velocities_and_gradients(tank):
    sim = dm.Simulation(tank)
    x = np.array([[0.3, 0.2, 0.1], [0.34, 0.2, 0.1]])
    v, c = np.array([[1, 0, 0], [0, 2, 0]]), np.arange(18.0).reshape(2, 3, 3)
    sim.add_particles("jelly", x, velocities=v, gradients=c)
    assert np.array_equal(sim.particles["jelly"].velocity[-2:], v)
    assert np.array_equal(sim.attribute("jelly", "velocity_gradient")[-2:], c)
    with pytest.raises(dm.InputError, match="2 positions, 1 velocities and 2 gradients"):
        sim.add_particles("jelly", x, velocities=v[:1])
    with pytest.raises(TypeError, match=r"gradients: shape \(2, 9\): matrices are of shape \(n, 3, 3\)"):
        sim.add_particles("jelly", x, gradients=np.zeros((2, 9)))


def test_states_and_counts(tank):
    sim = dm.Simulation(tank)
    jelly = sim.material("jelly")
    assert jelly.type == "neo_hookean" and not jelly.liquid and sim.material("water").liquid
    assert jelly.particle_mass == pytest.approx(1000 * 0.02 ** 3)
    other = sim.material("jelly", youngs_modulus=8e4)
    assert other.sound_speed == pytest.approx(2 * jelly.sound_speed) and sim.materials["jelly"].youngs_modulus == 2e4
    with pytest.raises(dm.InputError, match="did you mean 'youngs_modulus'"):
        sim.material("jelly", young_modulus=1)
    pool = sim.body("pool")
    assert pool.material == "water" and pool.count == len(sim.particles["water"]) and pool.color is None
    assert sim.body("cube").color == (1, 0, 0)
    taken = sim.remove(dm.box((0, 0, 0), (0.1, 0.4, 0.2)))
    assert sim.counts.removed == taken == sim.totals.removed and sim.counts.particles == sim.particle_count
    assert sim.next_id == sim.body("cube").first_id + sim.body("cube").count


def test_shapes_and_rays(tank):
    sim = dm.Simulation(tank)
    gate = sim.collider_shape("gate")
    assert gate.distance((0.26, 0.1, 0.1)) == pytest.approx(0.02) and gate.normal((0.26, 0.1, 0.1)) == (1, 0, 0)
    assert gate.bounds[0] == pytest.approx((0.22, 0, 0)) and gate.bounds[1] == pytest.approx((0.24, 0.3, 0.2))
    assert [s.name for s in sim.collider_shapes()] == ["gate"] and not gate.is_rigid
    assert sim.collider_mesh("gate").vertices[:, 1].max() == pytest.approx(0.3)
    hit = dm.cast_ray(sim, (0.39, 0.2, 0.1), (-1, 0, 0))
    assert hit.name == "gate" and hit.id is None and hit.distance == pytest.approx(0.15, abs=1e-3)
    water = dm.cast_ray(sim, sim.particles["water"].position[0] + np.array([0, 0.3, 0]), (0, -1, 0))
    assert water.name == "water" and water.id is not None
    assert dm.cast_ray(sim, (0.39, 0.35, 0.1), (-1, 0, 0)) is None
    [near] = dm.colliders_near(sim, (0.26, 0.1, 0.1), 0.03)
    assert near.name == "gate" and near.distance == pytest.approx(0.02)
    assert dm.contacts(sim, "gate", 0.01) == []
    [wet] = dm.contacts(sim, "gate", 0.04)
    assert wet.material == "water" and wet.particles > 50 and 0.17 < wet.middle[0] < 0.22
    with pytest.raises(TypeError, match="direction: 1 is no vector"):
        dm.cast_ray(sim, (0, 0, 0), 1)


def test_what_a_solver_refuses(tank):
    assert dm.refused_parts(tank) == []
    pinned = dm.Scene(
        space={"min": [0, 0, 0], "max": [0.4, 0.4, 0.2], "spacing": 0.02}, time={"solver": "projection"},
        materials={"water": {"type": "newtonian"}},
        bodies={"pool": {"material": "water", "shape": {"box": {"min": [0, 0, 0], "max": [0.4, 0.1, 0.2]}}}},
        pins={"held": {"shape": {"box": {"min": [0, 0, 0], "max": [0.1, 0.1, 0.1]}}}})
    [line] = dm.refused_parts(pinned)
    assert "pin held" in line


def test_a_moment_for_a_finer_scene(tank, tmp_path):
    sim = dm.Simulation(tank)
    sim.save_moment(tmp_path / "same.h5")
    finer = tank.with_({"space.spacing": 0.01})
    sim.save_moment(tmp_path / "finer.h5", finer=finer)
    assert (tmp_path / "finer.h5").stat().st_size > 4 * (tmp_path / "same.h5").stat().st_size
    with pytest.raises(dm.InputError, match="space.spacing 0.01 m"):
        sim.save_moment(tmp_path / "no.h5", finer=tank)

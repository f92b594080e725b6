"""Axes, files of meshes, and animation as the motion of a collider."""
import csv
import subprocess

import numpy
import pytest

from conftest import COMMAND, CORNERS, SIDES, box_file, small_setup
from core import axes, motion, ply, yaml_text
from core.errors import DreampmError
from core.run_folder import pose_matrix
from core.setup import Collider, scene_of


def turned(axis, degrees, place=(0, 0, 0)):
    """A matrix that turns about an axis through the origin, and then moves: Rodrigues' formula."""
    a, angle = numpy.array(axis, dtype=float) / numpy.linalg.norm(axis), numpy.radians(degrees)
    cross = numpy.array([[0, -a[2], a[1]], [a[2], 0, -a[0]], [-a[1], a[0], 0]])
    m = numpy.eye(4)
    m[:3, :3] += numpy.sin(angle) * cross + (1 - numpy.cos(angle)) * cross @ cross
    m[:3, 3] = place
    return m


def test_up_is_up_and_right_hands_stay_right():
    assert axes.to_scene((0, 0, -9.81)).tolist() == [0, -9.81, 0]
    x, y, z = (axes.to_scene(v) for v in numpy.eye(3))
    assert numpy.cross(x, y).tolist() == z.tolist()
    points = numpy.random.default_rng(1).normal(size=(50, 3))
    assert numpy.allclose(axes.to_blender(axes.to_scene(points, 0.01), 0.01), points)
    single = axes.to_blender(points.astype("f4"), 0.01)
    assert single.dtype == numpy.float32


def test_matrices_follow_their_points():
    m = turned((1, 2, 3), 40, (0.1, -0.2, 0.5))
    p = numpy.array([0.3, 0.7, -0.4])
    moved = axes.matrix_to_scene(m, 0.1) @ numpy.append(axes.to_scene(p, 0.1), 1)
    assert numpy.allclose(moved[:3], axes.to_scene(m[:3, :3] @ p + m[:3, 3], 0.1))
    assert numpy.allclose(axes.matrix_to_blender(axes.matrix_to_scene(m, 0.1), 0.1), m)


def test_the_command_reads_our_meshes(tmp_path):
    box_file(tmp_path, "box", (0, 0, 0), (1, 2, 3))
    file = tmp_path / "models/box.ply"
    said = subprocess.run([COMMAND, "info", file], capture_output=True, text=True, check=True).stdout
    facts = dict(line.split(maxsplit=1) for line in said.splitlines())
    assert (facts["count"], facts["triangles"], facts["open_edges"], facts["volume"]) == ("8", "12", "0", "6 m^3")
    back = ply.read(file)
    # Blender's width, depth and height are the scene's x, -z and y.
    assert back.places().min(axis=0).tolist() == [0, 0, -2] and back.places().max(axis=0).tolist() == [1, 3, 0]
    assert back.triangles.tolist() == [list(t) for t in SIDES] and back.velocities() is None


def test_files_that_are_no_meshes(tmp_path):
    file = tmp_path / "a.ply"
    for text, why in ((b"solid a\n", "no PLY"), (b"ply\nformat ascii 1.0\nend_header\n", "binary"),
                      (b"ply\nformat binary_little_endian 1.0\nelement vertex 9\nproperty float x\nend_header\n123",
                       "cut off"), (b"ply\nformat binary", "within its header")):
        file.write_bytes(text)
        with pytest.raises(DreampmError, match=why):
            ply.read(file)
    with pytest.raises(DreampmError, match="No such file"):
        ply.read(tmp_path / "b.ply")


def test_places_far_away_keep_their_digits(tmp_path):
    file = tmp_path / "far.ply"
    file.write_bytes(b"ply\nformat binary_little_endian 1.0\ncomment shift 500000 0 0\nelement vertex 1\n"
                     b"property float x\nproperty float y\nproperty float z\nend_header\n"
                     + numpy.array([0.25, 0, 0], dtype="<f4").tobytes())
    assert ply.read(file).places().tolist() == [[500000.25, 0, 0]]


def place_at(keys, about, t, point):
    """Where a motion takes a point at the time of a key, as scene files define it."""
    _, position, axis, angle = next(k for k in keys if abs(k[0] - t) < 1e-12)
    return about + position + turned(axis, angle)[:3, :3] @ (point - about)


def test_an_animation_becomes_keys_that_say_the_same():
    first = turned((0, 1, 1), 25, (0.2, 0.3, 0.1))
    times = [i / 24 for i in range(60)]
    matrices = [turned((1, 0.2, 0), 31 * i, (0.02 * i, 0.1, 0)) @ first for i in range(60)]
    keys, about = motion.rigid_keys(times, matrices)
    p = numpy.array([0.5, -0.3, 0.2, 1])
    local = numpy.linalg.inv(matrices[0]) @ p
    for t, m in zip(times, matrices):
        assert numpy.allclose(place_at(keys, about, t, p[:3]), (m @ local)[:3], atol=1e-9)
    # It turns on over several turns, never back.
    steps = numpy.diff([angle for _, _, _, angle in keys])
    assert numpy.allclose(numpy.abs(steps), 31) and abs(steps.sum()) > 5 * 360


def test_sides_are_named_as_blender_has_them():
    said = "body W reaches 2.947 m outside the wall z_min; body F lies wholly beyond the open side y_max, where"
    assert axes.sides_in_blender(said) == ("body W reaches 2.947 m outside the side +Y of the domain; body F lies wholly "
                                           "beyond the open side +Z of the domain, where")
    for side, name in axes.SIDES.items():  # what lies beyond a side of the scene lies beyond that of Blender
        place = [0, 0, 0]
        place["xyz".index(side[0])] = 1 if side.endswith("max") else -1
        there = axes.to_blender(numpy.array(place, dtype=float))
        assert there["XYZ".index(name[1])] == (1 if name[0] == "+" else -1)


def test_what_stands_and_what_is_scaled():
    assert motion.is_still([turned((0, 0, 1), 10)] * 3)
    assert not motion.is_still([turned((0, 0, 1), 10), turned((0, 0, 1), 10.01)])
    grown = turned((0, 0, 1), 0)
    grown[:3, :3] *= 1.01
    with pytest.raises(motion.NotRigid):
        motion.rigid_keys([0, 1], [numpy.eye(4), grown])
    # Idle stretches take no keys of their own.
    waits = [numpy.eye(4)] * 20 + [turned((0, 0, 1), 5)]
    assert [t for t, *_ in motion.rigid_keys(range(21), waits)[0]] == [0, 19, 20]


def test_the_command_moves_a_collider_as_blender_does(tmp_path):
    """A door of Blender turns about its hinge, and the probe `pose` of the command says where it is."""
    setup = small_setup(tmp_path, frames=7)
    low, high = numpy.array([0.3, 0.02, 0.05]), numpy.array([0.32, 0.18, 0.25])
    door = box_file(tmp_path, "door", low, high)
    hinge = numpy.array([0.3, 0.02, 0])
    matrices = [turned((0, 0, 1), -4 * i, hinge + [0, 0, 0.002 * i]) for i in range(7)]  # Blender's world, its origin
    keys, about = motion.rigid_keys([i / 24 for i in range(7)], [axes.matrix_to_scene(m) for m in matrices])
    setup.colliders = [Collider("door", [door], keys=keys, about=about)]
    setup.bodies, setup.rigid = setup.bodies[:1], []
    tree, _ = scene_of(setup)
    tree["probes"] = {"where": {"type": "pose", "on": "door"}}
    (tmp_path / "scene.yaml").write_text(yaml_text.dump(tree))
    subprocess.run([COMMAND, "run", tmp_path / "scene.yaml", "--out", tmp_path / "run"], check=True,
                   capture_output=True)
    with open(tmp_path / "run/probes/where.csv", encoding="utf-8") as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    corner = low + CORNERS[7] * (high - low)
    expected = matrices[6] @ numpy.linalg.inv(matrices[0]) @ numpy.append(corner, 1)
    # The probe has the place of the point that it turns about, and the rotation.
    pose = axes.matrix_to_blender(pose_matrix({key: float(v) for key, v in rows[-1].items() if v}))
    there = pose[:3, 3] + pose[:3, :3] @ (corner - axes.to_blender(about))
    assert numpy.allclose(there, expected[:3], atol=1e-6)

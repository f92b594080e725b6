"""Bakes by the command itself: progress, cancel, resume, errors, and what lies in the folder then."""
import json
import os
import time

import numpy
import pytest

from conftest import COMMAND, JELLY, WATER, finish, small_setup
from core import job, ply
from core.errors import DreampmError
from core.progress import Progress
from core.run_folder import Frame, RunFolder
from core.setup import Material, write_scene


def test_progress_reads_lines_and_counts_files():
    now, files = [0.0], set()
    p = Progress(lambda stage, frame: f"{stage}{frame}", clock=lambda: now[0])
    exists, os.path.exists = os.path.exists, lambda path: path in files
    try:
        p.read("scene.yaml: warning: thin\n")
        p.read("simulate: frame 4/24, 0 s left")
        assert (p.stage, p.done, p.total, p.factor) == ("simulate", 4, 24, 4 / 24)
        assert p.seconds_left() is None  # what a resumed run found is no pace
        files.update(("simulate5", "simulate6", "simulate8"))
        now[0] = 3
        p.count_files()
        assert p.done == 6 and p.seconds_left() == pytest.approx(3 / 2 * 18)
        p.read("simulate: frame 24/24, 9 s")
        p.read("surface: frame 0/24")
        assert (p.stage, p.done) == ("surface", 0) and p.seconds_left() is None
        p.read("/a/scene.yaml:3:7: error: unknown key 'spacin'")
        assert p.warnings == ["scene.yaml: warning: thin"] and len(p.errors) == 1
    finally:
        os.path.exists = exists


def test_a_bake_leaves_frames(baked):
    folder, materials, done = baked
    run = RunFolder(str(folder / "run"))
    assert materials == {WATER: "water", JELLY: "jelly"} and set(run.materials()) == {"water", "jelly"}
    assert run.last_frame() == 6 and run.can_resume()
    assert run.is_whole(6, ["water", "jelly"]) and not run.is_whole(7, ["water", "jelly"])
    assert (done.progress.stage, done.progress.done, done.progress.total) == ("surface", 6, 6)
    water = run.files("water", 1).read(particles=False)
    # Blender's axes: the pool lies on z = 0 and is 0.1 high; nothing has moved yet. Its surface reaches half a
    # spacing, 0.01, into the walls.
    assert numpy.allclose(water.points.min(axis=0), -0.01, atol=0.001)
    assert numpy.allclose(water.points.max(axis=0), (0.21, 0.21, 0.1), atol=0.012)
    assert water.velocity.shape == water.points.shape and not water.velocity.any()
    assert water.triangles.max() < len(water.points) and water.normals.shape == water.points.shape
    # Ten spacings wide and five deep: a surface half a spacing off makes 17 %.
    assert outward_volume(water) == pytest.approx(0.22 * 0.22 * 0.11, rel=0.15)
    # The jelly falls freely at first: by g t downward, in units a second.
    jelly = run.files("jelly", 3).read(particles=False, scale=0.01)
    assert jelly.velocity[:, 2].mean() == pytest.approx(-9.81 * 2 / 24 / 0.01, rel=0.05)
    start = run.files("jelly", 1).read(particles=False, scale=0.01)
    fallen = start.points[:, 2].max() - jelly.points[:, 2].max()
    assert fallen == pytest.approx(9.81 / 2 * (2 / 24) ** 2 / 0.01, rel=0.1)


def outward_volume(frame):
    a, b, c = (frame.points[frame.triangles[:, i]].astype(float) for i in range(3))
    return (a * numpy.cross(b, c)).sum() / 6


def test_particles_of_one_material(baked):
    run = RunFolder(str(baked[0] / "run"))
    water, jelly = (run.files(name, 1).read(particles=True) for name in ("water", "jelly"))
    assert len(water.points) + len(jelly.points) == len(ply.read(run.particle_file(1)))
    # A cube of four spacings, give or take half a row along each axis.
    assert 3.5 ** 3 < len(jelly.points) < 4.5 ** 3 and len(jelly.triangles) == 0
    assert len(set(jelly.ids.tolist())) == len(jelly.points) and jelly.points[:, 0].min() > 0.27
    assert run.files("water", -5).read(True).points.tolist() == water.points.tolist()
    assert len(run.files("water", 99).read(True).points) == len(water.points)


def test_frames_without_a_surface_show_particles(baked, tmp_path):
    folder = baked[0]
    os.symlink(folder / "run/particles", tmp_path / "particles")
    alone = RunFolder(str(tmp_path))
    assert len(alone.files("water", 2).read(particles=False).triangles) == 0
    assert RunFolder(str(tmp_path / "none")).files("water", 1) is None
    with pytest.raises(DreampmError, match="no folder of a run"):
        RunFolder(str(tmp_path / "none")).materials()


def test_attributes_of_a_file(tmp_path):
    names = [("x", "f4"), ("y", "f4"), ("z", "f4"), ("id", "i4"), ("red", "u1"), ("green", "u1"), ("blue", "u1"),
             ("age", "f4"), ("w_x", "f4"), ("w_y", "f4"), ("w_z", "f4"), ("lone_x", "f4"), ("radius", "f4")]
    rows = numpy.array([(1, 2, 3, 7, 255, 0, 51, 0.5, 1, 2, 3, 4, 0.25)], dtype=names)
    frame = Frame(ply.Ply(rows, numpy.empty((0, 3), "i4"), []), 0.01)
    assert set(frame.attributes) == {"color", "age", "w", "lone_x", "radius"}
    numpy.testing.assert_allclose(frame.attributes["color"], [[1, 0, 0.2, 1]])
    numpy.testing.assert_allclose(frame.attributes["w"], [[1, -3, 2]])  # turned, and per second: no unit
    assert frame.attributes["radius"] == pytest.approx(25)
    frame.keep(numpy.array([False]))
    assert len(frame.attributes["w"]) == 0


def test_names_of_surfaces(tmp_path):
    run = RunFolder(str(tmp_path))
    one, several = run.at("surface", "surface_000003.ply"), run.at("surface", "jelly_000003.ply")
    assert run.surface_of("jelly", 3, ["jelly"]) == one and run.surface_of("jelly", 3, ["water", "jelly"]) == several
    # Of a run that is not known, the files tell.
    assert run.surface_of("jelly", 3) == one
    os.makedirs(run.at("surface"))
    (tmp_path / "surface/jelly_000001.ply").touch()
    assert run.surface_of("jelly", 3) == several


def test_poses_of_floating_bodies(baked):
    poses = RunFolder(str(baked[0] / "run")).poses()
    assert [frame for frame, _ in poses["block"]] == [1, 2, 3, 4, 5, 6]
    first, second, last = (poses["block"][i][1] for i in (0, 1, 5))
    assert numpy.allclose(first, numpy.eye(4), atol=1e-6)
    assert second[1, 3] == pytest.approx(-9.81 / 2 / 24 ** 2, rel=0.05)  # y is up; some forty explicit steps
    assert last[1, 3] < -0.03 and numpy.allclose(last[:3, :3] @ last[:3, :3].T, numpy.eye(3), atol=1e-6)


def test_cancel_and_resume(tmp_path):
    write_scene(tmp_path / "scene.yaml", small_setup(tmp_path, frames=400))
    run = RunFolder(str(tmp_path / "run"))
    one = job.Job(job.bake_calls(COMMAND, str(tmp_path / "scene.yaml"), run.path, 2),
                  lambda stage, frame: run.particle_file(frame))
    one.start()
    end = time.monotonic() + 60
    while one.poll() and one.progress.done < 3:
        assert time.monotonic() < end
        time.sleep(0.02)
    assert one.text().startswith("Simulating ") and " left" in one.text()
    one.cancel()
    assert one.state == "stopping" and one.text().startswith("Stopping")
    while one.poll():
        assert time.monotonic() < end
        time.sleep(0.02)
    reached = run.last_frame()
    assert one.state == "stopped" and 3 <= reached < 400 and run.can_resume()
    assert run.record()["status"] == "interrupted"

    calls = job.resume_calls(COMMAND, run.path, reached + 2, 2, "cuda")
    assert calls[0][calls[0].index("--backend") + 1] == "cuda"
    more = finish(job.Job(job.resume_calls(COMMAND, run.path, reached + 2, 2)))
    assert more.state == "done", more.error
    assert run.last_frame() == reached + 2 and os.path.exists(run.surface_of("jelly", reached + 2))
    assert any("going on from" in line for line in more.progress.lines)


def test_a_bake_by_a_gpu_that_is_not_there_says_so(tmp_path, monkeypatch):
    monkeypatch.setenv("DREAMPM_CUDA", "/nowhere.so")
    write_scene(tmp_path / "scene.yaml", small_setup(tmp_path))
    one = finish(job.Job(job.bake_calls(COMMAND, str(tmp_path / "scene.yaml"), str(tmp_path / "run"), 2, "cuda")))
    assert one.state == "failed" and "no CUDA: /nowhere.so" in one.error
    assert not (tmp_path / "run").exists()


def test_errors_reach_the_user(tmp_path):
    setup = small_setup(tmp_path)
    setup.bodies[1].material = Material("elastic", "jello")
    write_scene(tmp_path / "scene.yaml", setup)
    one = finish(job.Job(job.bake_calls(COMMAND, str(tmp_path / "scene.yaml"), str(tmp_path / "run"))))
    assert one.state == "failed" and "jello" in one.error and "'jelly'" in one.error
    assert not (tmp_path / "run").exists()
    one = finish(job.Job([[str(tmp_path / "nothing")]]))
    assert one.state == "failed" and "cannot be run" in one.error


def test_free_takes_what_a_run_wrote_and_no_more(tmp_path):
    run = RunFolder(str(tmp_path / "run"))
    for name in ("particles", "surface"):
        os.makedirs(run.at(name))
    for name in ("run.json", "ledger.csv", "mine.txt", "particles/particles_000001.ply"):
        with open(run.at(*name.split("/")), "w", encoding="utf-8") as file:
            file.write("{}")
    run.free()
    assert os.listdir(run.path) == ["mine.txt"]
    os.remove(run.at("mine.txt"))
    run.free()
    assert not os.path.exists(run.path)
    run.free()


def test_a_damaged_record(tmp_path):
    (tmp_path / "run.json").write_text(json.dumps({"frames": []})[:-4])
    with pytest.raises(DreampmError, match="run.json"):
        RunFolder(str(tmp_path)).poses()

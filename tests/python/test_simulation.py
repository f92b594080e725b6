import gc
import json
import os
import signal
import subprocess
import threading
import time
import weakref

import numpy as np
import pytest

import dreampm as dm
from conftest import COMMAND, SOURCE


def test_the_bits_are_those_of_the_command(tmp_path):
    subprocess.run([COMMAND, "run", SOURCE / "scenes/dam-break.yaml", "--variant", "tiny", "--frames", "4", "--out",
                    tmp_path / "run"], check=True, capture_output=True)
    said = subprocess.run([COMMAND, "info", tmp_path / "run"], check=True, capture_output=True, text=True).stdout
    sim = dm.Simulation(dm.Scene.load(SOURCE / "scenes/dam-break.yaml", variant="tiny"))
    sim.advance_frames(3)
    assert f"state_hash       {sim.hash()}\n" in said


def test_bits_do_not_depend_on_threads_or_on_how_time_is_asked_for(dam):
    one, two = dm.Simulation(dam, threads=1), dm.Simulation(dam, threads=2)
    one.advance_frames(2)
    for _ in two.frames(2):
        pass
    assert one.hash() == two.hash() and one.time == two.time == 2 / 24
    for _ in range(3):
        one.step()
    two.advance_steps(3)
    assert one.hash() == two.hash() and one.steps == two.steps


def test_reports(dam):
    sim = dm.Simulation(dam)
    report = sim.step()
    assert report.step == 1 and report.time == report.dt == sim.time
    assert report.limiter in ("speed", "wave", "user", "frame")
    assert 0.9 < report.j_min <= 1 <= report.j_max < 1.1
    frames = sim.frames(3)
    assert len(frames) == 3
    events = list(frames)
    assert [e.frame for e in events] == [2, 3, 4]
    assert [e.time for e in events] == pytest.approx([1 / 24, 2 / 24, 3 / 24])
    assert events[0].steps + events[1].steps + events[2].steps == sim.steps - 1
    assert len(sim.frames()) == dam.frame_count - 4
    sim.advance_to(0.2)
    assert 0.2 <= sim.time < 0.2 + 2 * sim.dt
    with pytest.raises(dm.InputError, match="must be 0 or more"):
        sim.frames(-1)


def test_probes_measure_what_the_command_writes(dam, tmp_path):
    probes = {"level": {"type": "height", "at": [0.1, 0.1]},
              "push": {"type": "force", "on": "x_max", "rate": 100}}
    scene = dm.Scene.load(SOURCE / "scenes/dam-break.yaml", variant="tiny", set={"probes": probes})
    words = [f"--set=probes.{name}={json.dumps(probe)}" for name, probe in probes.items()]
    subprocess.run([COMMAND, "run", SOURCE / "scenes/dam-break.yaml", "--variant", "tiny", "--frames", "5", "--out",
                    tmp_path / "run", *words], check=True, capture_output=True)
    sim = dm.Simulation(scene)
    assert list(sim.probes) == list(probes) and "level" in sim.probes
    assert len(sim.probes["level"]["time"]) == 1 and len(sim.probes["push"]["time"]) == 0
    sim.advance_frames(2)
    snap = sim.snapshot()
    for _ in range(2):
        sim.restore(snap)
        assert len(sim.probes["level"]["time"]) == 3
        sim.advance_frames(2)
        for name in probes:
            with open(tmp_path / "run/probes" / f"{name}.csv") as file:
                columns = file.readline().strip().split(",")
                rows = np.loadtxt(file, delimiter=",", ndmin=2)
            measured = sim.probes[name]
            assert list(measured) == columns
            for n, column in enumerate(columns):
                np.testing.assert_array_equal(measured[column], rows[:, n])
    with pytest.raises(dm.InputError, match="probe depth is not in the scene; it has"):
        sim.probes["depth"]


def test_a_simulation_is_saved_and_goes_on(tank, tmp_path):
    sim = dm.Simulation(tank)
    sim.advance_to(0.05)
    sim.materials["jelly"].density = 700
    sim.colliders["gate"].motion = dm.Twist(velocity=(0, 0.5, 0))
    sim.set_brush("hand", dm.VelocityBrush(point=(0.1, 0.1, 0.1), radius=0.05, velocity=(1, 0, 0)))
    sim.step()
    sim.save(tmp_path / "pond.yaml")
    assert sorted(os.listdir(tmp_path)) == ["pond.start.h5", "pond.yaml"]
    again = dm.Simulation(dm.Scene.load(tmp_path / "pond.yaml"), threads=1)
    assert (again.hash(), again.time, again.steps) == (sim.hash(), sim.time, sim.steps)
    sim.advance_steps(20)
    again.advance_steps(20)
    assert again.hash() == sim.hash()
    # The command goes on from it, too.
    subprocess.run([COMMAND, "run", "pond.yaml", "--frames", str(sim.frame + 1)], check=True, capture_output=True,
                   cwd=tmp_path)
    said = subprocess.run([COMMAND, "info", "out/pond"], check=True, capture_output=True, text=True, cwd=tmp_path)
    again.advance_frames(sim.frame + 1 - again.frame)
    assert again.hash() in said.stdout
    with pytest.raises(dm.InputError, match="must end in .yaml"):
        sim.save(tmp_path / "pond.h5")


def test_time_does_not_go_back(dam):
    sim = dm.Simulation(dam)
    sim.advance_to(0.02)
    time, steps = sim.time, sim.steps
    sim.advance_to(0.01)
    assert (sim.time, sim.steps) == (time, steps)


def test_a_second_thread_hears_of_the_first(dam):
    sim, said_to_other, began = dm.Simulation(dam), [], threading.Event()

    def other():
        began.wait()
        try:
            sim.step()
        except dm.RunError as error:
            said_to_other.append(str(error))

    @sim.on_step
    def wait(_report):
        began.set()
        thread.join(0.5)

    thread = threading.Thread(target=other)
    thread.start()
    sim.step()
    thread.join()
    assert said_to_other == ["another thread is using the simulation: one thread at a time may"]


def test_arrays_are_zero_copy_read_only_and_show_their_time(dam):
    sim = dm.Simulation(dam)
    water = sim.particles["water"]
    n = len(water)
    assert n == sim.particle_count
    for array, shape, kind in ((water.position, (n, 3), np.float32), (water.velocity, (n, 3), np.float32),
                               (water.color, (n, 3), np.float32), (water.J, (n,), np.float32),
                               (water.id, (n,), np.uint32)):
        assert isinstance(array, np.ndarray) and array.shape == shape and array.dtype == kind
        assert not array.flags.writeable and not array.flags.owndata
    assert np.shares_memory(water.position, sim.particles["water"].position)
    with pytest.raises(ValueError):
        water.position[0] = 0
    start = water.position.copy()
    sim.advance_frames(2)
    assert np.array_equal(water.position, start)
    now = sim.particles["water"].position
    assert not np.array_equal(now, start) and np.isfinite(now).all()
    assert np.all(np.diff(sim.particles["water"].id.astype(np.int64)) > 0)


def test_arrays_outlive_the_simulation(dam):
    sim = dm.Simulation(dam)
    sim.advance_frames(1)
    x, v = sim.particles["water"].position, sim.particles["water"].velocity
    want_x, want_v = x.copy(), v.copy()
    del sim
    gc.collect()
    rubbish = [np.full(x.shape, np.nan, np.float32) for _ in range(20)]
    assert np.array_equal(x, want_x) and np.array_equal(v, want_v) and len(rubbish) == 20


def test_dlpack(dam):
    sim = dm.Simulation(dam)
    x = sim.particles["water"].position
    back = np.from_dlpack(x)
    assert np.shares_memory(back, x) and np.array_equal(back, x)


def test_the_gil_is_free_while_it_steps(dam):
    sim = dm.Simulation(dam.with_({"space.spacing": 0.02}), threads=1)
    done, ticks = threading.Event(), []

    def tick():
        while not done.is_set():
            ticks.append(time.perf_counter())
            time.sleep(0.001)

    thread = threading.Thread(target=tick)
    thread.start()
    start = time.perf_counter()
    sim.advance_frames(8)
    length = time.perf_counter() - start
    done.set()
    thread.join()
    # Before and after the call the interpreter may give the GIL away; in the middle only the call can.
    middle = [t for t in ticks if 0.25 < (t - start) / length < 0.75]
    assert length > 0.1 and len(middle) > 10


def test_two_simulations_run_side_by_side(dam):
    alone = dm.Simulation(dam, threads=1)
    alone.advance_frames(3)
    sims = [dm.Simulation(dam, threads=1) for _ in range(2)]
    threads = [threading.Thread(target=s.advance_frames, args=(3,)) for s in sims]
    for t in threads:
        t.start()
    for t in threads:
        t.join()
    assert [s.hash() for s in sims] == [alone.hash()] * 2


def test_another_thread_is_refused_while_it_steps(dam):
    sim, refused = dm.Simulation(dam), []

    @sim.on_frame
    def look(_):
        def other():
            try:
                sim.particles["water"]
            except dm.RunError as e:
                refused.append(str(e))
        thread = threading.Thread(target=other)
        thread.start()
        thread.join()

    sim.advance_frames(1)
    assert refused == ["another thread is using the simulation: one thread at a time may"]
    assert len(sim.particles["water"]) == sim.particle_count


def interrupt_soon(seconds):
    thread = threading.Timer(seconds, os.kill, (os.getpid(), signal.SIGINT))
    thread.start()
    return thread


def test_an_interrupt_stops_after_a_whole_step(dam):
    sim = dm.Simulation(dam.with_({"space.spacing": 0.02}))
    timer = interrupt_soon(0.3)
    start = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        sim.advance_to(1000)
    timer.join()
    assert time.monotonic() - start < 5
    steps = sim.steps
    again = dm.Simulation(sim.scene)
    again.advance_steps(steps)
    assert again.hash() == sim.hash()
    sim.step()
    assert sim.steps == steps + 1


def test_a_handler_decides_what_a_signal_raises(dam):
    class Late(Exception):
        pass

    def late(*_):
        raise Late

    before = signal.signal(signal.SIGALRM, late)
    try:
        signal.setitimer(signal.ITIMER_REAL, 0.2)
        with pytest.raises(Late):
            dm.Simulation(dam).advance_to(1000)
    finally:
        signal.signal(signal.SIGALRM, before)


def test_snapshots(dam):
    sim = dm.Simulation(dam)
    sim.advance_frames(1)
    then, start = sim.snapshot(), sim.hash()
    sim.advance_frames(1)
    first = sim.hash()
    sim.restore(then)
    assert sim.hash() == start and sim.time == then.time and then.bytes > 1e5
    sim.gravity = (0, 9.81, 0)
    sim.advance_frames(1)
    assert sim.hash() != first
    sim.restore(then)
    sim.advance_frames(1)
    assert sim.hash() == first
    with pytest.raises(dm.InputError, match="another scene"):
        dm.Simulation(dam.with_({"space.spacing": 0.05})).restore(then)


def test_observers(dam):
    sim, steps, frames = dm.Simulation(dam), [], []
    sim.on_step(lambda r: steps.append((r.step, r.time)))

    @sim.on_frame
    def at_frame(event):
        frames.append(event.frame)
        if event.frame == 3:
            raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        sim.advance_frames(5)
    assert frames == [2, 3] and steps[-1] == (sim.steps, sim.time) and len(steps) == sim.steps
    assert callable(at_frame)
    sim.advance_frames(1)
    assert frames == [2, 3, 4]


def test_an_observer_may_edit_but_not_step(dam):
    sim, said = dm.Simulation(dam), []

    @sim.on_frame
    def edit(event):
        sim.gravity = (0, -1 * event.frame, 0)
        try:
            sim.step()
        except dm.RunError as e:
            said.append(str(e))

    sim.advance_frames(2)
    assert sim.gravity == (0, -3, 0) and said == ["a simulation cannot be stepped by its own observers"] * 2
    want = dm.Simulation(dam)
    want.advance_frames(1)
    want.gravity = (0, -2, 0)
    want.advance_frames(1)
    want.gravity = (0, -3, 0)
    assert want.hash() == sim.hash()


def test_a_circle_through_an_observer_is_collected(dam):
    class Mark:
        pass

    mark = Mark()
    gone = weakref.ref(mark)
    sim = dm.Simulation(dam)
    water = sim.materials["water"]
    sim.on_step(lambda r, mark=mark, sim=sim, water=water: None)
    del sim, mark, water
    gc.collect()
    assert gone() is None


def test_a_snapshot_goes_to_another_backend(dam, monkeypatch):
    monkeypatch.setenv("DREAMPM_CUDA", os.environ["STAND_IN"])
    cuda, cpu = (dm.Simulation(dam, backend=backend, threads=1) for backend in ("cuda", "cpu"))
    assert cuda.backend == "cuda" and cuda.isa == "sm_90"
    cuda.advance_to(0.02)
    then = cuda.snapshot()
    cpu.restore(then)
    assert np.array_equal(cpu.particles["water"].position, cuda.particles["water"].position)
    cuda.advance_to(0.04), cpu.advance_to(0.04)
    assert np.allclose(cpu.particles["water"].position, cuda.particles["water"].position, atol=1e-3 * dam.spacing)
    future = cuda.hash()
    cuda.restore(then)
    cuda.advance_to(0.04)
    assert cuda.hash() == future
    with pytest.raises(dm.InputError, match="precision of reference"):
        dm.Simulation(dam, backend="reference").restore(then)


def test_what_is_wrong_is_said(dam, monkeypatch):
    with pytest.raises(dm.InputError, match="cpu"):
        dm.Simulation(dam, backend="gpu")
    with pytest.raises(dm.InputError, match="it has water"):
        dm.Simulation(dam).surface("watr")
    monkeypatch.setenv("DREAMPM_CUDA", "/nowhere.so")
    with pytest.raises(dm.InputError, match="no CUDA: /nowhere.so"):
        dm.Simulation(dam, backend="cuda")
    sim = dm.Simulation(dam.with_({"time.dt": 0.0005}))
    sim.materials["water"].bulk_modulus = 1e9
    with pytest.raises(dm.InputError, match="dt"):
        sim.step()
    assert issubclass(dm.NumericalFailure, dm.RunError) and issubclass(dm.RunError, RuntimeError)


def test_help_reads_well():
    import pydoc
    text = pydoc.render_doc(dm.Simulation, renderer=pydoc.plaintext)
    assert "class Simulation" in text and "float32 (n, 3) [m]" in text and "GIL" in text
    for name in dm.__all__:
        member = getattr(dm, name)
        assert name == "__version__" or member.__doc__, name
        if isinstance(member, type):
            assert member.__module__ == "dreampm", name
    undocumented = [n for n in dir(dm.Simulation)
                    if not n.startswith("_") and not getattr(dm.Simulation, n).__doc__]
    assert undocumented == []


def test_attached_files_are_those_of_the_command(tmp_path):
    scene = SOURCE / "scenes/dam-break.yaml"
    subprocess.run([COMMAND, "run", scene, "--variant", "tiny", "--frames", "4", "--out", tmp_path / "run"], check=True,
                   capture_output=True)
    sim = dm.Simulation(dm.Scene.load(scene, variant="tiny"))
    sim.attach(dm.LedgerFile(tmp_path / "own/ledger.csv"))
    sim.attach(dm.ParticleFiles(tmp_path / "own/particles"))
    sim.attach(dm.CheckpointFiles(tmp_path / "own/saved", every=2))
    sim.advance_frames(3)
    for file in ("ledger.csv", "particles/particles_000001.ply", "particles/particles_000004.ply"):
        assert (tmp_path / "own" / file).read_bytes() == (tmp_path / "run" / file).read_bytes(), file
    later = dm.Simulation(dm.Scene.load(tmp_path / "own/saved/checkpoint_000004.yaml"))
    assert later.hash() == sim.hash()
    with pytest.raises(dm.InputError, match="mood"):
        sim.attach(dm.ParticleFiles(tmp_path / "own", attributes=["mood"]))

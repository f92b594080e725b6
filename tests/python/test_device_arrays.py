"""Particles as arrays on a device. What stands in for a card has the memory of the host, which numpy reads; its number 4
says that it is CUDA's, so that what other programs learn of a card is seen without one."""
import ctypes
import gc
import os

import numpy as np
import pytest

import dreampm as dm

stand_in = ctypes.CDLL(os.environ["STAND_IN"])
stand_in.stand_in_waits.restype = stand_in.stand_in_last_stream.restype = ctypes.c_ulonglong
stand_in.stand_in_allocated.restype = ctypes.c_longlong


class Tensor(ctypes.Structure):
    _fields_ = [("data", ctypes.c_void_p), ("kind", ctypes.c_int32), ("number", ctypes.c_int32),
                ("ndim", ctypes.c_int32), ("code", ctypes.c_uint8), ("bits", ctypes.c_uint8),
                ("lanes", ctypes.c_uint16), ("shape", ctypes.POINTER(ctypes.c_int64)),
                ("strides", ctypes.POINTER(ctypes.c_int64)), ("byte_offset", ctypes.c_uint64)]


class Versioned(ctypes.Structure):
    _fields_ = [("major", ctypes.c_uint32), ("minor", ctypes.c_uint32), ("manager", ctypes.c_void_p),
                ("deleter", ctypes.c_void_p), ("flags", ctypes.c_uint64), ("tensor", Tensor)]


READ_ONLY, IS_COPIED = 1, 2


def pointer_in(capsule, name, kind):
    get = ctypes.pythonapi.PyCapsule_GetPointer
    get.restype, get.argtypes = ctypes.c_void_p, [ctypes.py_object, ctypes.c_char_p]
    return kind.from_address(get(capsule, name))


@pytest.fixture
def simulate(monkeypatch):
    """Simulations on the device of that number of the stand-in."""
    def make(scene, number=0):
        monkeypatch.setenv("DREAMPM_CUDA", os.environ["STAND_IN"])
        monkeypatch.setenv("DREAMPM_STAND_IN", str(number))
        return dm.Simulation(scene, backend="cuda", threads=1)
    return make


@pytest.fixture
def allocated():
    """How many pieces of the device's memory there are more than at the start."""
    gc.collect()
    before = stand_in.stand_in_allocated()
    return lambda: gc.collect() * 0 + stand_in.stand_in_allocated() - before


def expect_those_of_the_host(sim, material):
    arrays = sim.particles.on_device(material)
    host = sim.particles[material]
    ids = np.from_dlpack(arrays.id)
    order = ids.argsort()
    assert np.array_equal(ids[order], host.id)
    assert np.array_equal(np.from_dlpack(arrays.position)[order], host.position)
    assert np.array_equal(np.from_dlpack(arrays.velocity)[order], host.velocity)
    return order


def test_arrays_are_those_of_numpy(tank, simulate):
    sim = simulate(tank)
    for material in ("water", "jelly"):
        expect_those_of_the_host(sim, material)
    sim.advance_frames(3)
    for material in ("water", "jelly"):
        order = expect_those_of_the_host(sim, material)
        assert not np.array_equal(order, np.arange(len(order)))  # the order is that of memory
    sim.add_particles("water", [[0.3, 0.3, 0.1], [0.32, 0.3, 0.1]], velocity=(0, -2, 0))
    expect_those_of_the_host(sim, "water")
    sim.advance_steps(5)
    expect_those_of_the_host(sim, "water")
    sim.remove(dm.box((0, 0, 0), (0.4, 0.4, 0.2)))
    expect_those_of_the_host(sim, "water")
    assert len(sim.particles.on_device("water")) == 0


def test_what_an_array_says_of_itself(dam, simulate):
    sim = simulate(dam)
    n = sim.particle_count
    water = sim.particles.on_device("water")
    assert isinstance(water, dm.DeviceParticles) and len(water) == n and repr(water) == f"<{n} particles on cpu>"
    for array, shape, kind in ((water.position, (n, 3), np.float32), (water.velocity, (n, 3), np.float32),
                               (water.id, (n,), np.uint32)):
        assert isinstance(array, dm.DeviceArray)
        assert array.shape == shape and array.dtype == kind and len(array) == n and array.device == "cpu"
        assert array.__dlpack_device__() == (1, 0)
        assert not hasattr(array, "__cuda_array_interface__")
        back = np.from_dlpack(array)
        assert back.shape == shape and back.dtype == kind and not back.flags.writeable
        assert back.flags.c_contiguous
        with pytest.raises(TypeError, match="from_dlpack"):
            np.asarray(array)
    assert repr(water.id) == f"<DeviceArray uint32 ({n},) on cpu>"
    assert water.position.__doc__ and "read-only" in water.position.__doc__


def test_arrays_stay_as_they_were(dam, simulate, allocated):
    sim = simulate(dam)
    sim.advance_frames(1)
    water = sim.particles.on_device("water")
    x = np.from_dlpack(water.position)
    want = x.copy()
    sim.advance_frames(1)
    assert np.array_equal(x, want)
    assert not np.array_equal(np.from_dlpack(sim.particles.on_device("water").position), want)
    del sim
    assert allocated() == 3  # of `water`: all of the simulation is gone
    assert np.array_equal(np.from_dlpack(water.position), want)
    del water
    assert allocated() == 1
    rubbish = [np.full(x.shape, np.nan, np.float32) for _ in range(20)]
    assert np.array_equal(x, want) and len(rubbish) == 20
    del x
    assert allocated() == 0


def test_a_capsule_that_nobody_takes_frees_its_array(dam, simulate, allocated):
    sim = simulate(dam)
    capsules = [sim.particles.on_device("water").position.__dlpack__(max_version=version)
                for version in (None, (0, 8), (1, 0), (1, 1), (2, 0))]
    del sim
    assert allocated() == len(capsules)
    for kept in range(len(capsules), 0, -1):
        assert allocated() == kept
        capsules.pop()
    assert allocated() == 0


def test_a_capsule_is_taken_once(dam, simulate, allocated):
    class Twice:
        def __init__(self, capsule):
            self.capsule = capsule

        def __dlpack__(self, **_):
            return self.capsule

        def __dlpack_device__(self):
            return (1, 0)

    sim = simulate(dam)
    for version in (None, (1, 0)):
        twice = Twice(sim.particles.on_device("water").position.__dlpack__(max_version=version))
        x = np.from_dlpack(twice)
        assert x.shape == (sim.particle_count, 3)
        with pytest.raises((ValueError, BufferError, TypeError)):
            np.from_dlpack(twice)
        assert np.isfinite(x).all()
    del sim, twice, x
    assert allocated() == 0


def test_what_capsules_hold(dam, simulate):
    sim = simulate(dam)
    array = sim.particles.on_device("water").position
    versioned = array.__dlpack__(max_version=(1, 0))
    inside = pointer_in(versioned, b"dltensor_versioned", Versioned)
    assert (inside.major, inside.minor, inside.flags) == (1, 0, READ_ONLY)
    old = array.__dlpack__()
    for tensor in (inside.tensor, pointer_in(old, b"dltensor", Tensor)):
        assert (tensor.kind, tensor.number, tensor.ndim, tensor.byte_offset) == (1, 0, 2, 0)
        assert (tensor.code, tensor.bits, tensor.lanes) == (2, 32, 1)
        assert tensor.shape[:2] == list(array.shape) and tensor.strides[:2] == [3, 1]
        assert tensor.data == np.from_dlpack(array).ctypes.data
    copy = array.__dlpack__(max_version=(1, 0), copy=True)
    assert pointer_in(copy, b"dltensor_versioned", Versioned).flags == IS_COPIED
    id_ = sim.particles.on_device("water").id.__dlpack__()
    tensor = pointer_in(id_, b"dltensor", Tensor)
    assert (tensor.code, tensor.bits, tensor.ndim, tensor.shape[0], tensor.strides[0]) == (1, 32, 1, array.shape[0], 1)


def test_a_copy_may_be_written(dam, simulate):
    array = simulate(dam).particles.on_device("water").position
    x, y = np.from_dlpack(array), np.from_dlpack(array, copy=True)
    assert np.array_equal(x, y) and not np.shares_memory(x, y)
    assert np.shares_memory(x, np.from_dlpack(array, copy=False))
    y += 1
    assert np.array_equal(x + 1, y)


def test_streams_of_the_host(dam, simulate):
    array = simulate(dam).particles.on_device("water").position
    array.__dlpack__(stream=None), array.__dlpack__(stream=-1)
    with pytest.raises(ValueError, match="pass 1"):
        array.__dlpack__(stream=0)
    for stream in (1, 2, -2):
        with pytest.raises(ValueError, match="must be None"):
            array.__dlpack__(stream=stream)
    for wrong in ({"stream": "one"}, {"max_version": 1}, {"dl_device": "cpu"}, {"stram": 1}):
        with pytest.raises(TypeError):
            array.__dlpack__(**wrong)
    with pytest.raises(TypeError):
        array.__dlpack__(1)


def test_streams_of_cuda_wait(dam, simulate):
    array = simulate(dam, number=4).particles.on_device("water").position
    assert array.__dlpack_device__() == (2, 4) and array.device == "cuda:4"
    for stream, waits_for in ((None, 1), (1, 1), (2, 2), (0x7F0012345678, 0x7F0012345678)):
        before = stand_in.stand_in_waits()
        array.__dlpack__(stream=stream, max_version=(1, 0))
        assert (stand_in.stand_in_waits(), stand_in.stand_in_last_stream()) == (before + 1, waits_for)
    before = stand_in.stand_in_waits()
    array.__dlpack__(stream=-1)
    for stream in (0, -2):
        with pytest.raises(ValueError):
            array.__dlpack__(stream=stream)
    assert stand_in.stand_in_waits() == before


def test_the_cuda_array_interface(dam, simulate):
    sim = simulate(dam, number=4)
    water = sim.particles.on_device("water")
    before = stand_in.stand_in_waits()
    shown = water.velocity.__cuda_array_interface__
    assert (stand_in.stand_in_waits(), stand_in.stand_in_last_stream()) == (before + 1, 1)
    capsule = water.velocity.__dlpack__(max_version=(1, 0))
    tensor = pointer_in(capsule, b"dltensor_versioned", Versioned).tensor
    assert shown == {"shape": (len(water), 3), "typestr": "<f4", "data": (tensor.data, True), "strides": None,
                    "stream": 1, "version": 3}
    assert water.id.__cuda_array_interface__["typestr"] == "<u4"
    assert water.id.__cuda_array_interface__["shape"] == (len(water),)
    sim.remove(dm.box((-1, -1, -1), (9, 9, 9)))
    empty = sim.particles.on_device("water").position
    assert empty.__cuda_array_interface__["data"] == (0, True) and empty.shape == (0, 3)


def test_from_a_card_to_the_host(dam, simulate):
    sim = simulate(dam, number=4)
    array, host = sim.particles.on_device("water").position, sim.particles["water"]
    # numpy knows the host's memory alone, and asks for it where one says so.
    with pytest.raises((BufferError, RuntimeError)):
        np.from_dlpack(array)
    x = np.from_dlpack(array, device="cpu")
    order = np.from_dlpack(sim.particles.on_device("water").id, device="cpu").argsort()
    assert np.array_equal(x[order], host.position) and x.flags.writeable
    with pytest.raises(BufferError, match="only as a copy"):
        array.__dlpack__(dl_device=(1, 0), copy=False)
    with pytest.raises(BufferError, match="cuda:4, and goes to cpu, not to cuda:1"):
        array.__dlpack__(dl_device=(2, 1))
    capsule = array.__dlpack__(dl_device=(2, 4), max_version=(1, 0), copy=True)
    inside = pointer_in(capsule, b"dltensor_versioned", Versioned)
    assert (inside.tensor.kind, inside.tensor.number, inside.flags) == (2, 4, IS_COPIED)


def test_what_is_wrong_is_said(dam, simulate):
    sim = dm.Simulation(dam)
    with pytest.raises(dm.InputError, match="backend cpu keeps particles in the host's memory.*backend cuda"):
        sim.particles.on_device("water")
    with pytest.raises(dm.InputError, match="it has water"):
        simulate(dam).particles.on_device("watr")
    with pytest.raises(dm.InputError, match="projection"):
        simulate(dam.with_({"time.solver": "projection"})).particles.on_device("water")
    with pytest.raises(TypeError):
        dm.DeviceArray()

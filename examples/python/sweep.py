"""Sweeps a viscosity: how far does a dam of it run in a fifth of a second?

Two simulations run at a time, each on one thread: the GIL is free while they step.

    python examples/python/sweep.py
"""
from concurrent.futures import ThreadPoolExecutor

import dreampm as dm

SCENE = dm.Scene(
    space={"min": [0, 0, 0], "max": [0.8, 0.3, 0.1], "spacing": 0.0125},
    materials={"liquid": {"type": "newtonian", "density": 1000}},
    bodies={"dam": {"material": "liquid", "shape": {"box": {"min": [0, 0, 0], "max": [0.2, 0.2, 0.1]}}}})


def front(viscosity):
    """How far the liquid has come after 0.2 s [m], by the particle that 1 % are ahead of."""
    sim = dm.Simulation(SCENE.with_({"materials.liquid.viscosity": viscosity}), threads=1)
    sim.advance_to(0.2)
    x = sorted(sim.particles["liquid"].position[:, 0])
    return x[int(0.99 * len(x))]


def main():
    viscosities = [1e-3, 1, 10, 100, 1000]
    with ThreadPoolExecutor(2) as pool:
        fronts = list(pool.map(front, viscosities))
    print("viscosity [Pa s]   front [m]")
    for viscosity, x in zip(viscosities, fronts):
        print(f"{viscosity:16g}   {x:9.3f}")


if __name__ == "__main__":
    main()

"""Fits a material to a measurement: which viscosity makes a column slump as it was seen to?

The measurement here is a simulation itself, of 20 Pa s, so that the answer is known.

    python examples/python/fit.py
"""
import numpy as np
from scipy.optimize import minimize_scalar

import dreampm as dm

SCENE = dm.Scene(
    space={"min": [0, 0, 0], "max": [0.3, 0.3, 0.1], "spacing": 0.0125},
    materials={"syrup": {"type": "newtonian", "density": 1400}},
    bodies={"column": {"material": "syrup", "shape": {"box": {"min": [0, 0, 0], "max": [0.1, 0.2, 0.1]}}}})
TIMES = (0.1, 0.2, 0.3)


def heights(viscosity):
    """Of the middle of the mass at the times [m]."""
    sim = dm.Simulation(SCENE.with_({"materials.syrup.viscosity": viscosity}))
    middle = []
    for t in TIMES:
        sim.advance_to(t)
        middle.append(sim.particles["syrup"].position[:, 1].mean(dtype=np.float64))
    return np.array(middle)


def main():
    measured = heights(20)

    def misfit(log_viscosity):
        return float(np.sum((heights(10**log_viscosity) - measured) ** 2))

    found = minimize_scalar(misfit, bounds=(0, 2.5), method="bounded", options={"xatol": 1e-3})
    off = np.sqrt(found.fun / len(TIMES))
    print(f"{10**found.x:.2f} Pa s after {found.nfev} simulations; heights agree within {1e3 * off:.3f} mm")


if __name__ == "__main__":
    main()

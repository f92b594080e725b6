# DreaMPM in Python, cell by cell: docs/guide/python.md walks through it. Editors that know "# %%" (VS Code, Spyder,
# Jupyter with jupytext) run the cells one by one; `python docs/guide/python.py` runs all, and writes the plots as
# dam.png, fronts.png, futures.png and traced.png into the working folder.

# %% A scene, built of the sections that scene files have
import matplotlib.pyplot as plt
import numpy as np

import dreampm as dm

scene = dm.Scene(
    space={"min": [0, 0, 0], "max": [0.8, 0.4, 0.1], "spacing": 0.0125},
    time={"fps": 50},
    materials={"water": {"type": "newtonian", "preset": "water"}},
    bodies={"dam": {"material": "water", "shape": {"box": {"min": [0, 0, 0], "max": [0.2, 0.2, 0.1]}}}},
    render={"size": [480, 270], "samples": 8})
print(scene)

# %% A simulation of it, and its particles as arrays
sim = dm.Simulation(scene)
water = sim.particles["water"]
print(len(water), "particles,", water.position.dtype, water.position.shape)

# %% Frames of a dam break, colored by speed
figure, panels = plt.subplots(2, 2, figsize=(9, 5), sharex=True, sharey=True, layout="constrained")
for panel, t in zip(panels.flat, (0, 0.1, 0.2, 0.3)):
    sim.advance_to(t)
    water = sim.particles["water"]
    x, speed = water.position, np.linalg.norm(water.velocity, axis=1)
    dots = panel.scatter(x[:, 0], x[:, 1], c=speed, s=3, cmap="viridis", vmin=0, vmax=2)
    panel.set(title=f"t = {sim.time:.2f} s", xlim=(0, 0.8), ylim=(0, 0.4), aspect="equal")
figure.supxlabel("x [m]")
figure.supylabel("y [m]")
figure.colorbar(dots, ax=panels, label="speed [m/s]")
figure.savefig("dam.png", dpi=100)

# %% One run for each of four viscosities
figure, panel = plt.subplots(figsize=(6, 4), layout="constrained")
for viscosity in (1e-3, 5, 50, 500):
    sim = dm.Simulation(scene)
    sim.materials["water"].viscosity = viscosity  # Pa s
    times, fronts = [0], [0.2]
    for frame in sim.frames(14):
        times.append(frame.time)
        fronts.append(np.percentile(sim.particles["water"].position[:, 0], 99))
    panel.plot(times, fronts, marker=".", label=f"{viscosity:g} Pa s")
panel.set(xlabel="t [s]", ylabel="front [m]", title="A dam of 0.2 m runs")
panel.legend()
figure.savefig("fronts.png", dpi=100)

# %% Back in time: two futures of one moment
sim = dm.Simulation(scene)
sim.advance_to(0.2)
then = sim.snapshot()
figure, panel = plt.subplots(figsize=(6, 4), layout="constrained")
for gravity in ((0, -9.81, 0), (0, 9.81, 0)):
    sim.restore(then)
    sim.gravity = gravity
    times, heights = [], []
    for frame in sim.frames(15):
        times.append(frame.time)
        heights.append(sim.particles["water"].position[:, 1].mean())
    panel.plot(times, heights, marker=".", label=f"gravity {gravity[1]} m/s²")
panel.axvline(then.time, color="gray", linewidth=1)
panel.set(xlabel="t [s]", ylabel="height of the middle of the mass [m]", title="The same moment, two futures")
panel.legend()
figure.savefig("futures.png", dpi=100)

# %% A surface, and a picture by the path tracer
sim.restore(then)
mesh = sim.surface("water", overlap=0)
print(mesh)
figure, panel = plt.subplots(figsize=(6.4, 3.6), layout="constrained")
panel.imshow(dm.render(sim))
panel.set_axis_off()
figure.savefig("traced.png", dpi=100)

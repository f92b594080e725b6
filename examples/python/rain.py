"""A rain machine: drops fall at random into a basin, and then one of its walls opens.

Writes rain.png into the working folder.

    python examples/python/rain.py
"""
import numpy as np

import dreampm as dm

SCENE = dm.Scene(
    space={"min": [0, 0, 0], "max": [0.4, 0.5, 0.3], "spacing": 0.0125, "walls": {"ceiling": {"type": "open"}}},
    time={"fps": 50},
    materials={"water": {"type": "newtonian", "preset": "water"}},
    bodies={"puddle": {"material": "water", "shape": {"box": {"min": [0, 0, 0], "max": [0.4, 0.05, 0.3]}}}},
    render={"size": [320, 240], "samples": 8})


def main():
    sim = dm.Simulation(SCENE)
    chance = np.random.default_rng(1)  # the same rain each time
    drops = 0

    @sim.on_frame
    def rain(event):
        nonlocal drops
        if event.frame % 2:
            return
        x, z = chance.uniform((0.05, 0.05), (0.35, 0.25))
        drops += 1
        drop = dm.sphere((x, 0.42, z), chance.uniform(0.02, 0.03))
        sim.add(dm.model.Body(f"drop{drops}", "water", drop, velocity=(0, -1.5, 0)))

    for frame in sim.frames(50):
        if frame.frame % 10 == 1:
            water = sim.totals
            print(f"t = {frame.time:.2f} s: {drops} drops, {water.mass:.2f} kg of water")
    sim.walls["x_max"] = "open"
    sim.advance_frames(25)
    gone = (sim.particles["water"].position[:, 0] > 0.4).sum() + sim.totals.left
    print(f"the wall at x_max is open: {gone} particles ran out")
    dm.write_png("rain.png", dm.render(sim))


if __name__ == "__main__":
    main()

"""A scene built of structs, without a scene file: a bowl is cut out of a block, and a drop falls into it."""
import dreampm as dm
from dreampm import model


def bowl():
    """A block with half a ball hollowed out, and a drop of water above."""
    block = dm.box((0.05, 0, 0.05), (0.35, 0.15, 0.35)) - dm.sphere((0.2, 0.17, 0.2), 0.12)
    scene = model.Scene(name="bowl", space=model.Space(max=(0.4, 0.4, 0.4), spacing=0.01))
    scene.time.frames = 24
    scene.materials.append(model.Material("water", "newtonian", dm.preset("newtonian", "water")))
    scene.materials[0].values["max_compression"] = 0.03  # a softer sound, longer steps
    scene.bodies.append(model.Body("drop", "water", dm.sphere((0.2, 0.18, 0.2), 0.06)))
    scene.colliders.append(model.Collider("bowl", block, friction=0.2))
    scene.render.looks["bowl"] = model.Look(type="plastic", color=(0.62, 0.09, 0.07), roughness=0.2)
    scene.probes.append(model.Probe("level", form=model.HeightProbe(0.2, 0.2)))
    return scene


def main():
    wrong = bowl()
    wrong.bodies[0].material = "watr"
    for line in dm.check(wrong):
        print("refused:", line)
    sim = dm.Simulation(dm.Scene(bowl()))
    sim.advance_to(0.6)
    water = sim.particles["water"].position
    inside = ((water[:, 0] - 0.2) ** 2 + (water[:, 2] - 0.2) ** 2 < 0.12**2).mean()
    print(f"t = {sim.time:.2f} s: {100 * inside:.0f} % of the water lies in the bowl, "
          f"{sim.probes['level']['height'][-1]:.3f} m high")


if __name__ == "__main__":
    main()

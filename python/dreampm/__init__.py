"""DreaMPM: simulation of liquids and solids by the material point method.

    import dreampm as dm
    sim = dm.Simulation(dm.Scene.load("scenes/dam-break.yaml", variant="preview"))
    for frame in sim.frames(24):
        print(frame.time, sim.particles["water"].position[:, 0].max())

Scenes are files or built of sections (`Scene`); a `Simulation` is stepped, watched, changed, drawn; `make`
turns a scene file into a film. SI units, y up. Lines that the library reports go to
logging.getLogger("dreampm").
"""
from ._dreampm import (
    BodyState, CheckpointFiles, Collider, Colliders, ColliderShape, Contact, DeviceArray, DeviceParticles, Error, FrameEvent, Frames, SpringAnchor, InputError, LedgerFile, Material,
    Materials, MaterialState, Mesh, Names, NearCollider, NumericalFailure, ParticleCounts, ParticleFiles, Particles,
    ParticleSets, Pose, ProbeFiles, RayHit, RunError, Scene, Shape, Simulation, Snapshot, Stepping, StepReport, VelocityBrush, Totals,
    Twist, Walls, box, cast_ray, check, colliders_near, contacts, cylinder, make, mesh, plane, preset,
    refused_parts, render, sphere, validate, version as __version__, write_png)
from . import model

__all__ = [
    "BodyState", "CheckpointFiles", "Collider", "ColliderShape", "Colliders", "Contact", "DeviceArray", "DeviceParticles", "Error", "FrameEvent", "Frames", "SpringAnchor",
    "InputError", "LedgerFile", "Material", "MaterialState", "Materials", "Mesh", "Names", "NearCollider",
    "NumericalFailure", "ParticleCounts", "ParticleFiles", "ParticleSets", "Particles", "Pose", "ProbeFiles", "RayHit", "RunError", "Scene", "Shape",
    "Simulation", "Snapshot", "StepReport", "Stepping", "VelocityBrush", "Totals", "Twist", "Walls", "__version__", "box",
    "cast_ray", "check", "colliders_near", "contacts", "cylinder", "make", "mesh", "model", "plane", "preset",
    "refused_parts", "render", "sphere", "validate", "write_png"]

# Names in messages and in help() are those that a program writes.
for _name in __all__:
    if isinstance(globals()[_name], type):
        globals()[_name].__module__ = "dreampm"
del _name

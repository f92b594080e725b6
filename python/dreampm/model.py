"""The structs that a scene is built of, without a scene file.

    from dreampm import model
    scene = model.Scene(name="drop", space=model.Space(max=(1, 1, 1), spacing=0.02))
    scene.materials.append(model.Material("water", "newtonian", dm.preset("newtonian", "water")))
    scene.bodies.append(model.Body("drop", "water", dm.sphere((0.5, 0.5, 0.5), 0.1)))
    sim = dm.Simulation(dm.Scene(scene))

Members have the names and the meaning of docs/reference/scene.md. `dm.check(scene)` lists what is wrong.
"""
from ._dreampm import model as _model

__all__ = [_name for _name in dir(_model) if not _name.startswith("_")]
for _name in __all__:
    globals()[_name] = getattr(_model, _name)
    globals()[_name].__module__ = "dreampm.model"
del _name

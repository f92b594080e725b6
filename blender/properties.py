# SPDX-License-Identifier: GPL-3.0-or-later
"""What the .blend file keeps: of objects their role, of a scene the domain and the bake."""
import bpy
from bpy.props import (BoolProperty, CollectionProperty, EnumProperty, FloatProperty, FloatVectorProperty, IntProperty,
                       PointerProperty, StringProperty)

from . import preferences
from .meshes import MESHES, bounds_of

ROLES = (("NONE", "None", "Takes no part"),
         ("LIQUID", "Liquid", "Is filled with a liquid: water, honey, mud"),
         ("MATERIAL", "Material", "Is made of a solid or of grains: jelly, rubber, snow, sand"),
         ("EMITTER", "Emitter", "Gives matter as long as it is open; stays filled with what moves through it"),
         ("COLLIDER", "Collider", "Matter meets it; its animation moves it"),
         ("FLOATING", "Floating body", "A rigid body that matter carries, pushes and turns, and that pushes back"),
         ("OUTFLOW", "Outflow", "Takes out the matter that comes into it"))
MATTER = ("LIQUID", "MATERIAL", "EMITTER")
GHOSTS = (*MATTER, "OUTFLOW")  # not seen in pictures: what becomes of them is
WALLS = (("separate", "Separate", "Matter slides along it and may leave it"),
         ("slip", "Slip", "Matter slides along it and does not let go"),
         ("stick", "Stick", "Matter beside it stands still"))
SIDES = (*WALLS, ("open", "Open", "There is no wall: what passes is gone"))

# Newer versions want it said that a path may begin with //, older ones do not know the word.
PATH = {"subtype": "DIR_PATH", "options": {"PATH_SUPPORTS_BLEND_RELATIVE"} if bpy.app.version >= (5, 0) else set()}

# Blender keeps no reference to the texts of a list that a function makes.
kept_texts = {}


def material_items(self, _context):
    liquid = {"LIQUID": True, "MATERIAL": False}.get(self.role)
    items = [(c.key, c.label, f"{c.help} ({c.type})") for c in preferences.materials() if liquid in (None, c.liquid)]
    if self.material_key not in [key for key, _, _ in items]:
        items.append((self.material_key, self.material_key.split("/")[-1].capitalize(), self.material_key))
    kept_texts[self.role] = [(*item, "NONE", i) for i, item in enumerate(items)]
    return kept_texts[self.role]


def get_material(self):
    return next(i for key, _, _, _, i in material_items(self, None) if key == self.material_key)


def set_material(self, index):
    self.material_key = material_items(self, None)[index][0]
    chosen = preferences.material(self.material_key)
    for i in reversed(range(len(self.values))):
        if chosen and not chosen.parameter(self.values[i].name):
            self.values.remove(i)


def role_changed(self, _context):
    thing = self.id_data
    ghost = self.role in GHOSTS
    thing.display_type = "WIRE" if ghost else "TEXTURED"
    thing.hide_render = ghost
    known = [c for c in preferences.materials() if c.liquid == (self.role != "MATERIAL")]
    if self.role in ("LIQUID", "MATERIAL") and known and self.material_key not in [c.key for c in known]:
        self.material_key = known[0].key
        self.values.clear()


def words_of(self, _context, _text):
    """The words that a value may be, for the field's suggestions."""
    for choice in preferences.materials():
        parameter = choice.parameter(self.name)
        if parameter and parameter.words:
            return list(parameter.words)
    return []


class DreampmValue(bpy.types.PropertyGroup):
    """A parameter of a material that is not as the preset has it; its name is the key."""
    number: FloatProperty(name="Value", precision=4)
    word: StringProperty(name="Word", search=words_of)


class DreampmObject(bpy.types.PropertyGroup):
    role: EnumProperty(name="Role", items=ROLES, default="NONE", update=role_changed,
                       description="What the object is to the simulation")
    material_key: StringProperty(default="newtonian/water")
    material: EnumProperty(name="Material", items=material_items, get=get_material, set=set_material,
                           description="What it is made of; the list is that of the command `dreampm materials`")
    values: CollectionProperty(type=DreampmValue)
    show: EnumProperty(name="Show As", default="AUTO", items=(
        ("AUTO", "Automatic", "Sand as particles, all else as a surface"),
        ("SURFACE", "Surface", "A closed mesh about the particles"),
        ("PARTICLES", "Particles", "A point for each particle")))
    # Without a unit of Blender's: it would show the number that is stored times the scene's unit scale.
    velocity: FloatVectorProperty(name="Velocity [m/s]", size=3, default=(0, 0, 0), subtype="XYZ",
                                  description="At the start, of an emitter always; in meters a second")
    spin: FloatVectorProperty(name="Spin [rad/s]", size=3, default=(0, 0, 0), subtype="XYZ",
                              description="At the start, about its middle, in radians a second")
    cut: BoolProperty(name="Cut Solids", default=True,
                      description="Leaves free what solid colliders and floating bodies take of it")
    surface: EnumProperty(name="Surface", items=WALLS, default="separate", description="What matter may do at it")
    friction: FloatProperty(name="Friction", min=0, max=100, default=0.3,
                            description="Coulomb's coefficient, for solids and grains; liquids do not feel it")
    shell: BoolProperty(name="Shell", default=False,
                        description="Only a wall about its faces: for sheets and for cups of one layer of faces. "
                                    "Else it is solid, and its holes are closed")
    thickness: FloatProperty(name="Thickness", min=0, default=0.05, unit="LENGTH", subtype="DISTANCE",
                             description="Of the wall, half of it on either side; at least the spacing")
    motion: EnumProperty(name="Motion", default="AUTO", items=(
        ("AUTO", "Automatic", "As the object is animated: still, moving, or deforming"),
        ("STILL", "Still", "It stands as at the first frame"),
        ("DEFORM", "Deforming", "A mesh for each frame")))
    density: FloatProperty(name="Density", min=0.1, max=30000, default=500, description="In kg/m^3; water has 1000")
    start: IntProperty(name="Start", default=1, description="The frame in which it opens")
    stop: IntProperty(name="Stop", default=0, description="The frame in which it closes; 0: never")
    pool: IntProperty(name="At Most", min=1, default=100000, description="Particles that it may give")
    recycle: BoolProperty(name="Recycle", default=False,
                          description="The number holds for particles that are there at once, not in all")


class DreampmResult(bpy.types.PropertyGroup):
    """Of an object that shows the frames of a run."""
    folder: StringProperty(name="Folder", **PATH, description="The run's folder")
    material: StringProperty(name="Material", description="Of the run, whose matter it shows")
    particles: BoolProperty(name="Particles", description="Shows particles though there may be a surface")
    foam: BoolProperty(name="Foam", description="Shows spray, foam, bubbles and dust of the run")
    first_frame: IntProperty(name="First Frame", default=1,
                             description="Of Blender, in which frame 1 of the run is shown")
    scale: FloatProperty(default=1, description="Meters per unit")


def domain_chosen(self, context):
    if not self.domain:
        return
    # A box about everything would hide it all.
    self.domain.display_type, self.domain.hide_render = "WIRE", True
    if self.spacing == 0:
        low, high = bounds_of(self.domain, context.evaluated_depsgraph_get())
        self.spacing = max(high - low) / 64


def is_mesh(_self, thing):
    return thing.type in MESHES


class DreampmScene(bpy.types.PropertyGroup):
    domain: PointerProperty(name="Domain", type=bpy.types.Object, poll=is_mesh, update=domain_chosen,
                            description="The box in which the simulation takes place: the bounds of this object")
    spacing: FloatProperty(name="Spacing", min=0, default=0, precision=4, unit="LENGTH", subtype="DISTANCE",
                           description="Between particles. Half of it takes 8 times the particles, 16 times the time")
    floor: EnumProperty(name="Floor", items=SIDES, default="separate")
    sides: EnumProperty(name="Sides", items=SIDES, default="separate")
    ceiling: EnumProperty(name="Ceiling", items=SIDES, default="open")
    scene_range: BoolProperty(name="Scene Range", default=True,
                              description="From the first to the last frame of the scene")
    frame_start: IntProperty(name="Start", default=1)
    frame_end: IntProperty(name="End", default=120)
    voxel: FloatProperty(name="Voxel", min=0.1, max=2, default=0.5,
                         description="Of the surface, in cells of two spacings. Smaller is finer and slower")
    smooth: IntProperty(name="Smoothing", min=0, max=10, default=2, description="Rounds of smoothing of the surface")
    threads: IntProperty(name="Threads", min=0, max=4096, default=0, description="The most threads to use; 0: all cores")
    backend: EnumProperty(name="Simulate On", default="cpu", items=[
        ("cpu", "CPU", "All cores, or as many as Threads says"),
        ("cuda", "NVIDIA GPU", "One card with compute capability 8.0 or newer; `dreampm info --device` names it")])
    folder: StringProperty(name="Folder", **PATH, default="//dreampm",
                           description="Where the scene and its frames are written; // is beside the .blend file")
    baked: StringProperty(description="What the frames in the folder are of", options={"HIDDEN"})

    def frames(self):
        """The first and last frame to simulate."""
        scene = self.id_data
        return (scene.frame_start, scene.frame_end) if self.scene_range else (self.frame_start, self.frame_end)


CLASSES = (DreampmValue, DreampmObject, DreampmResult, DreampmScene)


def register():
    for one in CLASSES:
        bpy.utils.register_class(one)
    bpy.types.Object.dreampm = PointerProperty(type=DreampmObject)
    bpy.types.Object.dreampm_result = PointerProperty(type=DreampmResult)
    bpy.types.Scene.dreampm = PointerProperty(type=DreampmScene)


def unregister():
    del bpy.types.Scene.dreampm
    del bpy.types.Object.dreampm_result
    del bpy.types.Object.dreampm
    for one in reversed(CLASSES):
        bpy.utils.unregister_class(one)

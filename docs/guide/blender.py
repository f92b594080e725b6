"""The bowl of docs/guide/blender.md, made by a script: a cube of water falls into a bowl, and one frame is rendered.

  blender --background --python docs/guide/blender.py -- bowl.blend

It wants the extension installed, and the command dreampm where the extension finds it. Or, where bpy is
a module of Python: python docs/guide/blender.py bowl.blend
"""
import argparse
import os
import sys

import bpy  # first: where bpy is a module, it brings the others
import addon_utils
import bmesh
from mathutils import Vector

arguments = sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else sys.argv[1:]
parser = argparse.ArgumentParser()
parser.add_argument("file", help="where to save the .blend file; the simulation goes beside it")
parser.add_argument("--spacing", type=float, default=0.0125, help="between particles, in meters")
parser.add_argument("--size", type=int, default=800, help="of the picture, in pixels")
parser.add_argument("--samples", type=int, default=64)
parser.add_argument("--frame", type=int, default=13, help="the one that is rendered")
asked = parser.parse_args(arguments)

bpy.ops.wm.read_homefile(use_empty=True)
bpy.ops.wm.save_as_mainfile(filepath=os.path.abspath(asked.file))
if not hasattr(bpy.types.Object, "dreampm"):
    addon_utils.enable("bl_ext.user_default.dreampm")
scene = bpy.context.scene
scene.frame_end, scene.render.fps = 24, 24

# A bowl: the lower half of a ball, with a wall. It is a collider.
bpy.ops.mesh.primitive_uv_sphere_add(radius=0.5, location=(0, 0, 0.6), segments=64, ring_count=32)
bowl = bpy.context.object
bowl.name = "Bowl"
mesh = bmesh.new()
mesh.from_mesh(bowl.data)
bmesh.ops.delete(mesh, geom=[v for v in mesh.verts if v.co.z > 0.01], context="VERTS")
mesh.to_mesh(bowl.data)
mesh.free()
bpy.ops.object.shade_smooth()
wall = bowl.modifiers.new("Wall", "SOLIDIFY")
wall.thickness, wall.offset = 0.08, 1
bowl.dreampm.role = "COLLIDER"

# A cube of water above it.
bpy.ops.mesh.primitive_cube_add(size=0.4, location=(0.06, 0.03, 0.78))
cube = bpy.context.object
cube.name = "Water"
cube.dreampm.role = "LIQUID"
cube.dreampm.material = "newtonian/water"

# The domain about both, and how far apart particles are.
bpy.ops.dreampm.add_domain()
scene.dreampm.spacing = asked.spacing

# Without a window this comes back when the bake is done.
bpy.ops.dreampm.bake()



def painted(thing, name, color):
    look = bpy.data.materials.new(name)
    if bpy.app.version < (5, 0):
        look.use_nodes = True
    look.node_tree.nodes["Principled BSDF"].inputs["Base Color"].default_value = (*color, 1)
    thing.data.materials.append(look)


# A floor, a light, a sky, a camera.
bpy.ops.mesh.primitive_plane_add(size=40)
painted(bpy.context.object, "Slate", (0.09, 0.11, 0.12))
painted(bowl, "Clay", (0.5, 0.16, 0.07))
sun = bpy.data.objects.new("Sun", bpy.data.lights.new("Sun", "SUN"))
sun.data.energy, sun.data.angle, sun.rotation_euler = 4, 0.05, (0.8, 0.1, 0.6)
camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
camera.location, camera.data.lens = (1.6, -2.8, 1.9), 46
camera.rotation_euler = (Vector((0, 0, 0.72)) - camera.location).to_track_quat("-Z", "Y").to_euler()
for thing in (sun, camera):
    scene.collection.objects.link(thing)
scene.camera = camera
scene.world = bpy.data.worlds.new("Sky")
if bpy.app.version < (5, 0):
    scene.world.use_nodes = True
scene.world.node_tree.nodes["Background"].inputs["Color"].default_value = (0.55, 0.7, 0.9, 1)

# Cycles, with motion blur from the velocities of the frames.
scene.render.engine, scene.cycles.samples, scene.cycles.use_denoising = "CYCLES", asked.samples, True
scene.render.use_motion_blur = True
scene.render.resolution_x, scene.render.resolution_y = asked.size, asked.size * 3 // 4
scene.render.filepath = os.path.splitext(os.path.abspath(asked.file))[0] + ".png"
scene.frame_set(asked.frame)
bpy.ops.wm.save_mainfile()
bpy.ops.render.render(write_still=True)

# SPDX-License-Identifier: GPL-3.0-or-later
"""Materials of Blender that results get when they are made; from then on they are the user's."""
import bpy

# sRGB as read by eye, of types and presets; a preset wins.
COLORS = {"elastic": (0.72, 0.05, 0.08), "rubber": (0.05, 0.05, 0.06), "neo_hookean": (0.55, 0.6, 0.65),
          "natural_rubber": (0.45, 0.22, 0.06), "snow": (0.9, 0.93, 0.97), "sand": (0.6, 0.42, 0.2),
          "viscoplastic": (0.2, 0.11, 0.05), "toothpaste": (0.75, 0.9, 0.88), "lava": (0.08, 0.03, 0.02),
          "seed": (0.1, 0.35, 0.6), "honey": (0.85, 0.4, 0.04), "oil": (0.75, 0.6, 0.12), "water": (0.7, 0.88, 1.0)}
CLEAR = {"newtonian": 1.333, "honey": 1.49, "oil": 1.47}


def look_for(name, kind, preset):
    """The material of Blender for one of the simulation."""
    title = f"DreaMPM {name}"
    look = bpy.data.materials.get(title)
    if look:
        return look
    look = bpy.data.materials.new(title)
    if bpy.app.version < (5, 0):  # from then on it always does
        look.use_nodes = True
    color = (*COLORS.get(preset, COLORS.get(kind, (0.6, 0.75, 0.9))), 1)
    look.diffuse_color = color
    shader = next(n for n in look.node_tree.nodes if n.type == "BSDF_PRINCIPLED")
    shader.inputs["Base Color"].default_value = color
    index = CLEAR.get(preset, CLEAR.get(kind))
    if index:
        shader.inputs["Transmission Weight"].default_value = 1
        shader.inputs["Roughness"].default_value = 0
        shader.inputs["IOR"].default_value = index
    else:
        shader.inputs["Roughness"].default_value = 0.8 if kind in ("snow", "sand") else 0.35
    return look


def foam_look():
    """The material of spray, foam and bubbles: white that is not quite opaque."""
    title = "DreaMPM foam"
    look = bpy.data.materials.get(title)
    if look:
        return look
    look = bpy.data.materials.new(title)
    if bpy.app.version < (5, 0):
        look.use_nodes = True
    shader = next(n for n in look.node_tree.nodes if n.type == "BSDF_PRINCIPLED")
    shader.inputs["Base Color"].default_value = look.diffuse_color = (0.9, 0.91, 0.93, 1)
    shader.inputs["Roughness"].default_value = 0.6
    return look


def points_group(own_radii=False):
    """A node group that draws vertices as balls, so that pictures show particles: of one radius, or of those that the
    attribute `radius` has."""
    title = "DreaMPM Foam" if own_radii else "DreaMPM Points"
    group = bpy.data.node_groups.get(title)
    if group:
        return group
    group = bpy.data.node_groups.new(title, "GeometryNodeTree")
    sockets = group.interface
    sockets.new_socket("Geometry", in_out="INPUT", socket_type="NodeSocketGeometry")
    if not own_radii:
        sockets.new_socket("Radius", in_out="INPUT", socket_type="NodeSocketFloat")
    sockets.new_socket("Material", in_out="INPUT", socket_type="NodeSocketMaterial")
    sockets.new_socket("Geometry", in_out="OUTPUT", socket_type="NodeSocketGeometry")
    given, points, dress, out = (group.nodes.new(kind) for kind in (
        "NodeGroupInput", "GeometryNodeMeshToPoints", "GeometryNodeSetMaterial", "NodeGroupOutput"))
    for i, node in enumerate((given, points, dress, out)):
        node.location = (220 * i, 0)
    radius = given.outputs.get("Radius")
    if own_radii:
        attribute = group.nodes.new("GeometryNodeInputNamedAttribute")
        attribute.location = (0, -200)
        attribute.data_type = "FLOAT"
        attribute.inputs["Name"].default_value = "radius"
        radius = attribute.outputs["Attribute"]
    group.links.new(given.outputs["Geometry"], points.inputs["Mesh"])
    group.links.new(radius, points.inputs["Radius"])
    group.links.new(points.outputs[0], dress.inputs["Geometry"])
    group.links.new(given.outputs["Material"], dress.inputs["Material"])
    group.links.new(dress.outputs[0], out.inputs[0])
    return group


def draw_as_points(thing, radius, look):
    _draw(thing, points_group(), Radius=radius, Material=look)


def draw_as_foam(thing, look):
    _draw(thing, points_group(own_radii=True), Material=look)


def _draw(thing, group, **values):
    modifier = thing.modifiers.get("Points") or thing.modifiers.new("Points", "NODES")
    modifier.node_group = group
    identifiers = {i.name: i.identifier for i in group.interface.items_tree if i.in_out == "INPUT"}
    for name, value in values.items():
        modifier[identifiers[name]] = value

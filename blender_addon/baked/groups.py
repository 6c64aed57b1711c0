# SPDX-License-Identifier: GPL-3.0-or-later
"""The nodes of a baked material in framed groups, each at a place of its own.

Nodes are ours by their names, "sardf ...". Each group's function makes what is missing, renews what
is there, and removes what is no longer baked; what the user did to it or built beside it stays.
"""

PREFIX = "sardf "
MADE = "sardf_made"  # custom property of a material: our nodes; one that is missing was deleted
# Left upper corners of the groups, in the node editor's units, and the height of their rows: no
# node is higher (a test measures drawn ones).
PLACES = {
    "Textures": (-440, 400, 330),
    "UV map": (-780, 400, 200),
    "Normal map": (-780, -1060, 330),
    "Brushed metal": (-1180, -1740, 330),
    "Fractions": (-1120, 400, 230),
    "Attributes": (-1420, 400, 230),
    "Masks": (-2180, 400, 330),
    "More textures": (-2560, 400, 330),
    "Exact (OSL)": (-440, 1100, 400),
    "Exact or baked": (-60, 400, 330),
}


def node_name(name):
    return PREFIX + name


class Tree:
    """A material's node tree while our nodes in it are made or renewed."""

    def __init__(self, material):
        self.tree = material.node_tree
        self.name = material.name
        self._material = material
        self._known = set(filter(None, material.get(MADE, "").split("\n")))
        self._wanted = {}

    def node(self, kind, name, group, column=0, row=0, label=""):
        """Our node of that name, made where it never was, in its group; None if the user deleted
        it."""
        self._wanted[name] = True
        node = self.tree.nodes.get(node_name(name))
        if node is not None or name in self._known:
            return node
        x, y, height = PLACES[group]
        node = self.tree.nodes.new(kind)
        node.name, node.label = node_name(name), label or name.replace("_", " ")
        node.location = (x + column, y - height * row)
        node.parent = self._frame(group)
        return node

    def link(self, output, target):
        """Connect what is free; a connection of the user's stays."""
        if output is not None and target is not None and not target.is_linked:
            self.tree.links.new(output, target)

    def shader(self):
        return next((n for n in self.tree.nodes if n.type == "BSDF_PRINCIPLED"), None)

    def finish(self):
        """Remove our nodes that nobody asked for, and frames that hold nothing."""
        for name in self._known - self._wanted.keys():
            node = self.tree.nodes.get(node_name(name))
            if node is not None:
                self.tree.nodes.remove(node)
        self._material[MADE] = "\n".join(self._wanted)
        used = {node.parent for node in self.tree.nodes if node.parent is not None}
        for frame in [n for n in self.tree.nodes if n.type == "FRAME"]:
            if frame not in used and frame.name.startswith(PREFIX):
                self.tree.nodes.remove(frame)

    def _frame(self, group):
        frame = self.tree.nodes.get(node_name(group))
        if frame is None:
            frame = self.tree.nodes.new("NodeFrame")
            frame.name, frame.label = node_name(group), group
            frame.label_size = 20
        return frame


def image(tree, name, group, row, uv, shown, column=0):
    """An image node; `shown`: its image, `uv`: the socket with texture coordinates or None."""
    node = tree.node("ShaderNodeTexImage", name, group, column, row)
    if node is None:
        return None
    node.image = shown
    node.interpolation = "Linear"
    node.extension = "EXTEND"
    tree.link(uv, node.inputs["Vector"])
    return node


def uv_map(tree, layer):
    """The socket of the UV map that was baked on."""
    node = tree.node("ShaderNodeUVMap", "uv map", "UV map", label="baked on")
    if node is None:
        return None
    node.uv_map = layer
    return node.outputs["UV"]


def normal_map(tree, shown, uv, layer):
    """Principled's Normal from a tangent-space map, as far as the node "normal switch" says: 1 on,
    0 off."""
    group = "Normal map"
    source = image(tree, "normal", group, 0, uv, shown)
    switch = tree.node("ShaderNodeValue", "normal switch", group, 0, 1, "normal map: 1 on, 0 off")
    bent = tree.node("ShaderNodeNormalMap", "normal map", group, 340)
    if bent is None:
        return
    if not bent.outputs["Normal"].is_linked and switch is not None:
        switch.outputs[0].default_value = 1.0
    bent.space, bent.uv_map = "TANGENT", layer
    if source is not None:
        tree.link(source.outputs["Color"], bent.inputs["Color"])
    if switch is not None:
        tree.link(switch.outputs[0], bent.inputs["Strength"])
    if tree.shader() is not None:
        tree.link(bent.outputs["Normal"], tree.shader().inputs["Normal"])


def attributes(tree, group, names):
    """A node for each attribute of the mesh's points, to be used in place of a texture."""
    for row, name in enumerate(names):
        node = tree.node("ShaderNodeAttribute", f"attribute {name}", group, 0, row, name)
        if node is not None:
            node.attribute_type, node.attribute_name = "GEOMETRY", name


def masks(tree, images, materials, uv):
    """Each material's fraction as a number at the end of a labelled wire."""
    for row, (name, shown) in enumerate(images.items()):
        source = image(tree, name, "Masks", row, uv, shown)
        split = tree.node("ShaderNodeSeparateColor", f"{name} split", "Masks", 300, row)
        if split is None:
            continue
        if source is not None:
            tree.link(source.outputs["Color"], split.inputs["Color"])
        for place, material in enumerate(materials[3 * row : 3 * row + 3]):
            end = tree.node("NodeReroute", f"mask {material}", "Masks", 520, row, material)
            if end is not None:
                tree.link(split.outputs[place], end.inputs[0])
                if not end.outputs[0].is_linked:
                    end.location.y = PLACES["Masks"][1] - PLACES["Masks"][2] * row - 60 * place - 40


def more_textures(tree, images, uv):
    """Images that no socket of Principled reads."""
    for row, (name, shown) in enumerate(images.items()):
        image(tree, name, "More textures", row, uv, shown)

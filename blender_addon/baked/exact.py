# SPDX-License-Identifier: GPL-3.0-or-later
"""The materials computed where a ray hits, by a shader in the Open Shading Language."""

import bpy

from . import groups

GROUP, CHOICE = "Exact (OSL)", "Exact or baked"
SCRIPT, SWITCH = "exact", "exact switch"
SOURCE = "sardf_osl"  # custom property of a text: the material that it is of


def is_there():
    """Whether this Blender's Cycles was built with OSL."""
    try:
        import _cycles
    except ImportError:
        return False
    return bool(_cycles.with_osl)


def update(tree, shader, sockets):
    """Let Principled read the shader's outputs, as far as the node "exact switch" says: 1 the
    shader, 0 the textures. `shader`: (text, {output: channel}), or None, which ends that.

    `sockets`: {channel: names of Principled's socket, the first that exists}.
    """
    if shader is None:
        _restore(tree, sockets)
        return
    text, outputs = shader
    script = tree.node("ShaderNodeScript", SCRIPT, GROUP)
    switch = tree.node("ShaderNodeValue", SWITCH, GROUP, 300, 0, "1 exact, 0 textures")
    if script is None:
        return
    if switch is not None and not switch.outputs[0].is_linked:
        switch.outputs[0].default_value = 1.0
    script.mode = "INTERNAL"
    script.script = _text(tree, text)
    _compile(script)
    for row, channel in enumerate(sockets):
        output = next((name for name, meaning in outputs.items() if meaning == channel), None)
        if output in script.outputs:
            _mix(
                tree, row, channel, script.outputs[output], switch, _socket(tree, sockets[channel])
            )


def use(scene):
    """Let a Blender scene's Cycles run shaders: on the CPU."""
    scene.cycles.shading_system = True


def _socket(tree, names):
    shader = tree.shader()
    return None if shader is None else next((s for n in names if (s := shader.inputs.get(n))), None)


def _mix(tree, row, channel, exact, switch, target):
    """target = textures where the switch is 0, the shader's output where it is 1."""
    name = f"exact {channel}"
    is_new = groups.node_name(name) not in tree.tree.nodes
    node = tree.node("ShaderNodeMix", name, CHOICE, 0, row)
    texture = tree.tree.nodes.get(groups.node_name(channel))
    if node is None or texture is None or target is None or not is_new:
        return
    if target.is_linked and target.links[0].from_node != texture:
        return  # the user's own
    node.data_type = "RGBA"
    # Of each type of data it has sockets of the same names.
    into = {socket.identifier: socket for socket in node.inputs}
    out = next(s for s in node.outputs if s.identifier == "Result_Color")
    tree.tree.links.new(out, target)
    tree.link(texture.outputs["Color"], into["A_Color"])
    tree.link(exact, into["B_Color"])
    if switch is not None:
        tree.link(switch.outputs[0], into["Factor_Float"])


def _restore(tree, sockets):
    """Connect the textures again where a shader was."""
    for channel, names in sockets.items():
        node = tree.tree.nodes.get(groups.node_name(f"exact {channel}"))
        texture = tree.tree.nodes.get(groups.node_name(channel))
        target = _socket(tree, names)
        if None in (node, texture, target) or not target.is_linked:
            continue
        if target.links[0].from_node == node:
            tree.tree.links.new(texture.outputs["Color"], target)


def _text(tree, content):
    """The text of this material's shader, renewed."""
    name = tree.name
    text = next((t for t in bpy.data.texts if t.get(SOURCE) == name), None)
    if text is None:
        text = bpy.data.texts.new(f"{name}.osl")
        text[SOURCE] = name
    text.clear()
    text.write(content)
    return text


def _compile(script):
    """Give the node the shader's sockets, where Cycles is not the scene's engine and did so."""
    if script.outputs:
        return
    try:
        from cycles import osl

        osl.update_script_node(script, lambda kind, text: print("sardf:", *kind, text))
    except ImportError:  # a Blender without Cycles or its compiler of shaders: nothing can run it
        return

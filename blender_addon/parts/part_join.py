# SPDX-License-Identifier: GPL-3.0-or-later
"""The fields of one scene inside another: every name gets a prefix, so that none meet."""

from . import scene_text

# Texts that are no fields: choices, directions, file names.
WORDS = ("axis", "normal", "path", "blend", "sign", "side", "interpolation", "fingerprint",
         "conflict")  # fmt: skip
FORMULAS = ("formula",)  # texts that are formulas without a leading =


def joined_document(scene, prefix):
    """(fields, parameters, solid) of a scene with `prefix`_ before the names of its own."""
    names = {
        name: f"{prefix}_{name}"
        for name in (*scene.get("parameters", {}), *scene.get("fields", {}))
    }

    def renamed(value, key=""):
        if isinstance(value, dict):
            return {inner: renamed(of, inner) for inner, of in value.items()}
        if isinstance(value, list):
            return [renamed(inner, key) for inner in value]
        if not isinstance(value, str):
            return value
        if value.startswith("=") or key in FORMULAS:
            return scene_text.NAME.sub(lambda m: names.get(m[0], m[0]), value)
        return value if key in WORDS else names.get(value, value)

    fields = {names[name]: renamed(field) for name, field in scene.get("fields", {}).items()}
    parameters = {
        names[name]: renamed(value) for name, value in scene.get("parameters", {}).items()
    }
    solid = renamed(scene["solid"])
    if "blend" in scene:  # it stands for the blends of that scene alone
        solid = {"with_blend": {"field": solid, "blend": renamed(scene["blend"], "blend")}}
    return fields, parameters, solid

# SPDX-License-Identifier: GPL-3.0-or-later
"""Rendering baked objects in each of the looks, one file for each."""

from ..baked import material
from . import render


def render_all(scene, baked, looks, samples, path_of, check=lambda: None):
    """Render `looks` into path_of(look).

    `baked`: [(object, its base colour's image)]; their materials are put back afterwards. `check()`
    is called after each picture and may raise. Raises RuntimeError.
    """
    own = [item.material_slots[0].material for item, _ in baked]
    try:
        for look in looks:
            if look == "shaded":
                render.set_shaded(scene, samples)
                _assign(baked, own)
            else:
                render.set_exact(scene)
                _assign(baked, [_plain(look, image) for _, image in baked])
            render.to_file(scene, path_of(look))
            check()
    finally:
        _assign(baked, own)
        render.set_shaded(scene, samples)


def _plain(look, image):
    return material.build_flat(image) if look == "flat" else material.build_normals()


def _assign(baked, materials):
    for (item, _), each in zip(baked, materials, strict=True):
        item.material_slots[0].material = each

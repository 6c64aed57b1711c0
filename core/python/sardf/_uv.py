"""Whether a mesh that sardf did not make can be baked on, said in sentences."""

import numpy as np

from sardf import _core

WRONG = 0.01  # share of texels or faces above which a map is refused
OFF = 1e-3  # of the bounds' diagonal: how far a vertex may lie off the surface unnoticed


def check_uv_map(scene, mesh, size=2048, sections=True, progress=None):
    """Looks at a mesh's UV map before a bake; a list of sentences about what will look wrong.

    mesh: a Mesh with texture coordinates, in the scene's frame. size: texels along the texture's
    side. Raises Error where more than 1 % of the texels on the mesh lie on two of its triangles or
    more than 1 % of its faces reach out of the image, where no texel lies on it, and where no
    vertex is on the surface (another part's mesh); Cancelled.
    """
    found = mesh.check_uv(size=size, progress=progress)
    if found["texels"] == 0:
        _core._fail(
            "no texel lies on the mesh: its UV map is outside the image or folded to nothing; "
            "unwrap the mesh first"
        )
    warnings = []
    if found["outside"]:
        _say(
            warnings, found["outside"], found["faces"],
            f"{found['outside']} of {found['faces']} faces of the UV map reach out of the image, "
            "where there is no texture",
            "move them into it",
        )  # fmt: skip
    if found["overlapping"]:
        share = 100 * found["overlapping"] / found["texels"]
        _say(
            warnings, found["overlapping"], found["texels"],
            f"{share:.2g} % of the UV map's texels lie on several faces at once, and show the "
            "material of one of them",
            "unwrap the mesh without overlaps",
        )  # fmt: skip
    return warnings + _off_surface(scene, mesh, sections)


def _say(warnings, wrong, of, text, remedy):
    if wrong > WRONG * of:
        _core._fail(f"{text}; {remedy}")
    warnings.append(text)


def _off_surface(scene, mesh, sections):
    low, high = np.array(scene.bounds)
    found = scene.check_surface(mesh, OFF * float(np.linalg.norm(high - low)), sections)
    off, vertices, farthest = found["off"], found["vertices"], found["farthest"]
    if not off:
        return []
    where = f"up to {farthest:.3g} {scene.units} away" if np.isfinite(farthest) else "far away"
    if off == vertices:
        _core._fail(
            f"no vertex of the mesh lies on the part's surface ({where}): is it this part's mesh, "
            "and where the part is?"
        )
    return [
        f"{off} of {vertices} vertices lie off the part's surface, {where}: textures show the "
        "material there"
    ]

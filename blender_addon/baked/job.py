# SPDX-License-Identifier: GPL-3.0-or-later
"""From a scene to the arrays that Blender needs; no bpy here, so that a thread may run it."""

import json
import threading
from dataclasses import dataclass
from pathlib import Path
from typing import Any

CHANNELS = ("base_color", "roughness", "metallic", "emission", "fractions")
NORMAL_MAP = "normal"  # a channel more: the solid's normals in the mesh's tangent space
GRAIN = "grain_direction"  # the attribute that directs metal's reflections unless one is named
CHECKED = 64  # cells along each side where it is looked for what sections leave
MESH_SHARE = 0.4  # of the time, for the progress bar: meshing took 0.2 to 0.6 of it on our scenes


@dataclass(frozen=True)
class Request:
    """What to make: cells along the longest side, texels along a texture's side, cut or whole.

    `path`: the scene file, or with `scene`, the dictionary that one holds, what the scene is known
    by. `tangent`: the attribute along which metal is brushed, "" for GRAIN in a scene that has it.
    """

    path: str
    resolution: int = 128
    size: int = 2048
    sections: bool = True
    channels: tuple = CHANNELS
    tangent: str = ""
    scene: dict | None = None


@dataclass
class Part:
    """The made arrays: `mesh` and `maps` as sardf returns them, fractions (vertices, materials).

    `attributes`: {name: (vertices,) or (vertices, components)}; `tangent`: the one along which
    metal is brushed, or "".
    """

    name: str
    source: str
    scene: Any
    mesh: Any
    maps: dict
    fractions: Any
    attributes: dict
    tangent: str
    whole: bool = False  # the scene's sections were not cut
    given: dict | None = None  # the Request's scene


class NothingLeft(Exception):
    """The scene's sections remove all of it, said in one sentence."""


def name_of(scene, request):
    return scene.title or Path(request.path).stem


def leaves_nothing(scene):
    """Whether a scene's sections leave nothing of it, or nothing as thick as a CHECKED-th of it."""
    if not scene.section_count:
        return False
    lo, hi = scene.bounds
    samples = scene.sample_volume(lo, hi, (CHECKED, CHECKED, CHECKED), colors="none")
    return bool(samples["field"].max() < 0)


def make_part(sardf, request, progress=None):
    """Mesh, bake and evaluate the scene of `request`.

    `progress(share)` is called with the share done in [0, 1] and returns False to cancel; then
    sardf.Cancelled is raised. Raises sardf.Error for what is wrong in the scene, and NothingLeft.
    """

    def between(start, stop):
        if progress is None:
            return None
        return lambda share: progress(start + (stop - start) * share)

    if request.scene is None:
        scene = sardf.load(request.path)
    else:
        scene = sardf.Scene.from_json(json.dumps(request.scene), {}, between(0.0, 0.0))
    tangent = tangent_of(scene, request.tangent)
    try:
        mesh = scene.mesh(
            resolution=request.resolution,
            sections=request.sections,
            size=request.size,
            progress=between(0.0, MESH_SHARE),
        )
    except sardf.Cancelled:
        raise
    except sardf.Error:
        if request.sections and leaves_nothing(scene):
            raise NothingLeft(
                f"the sections leave nothing of '{name_of(scene, request)}'"
            ) from None
        raise
    maps = scene.bake(
        mesh,
        size=request.size,
        channels=request.channels,
        sections=request.sections,
        progress=between(MESH_SHARE, 1.0),
    )
    vertices = mesh.vertices
    attributes = attributes_at(scene, vertices)
    return Part(
        name=name_of(scene, request),
        source=str(request.path),
        scene=scene,
        mesh=mesh,
        maps=maps,
        fractions=scene.fractions(vertices),
        attributes=attributes,
        tangent=tangent,
        whole=not request.sections,
        given=request.scene,
    )


def attributes_at(scene, points):
    """{name: (points,) or (points, components)}; components that have names stand alone, as
    stress_xx does."""
    attributes = {}
    for name, evaluate in scene.attributes.items():
        values = evaluate(points)
        if isinstance(values, dict):
            attributes |= {f"{name}_{component}": of for component, of in values.items()}
        else:
            attributes[name] = values
    return attributes


def tangent_of(scene, name):
    """The checked name of the attribute along which metal is brushed, or "" for none.

    A name must be that of an attribute with 3 components: raises sardf.Error. "" stands for GRAIN
    where the scene has such a vector of that name.
    """
    # sardf is found by core.load(), not when Blender reads this file.
    from sardf._words import components_of, vector_attribute

    if name:
        vector_attribute(scene, name, (3,), "metal is brushed along")
        return name
    known = scene.attributes
    return GRAIN if GRAIN in known and components_of(known[GRAIN]) == 3 else ""


class Job:
    """make_part in a worker thread that the user interface polls.

    `share` is the progress, `running` tells whether the thread is at work; afterwards exactly one
    of `part`, `error` and `cancelled` is set.
    """

    def __init__(self, sardf, request):
        self.share = 0.0
        self.part = None
        self.error = None
        self.cancelled = False
        self._stop = threading.Event()
        self._thread = threading.Thread(target=self._run, args=(sardf, request), daemon=True)
        self._thread.start()

    @property
    def running(self):
        return self._thread.is_alive()

    def cancel(self):
        """Ask the thread to stop; it does so within 0.1 s."""
        self._stop.set()

    def _run(self, sardf, request):
        try:
            part = make_part(sardf, request, self._progress)
        except sardf.Cancelled:
            self.cancelled = True
        except Exception as error:  # shown by the operator, which polls: nothing is swallowed
            self.error = error
        else:
            self.part = part

    def _progress(self, share):
        self.share = share
        return not self._stop.is_set()

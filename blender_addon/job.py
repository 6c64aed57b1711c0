# SPDX-License-Identifier: GPL-3.0-or-later
"""From a scene file to the arrays that Blender needs; no bpy here, so that a thread may run it."""

import difflib
import threading
from dataclasses import dataclass
from pathlib import Path
from typing import Any

CHANNELS = ("base_color", "roughness", "metallic", "emission", "fractions")
GRAIN = "grain_direction"  # the attribute that directs metal's reflections unless one is named
DIRECTION = "a vector of 3 components"
MESH_SHARE = 0.4  # of the time, for the progress bar: meshing took 0.2 to 0.6 of it on our scenes


@dataclass(frozen=True)
class Request:
    """What to make: cells along the longest side, texels along a texture's side, cut or whole.

    `tangent`: the attribute along which metal is brushed, "" for GRAIN in a scene that has it.
    """

    path: str
    resolution: int = 128
    size: int = 2048
    sections: bool = True
    channels: tuple = CHANNELS
    tangent: str = ""


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


def make_part(sardf, request, progress=None):
    """Mesh, bake and evaluate the scene file of `request`.

    `progress(share)` is called with the share done in [0, 1] and returns False to cancel; then
    sardf.Cancelled is raised. Raises sardf.Error for what is wrong in the file.
    """

    def between(start, stop):
        if progress is None:
            return None
        return lambda share: progress(start + (stop - start) * share)

    scene = sardf.load(request.path)
    tangent = tangent_of(sardf, scene, request.tangent)
    mesh = scene.mesh(
        resolution=request.resolution,
        sections=request.sections,
        size=request.size,
        progress=between(0.0, MESH_SHARE),
    )
    maps = scene.bake(
        mesh,
        size=request.size,
        channels=request.channels,
        sections=request.sections,
        progress=between(MESH_SHARE, 1.0),
    )
    name = scene.title or Path(request.path).stem
    vertices = mesh.vertices
    attributes = attributes_at(scene, vertices)
    return Part(
        name, str(request.path), scene, mesh, maps, scene.fractions(vertices), attributes, tangent
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


def tangent_of(sardf, scene, name):
    """The checked name of the attribute along which metal is brushed, or "" for none.

    A name must be that of an attribute with 3 components: raises sardf.Error. "" stands for GRAIN
    where the scene has such a vector of that name.
    """
    known = scene.attributes
    if not name:
        return GRAIN if GRAIN in known and kind_of(known[GRAIN]) == DIRECTION else ""
    if name not in known:
        accepted = f"accepted are {', '.join(known)}" if known else "the scene has none"
        near = difflib.get_close_matches(name, known, n=1, cutoff=0.5)
        hint = f"; did you mean '{near[0]}'?" if near else ""
        raise sardf.Error(f"there is no attribute '{name}'; {accepted}{hint}")
    found = kind_of(known[name])
    if found != DIRECTION:
        raise sardf.Error(
            f"the attribute '{name}' is {found}; metal is brushed along a vector of 3 components"
        )
    return name


def kind_of(evaluate):
    """What an attribute gives at a point, in words: DIRECTION is what metal is brushed along."""
    values = evaluate([(0.0, 0.0, 0.0)])
    if isinstance(values, dict):
        return f"made of the components {', '.join(values)}"
    return "a number" if values.ndim == 1 else f"a vector of {values.shape[1]} components"


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

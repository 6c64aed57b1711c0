# SPDX-License-Identifier: GPL-3.0-or-later
"""From a scene to the arrays that Blender needs; no bpy here, so that a thread may run it."""

import json
import threading
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from ..progress import between
from . import channels as channel_arrays
from . import store
from .channels import attributes_at, tangent_of

CHANNELS = ("base_color", "roughness", "metallic", "emission", "fractions")
NORMAL_MAP = "normal"  # a channel more: the solid's normals in the mesh's tangent space
CHECKED = 64  # cells along each side where it is looked for what sections leave
SHARES = (0.4, 0.4, 0.2)  # of the time for mesh, textures and files, where nothing was measured
ATLAS, SMART, GIVEN = "atlas", "smart", "given"  # where texture coordinates come from
POLL_SECONDS = 0.02


@dataclass(frozen=True)
class GivenMesh:
    """A mesh with texture coordinates that is baked as it is: arrays as sardf.Mesh has them, in
    the scene's frame, and what it is called."""

    name: str
    vertices: Any
    faces: Any
    normals: Any
    uv: Any


@dataclass(frozen=True)
class Request:
    """What to make: cells along the longest side, texels along a texture's side, cut or whole.

    `path`: the scene file, or with `scene`, the dictionary that one holds, what the scene is known
    by. `tangent`: the attribute along which metal is brushed, "" for GRAIN in a scene that has it.
    `channels`: names as sardf.Scene.bake takes them. `uv`: ATLAS, SMART or GIVEN, which `given`
    then is. `store`: where textures are written; None: they stay arrays. `shares`: of the time, as
    SHARES. `osl`: also make a shader of the channels.
    """

    path: str
    resolution: int = 128
    size: int = 2048
    sections: bool = True
    channels: tuple = CHANNELS
    tangent: str = ""
    scene: dict | None = None
    uv: str = ATLAS
    given: GivenMesh | None = None
    store: Any = None
    shares: tuple = SHARES
    osl: bool = False


@dataclass
class Part:
    """The made arrays: `mesh` as sardf returns it, fractions (vertices, materials).

    `maps`: {image: (size, size, 1 to 3) array}, or None in place of the array where it was written
    to `store`. `glows`: whether anything emits light. `attributes`: {name: (vertices,) or
    (vertices, components)}; `tangent`: the one along which metal is brushed, or "". `osl`: the text
    of a shader and {its output: what it is}, or None. `warnings`: sentences about what is made
    otherwise than asked for. `given`: the mesh was; `whole`: the scene's sections were not cut;
    `document`: the Request's scene.
    """

    name: str
    source: str
    scene: Any
    mesh: Any
    maps: dict
    fractions: Any
    attributes: dict
    tangent: str
    glows: bool
    texels_per_unit: float
    given: bool = False
    whole: bool = False
    document: dict | None = None
    store: Any = None
    osl: tuple | None = None
    warnings: list = field(default_factory=list)


class NothingLeft(Exception):
    """The scene's sections remove all of it, said in one sentence."""


def leaves_nothing(scene):
    """Whether a scene's sections leave nothing of it, or nothing as thick as a CHECKED-th of it."""
    if not scene.section_count:
        return False
    lo, hi = scene.bounds
    samples = scene.sample_volume(lo, hi, (CHECKED, CHECKED, CHECKED), colors="none")
    return bool(samples["field"].max() < 0)


def make_part(sardf, request, progress=None, unwrap=None):
    """Mesh, bake and evaluate the scene of `request`, and write its textures.

    `progress(share)` is called with the share done in [0, 1] and returns False to cancel; then
    sardf.Cancelled is raised, and nothing stays in `store`. `unwrap(mesh)` gives (4 faces, 2)
    texture coordinates, for SMART. Raises sardf.Error for what is wrong in the scene or with a UV
    map, StoreError, and NothingLeft.
    """
    try:
        return _make_part(sardf, request, progress or (lambda share: True), unwrap)
    except BaseException as error:
        if request.store is not None:
            request.store.discard()
        if isinstance(error, OSError):
            place = request.store.folder if request.store is not None else request.path
            raise store.failure(place, error) from error
        raise


def _make_part(sardf, request, progress, unwrap):
    whole = sum(request.shares) or 1.0
    ends = [sum(request.shares[: k + 1]) / whole for k in range(3)]
    scene, channels, warnings = _scene_of(sardf, request, between(progress, 0.0, 0.0))
    tangent = tangent_of(scene, request.tangent)
    shader = None
    if request.osl:
        shader = _shader_of(sardf, scene, channels, warnings)
    if request.store is not None:
        request.store.probe(channel_arrays.image_names(scene.image_components(channels)))
    mesh = _mesh_of(sardf, request, scene, unwrap, between(progress, 0.0, ends[0]))
    if request.uv != ATLAS:
        warnings += sardf.check_uv_map(
            scene, mesh, request.size, request.sections, between(progress, ends[0], ends[0])
        )
    maps = channel_arrays.split(scene.bake(
        mesh, size=request.size, channels=channels, sections=request.sections,
        progress=between(progress, ends[0], ends[1]),
    ))  # fmt: skip
    glows = bool(np.any(maps["emission"] > 0)) if "emission" in maps else False
    if request.store is not None:
        request.store.open()  # not before: what is stopped early has nothing to take back
        channel_arrays.write(sardf, request.store, maps, between(progress, ends[1], 1.0))
    vertices = mesh.vertices
    return Part(
        name=_name_of(scene, request),
        source=str(request.path),
        scene=scene,
        mesh=mesh,
        maps=maps,
        fractions=scene.fractions(vertices),
        attributes=attributes_at(scene, vertices),
        tangent=tangent,
        glows=glows,
        texels_per_unit=sardf.texels_per_unit(mesh, request.size),
        given=request.uv == GIVEN,
        whole=not request.sections,
        document=request.scene,
        store=request.store,
        osl=shader,
        warnings=warnings,
    )


def _name_of(scene, request):
    return scene.title or Path(request.path).stem


def _scene_of(sardf, request, progress):
    """The scene, the names of `channels` that it has, and a warning for the others."""
    if request.scene is None:
        scene = sardf.load(request.path, progress)
    else:
        scene = sardf.Scene.from_json(json.dumps(request.scene), {}, progress)
    known = scene.channels()
    channels = [name for name in request.channels if name in known]
    missing = [name for name in request.channels if name not in known]
    if not channels:
        scene.bake(sardf.Mesh(), channels=missing or [""])  # says which there are
    warnings = [f"left out: {', '.join(missing)}, of which this scene has nothing"]
    return scene, channels, warnings if missing else []


def _shader_of(sardf, scene, channels, warnings):
    """(text, outputs) of an OSL shader; None, and a warning, where something has no formula."""
    try:
        return scene.osl([name for name in channels if name != NORMAL_MAP])
    except sardf.Error as error:
        warnings.append(f"no exact shading: {error}")
        return None


def _mesh_of(sardf, request, scene, unwrap, progress):
    if request.uv == GIVEN:
        mesh = sardf.Mesh()
        for name in ("vertices", "faces", "normals", "uv"):
            setattr(mesh, name, getattr(request.given, name))
        return mesh
    size = request.size if request.uv == ATLAS else 0  # 0: without texture coordinates
    try:
        mesh = scene.mesh(
            resolution=request.resolution, sections=request.sections, size=size, progress=progress
        )
    except sardf.Error:
        if request.sections and leaves_nothing(scene):
            name = _name_of(scene, request)
            raise NothingLeft(f"the sections leave nothing of '{name}'") from None
        raise
    if request.uv == SMART:
        mesh.uv = unwrap(mesh)
    return mesh


class Job:
    """make_part in a worker thread that the user interface polls.

    `share` is the progress, `running` tells whether the thread is at work; afterwards exactly one
    of `part`, `error` and `cancelled` is set. `to_unwrap` is the mesh that waits for `go_on` with
    its texture coordinates, or None.
    """

    def __init__(self, sardf, request):
        self.share = 0.0
        self.part = None
        self.error = None
        self.cancelled = False
        self.to_unwrap = None
        self._uv = None
        self._cancelled = sardf.Cancelled
        self._ending = threading.Lock()
        self._stop = threading.Event()
        self._answered = threading.Event()
        self._thread = threading.Thread(target=self._run, args=(sardf, request), daemon=True)
        self._thread.start()

    @property
    def running(self):
        return self._thread.is_alive()

    def cancel(self):
        """Ask the thread to stop; it does so within 0.1 s. What it made is dropped."""
        with self._ending:
            self._stop.set()
            if self.part is not None and self.part.store is not None:
                self.part.store.discard()

    def join(self, limit):
        """Wait until the thread ends, `limit` seconds at most."""
        self._thread.join(limit)

    def go_on(self, uv):
        """Give the texture coordinates of `to_unwrap`."""
        self.to_unwrap, self._uv = None, uv
        self._answered.set()

    def _run(self, sardf, request):
        try:
            part = make_part(sardf, request, self._progress, self._unwrap)
        except sardf.Cancelled:
            self.cancelled = True
        except Exception as error:  # shown by the operator, which polls: nothing is swallowed
            self.error = error
        else:
            with self._ending:
                if not self._stop.is_set():
                    self.part = part
                    return
            self.cancelled = True  # when nothing was left to stop
            if part.store is not None:
                part.store.discard()

    def _progress(self, share):
        self.share = share
        return not self._stop.is_set()

    def _unwrap(self, mesh):
        self.to_unwrap = mesh
        while not self._answered.wait(POLL_SECONDS):
            if self._stop.is_set():
                raise self._cancelled
        return self._uv

"""What a bake will take, from short runs of mesher and baker: seconds, memory, texels per unit."""

import math
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from sardf import _core
from sardf._exr import write_exr

CELLS = (16, 40)  # along the longest side, of the two meshes that are made
GROWS = 1 / 3  # of the second one's time, at least, grows with the cells
TEXELS = (128, 512)  # along a side of the two textures that are baked of the second one
ATLAS = 1024  # along a side of the texture that atlases are made for
# Bytes, as measured (tests/python/test_cost.py measures them again).
PER_FACE = 900  # of a mesh while its atlas is made
PER_BAKED_FACE = 700  # of a mesh with its texture coordinates, sorted into texels
PER_TEXEL = 1  # whether it has a value
FLOAT = 4
ATLAS_USED = 0.7  # share of the image that charts cover


@dataclass(frozen=True)
class BakeCost:
    """Of one bake: `seconds` in all and for mesh, textures and their files; `bytes`, the most
    memory that it takes at once, besides what the process holds; `faces` of the mesh;
    `texels_per_unit`, the root of texels per square scene unit."""

    seconds: float
    mesh_seconds: float
    bake_seconds: float
    store_seconds: float
    bytes: int
    faces: int
    texels_per_unit: float


@dataclass(frozen=True)
class BakeSample:
    """What short runs took, and what was seen of the part; from measure_bake.

    mesh_seconds: of meshes of CELLS; faces: of the second one; area (square scene units): of it;
    texel_seconds: for one texel on the part, with all channels; components: numbers that a texel
    has in all images together; store_seconds: to write one number.
    """

    mesh_seconds: tuple
    atlas_seconds: tuple
    faces: int
    area: float
    texel_seconds: float
    components: int
    store_seconds: float

    def cost(self, resolution, size, atlas=True, faces=None, texels_per_unit=None):
        """The BakeCost for a mesh of `resolution` cells along the longest side and textures of
        size² texels.

        atlas: whether our own atlas is made; faces: of a mesh that is there already, which costs
        no time; texels_per_unit: of its UV map, where it is known.
        """
        made = faces is None
        if made:
            faces = self.faces * (resolution / CELLS[1]) ** 2
        mesh_seconds = _at(self.mesh_seconds, resolution) if made else 0.0
        if atlas and made:
            mesh_seconds += _at(self.atlas_seconds, resolution)
        texels = size * size
        if texels_per_unit is None:
            texels_per_unit = math.sqrt(ATLAS_USED * texels / self.area)
        on_part = min(texels, texels_per_unit**2 * self.area)
        bake_seconds = self.texel_seconds * on_part
        store_seconds = self.store_seconds * texels * self.components
        images = texels * (FLOAT * self.components + PER_TEXEL) + PER_BAKED_FACE * faces
        return BakeCost(
            seconds=mesh_seconds + bake_seconds + store_seconds,
            mesh_seconds=mesh_seconds,
            bake_seconds=bake_seconds,
            store_seconds=store_seconds,
            bytes=round(max(images, PER_FACE * faces if atlas and made else 0)),
            faces=round(faces),
            texels_per_unit=texels_per_unit,
        )


def measure_bake(scene, channels=("base_color", "fractions"), sections=True, progress=None):
    """Makes two coarse meshes and a small texture of the scene and says how long that took: a
    BakeSample. Takes a fraction of a second for most scenes.

    channels: as Scene.bake takes them. progress(share) may return False to cancel, which raises
    Cancelled. Raises Error.
    """
    tell = progress or (lambda share: True)
    times, atlas_times = [], []
    for place, cells in enumerate(CELLS):
        part = _between(tell, 0.4 * place, 0.4 * (place + 1))
        begun = time.perf_counter()
        scene.mesh(resolution=cells, sections=sections, size=0, progress=part)
        middle = time.perf_counter()
        mesh = scene.mesh(resolution=cells, sections=sections, size=ATLAS, progress=part)
        times.append(middle - begun)
        atlas_times.append(max(0.0, time.perf_counter() - middle - times[-1]))
    area = _area(mesh)
    seconds, maps = [], {}
    for size in TEXELS:
        begun = time.perf_counter()
        maps = scene.bake(mesh, size=size, channels=list(channels), sections=sections,
                          progress=_between(tell, 0.8, 0.9))  # fmt: skip
        seconds.append(time.perf_counter() - begun)
    on_part = [_core.texels_per_unit(mesh, size) ** 2 * area for size in TEXELS]
    return BakeSample(
        mesh_seconds=tuple(times),
        atlas_seconds=tuple(atlas_times),
        faces=len(mesh.faces),
        area=area,
        texel_seconds=max(0.0, seconds[1] - seconds[0]) / max(on_part[1] - on_part[0], 1.0),
        components=sum(array.shape[2] for array in maps.values()),
        store_seconds=_store_seconds(next(iter(maps.values()))) if maps else 0.0,
    )


def _store_seconds(array):
    """For each number of an array written to a file."""
    array = array[..., :3]
    with tempfile.TemporaryDirectory(prefix="sardf-") as folder:
        seconds = []
        for rows in (len(array) // 8, len(array)):  # what a file costs, however small, is taken off
            begun = time.perf_counter()
            write_exr(Path(folder) / "sample.exr", array[:rows])
            seconds.append(time.perf_counter() - begun)
    return max(0.0, seconds[1] - seconds[0]) / (array.size * 7 / 8)


def _between(progress, start, stop):
    return lambda share: progress(start + (stop - start) * share)


def _at(seconds, resolution):
    """A part that is always there, and one that grows with the surface's cells."""
    first, second = (cells**2 for cells in CELLS)
    # Where cells are larger than the part's walls, edges meet in them and the first takes long.
    per_cell = max(GROWS * seconds[1] / second, (seconds[1] - seconds[0]) / (second - first))
    return max(0.0, seconds[1] - per_cell * second) + per_cell * resolution**2


def _area(mesh):
    corner = mesh.vertices[mesh.faces]
    first, second = (corner[:, k] - corner[:, 0] for k in (1, 2))
    third = corner[:, 3] - corner[:, 0]
    twice = np.linalg.norm(np.cross(first, second), axis=1)
    return 0.5 * float((twice + np.linalg.norm(np.cross(second, third), axis=1)).sum())

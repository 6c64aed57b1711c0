"""sardf models a solid together with what it is made of, by distances.

    import sardf
    part = sardf.box(size=(20, 12, 8)) - sardf.cylinder(radius=3)
    part([(0, 0, 0), (9, 0, 0)])          # positive inside, negative outside

Constructors (`sardf.box`, `sardf.union`, ...), blends (`sardf.Sardf`, ...) and the words of scene
files are one and the same; `docs/operations.md` lists them.
"""

from sardf import _core
from sardf._core import (
    Blend,
    Cancelled,
    Error,
    Field,
    Mesh,
    __version__,
    compare_pictures,
    formula,
    is_color,
    load,
    povray_stage,
    schema,
    texels_per_unit,
    x,
    y,
    z,
)
from sardf._cost import measure_bake
from sardf._exr import write_exr
from sardf._render import render
from sardf._scene import Scene, blend
from sardf._uv import check_uv_map

for _name in (*_core._constructors, *_core._blends.values()):
    globals()[_name] = getattr(_core, _name)

__all__ = [
    "Blend",
    "Cancelled",
    "Error",
    "Field",
    "Mesh",
    "Scene",
    "__version__",
    "blend",
    "compare_pictures",
    "check_uv_map",
    "formula",
    "is_color",
    "load",
    "povray_stage",
    "measure_bake",
    "render",
    "schema",
    "texels_per_unit",
    "write_exr",
    "x",
    "y",
    "z",
    *_core._constructors,
    *_core._blends.values(),
]

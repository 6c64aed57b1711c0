"""Iso-surfaces through the core's mesher, and pictures of them through POV-Ray."""

import json
import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np

import sardf
from sardf._command import Failure
from sardf._words import fail, number
from sardf.plot.numbers import brief, point
from sardf.plot.quantities import Quantity, material_colors, quantities
from sardf.plot.sections import table

OWN_NAME = "plotted_surface"


@dataclass
class Surface:
    """The surface {field = level}.

    vertices: (V, 3) in scene units; faces: (F, 4), a triangle repeats its last index; normals:
        (F, 3), outwards, the mean of those at each face's corners.
    values: (V,) of the quantity that colours it, or None where base colours do.
    colors: (V, 3), linear base colours. fractions: (V, materials).
    """

    name: str
    scene: object
    quantity: Quantity
    vertices: np.ndarray
    faces: np.ndarray
    normals: np.ndarray
    values: np.ndarray | None
    colors: np.ndarray
    fractions: np.ndarray

    def table(self) -> tuple[list[str], np.ndarray]:
        """Names of columns, and for each vertex x, y, z and the value or the fractions."""
        if self.values is not None:
            return table(self.vertices, {self.quantity.name: self.values})
        materials = self.scene.materials
        columns = {name: self.fractions[:, i] for i, name in enumerate(materials)}
        return table(self.vertices, columns)


def surfaces(
    scene, chosen=None, *, level=0.0, resolution=128, progress=None, **choices
) -> list[Surface]:
    """One surface for each quantity, through the core's mesher.

    Of a field it is that field's surface in the base colours; of a fraction, an attribute, a
    gradient's length or an error it is the solid's surface, coloured by it. The scene's sections
    cut it open.
    chosen, choices: as for section(). level: the field's value on the surface: positive inside.
    resolution: cells along the longest side, 2 or more.
    progress(share) may return False to cancel, which raises Cancelled.
    Raises Error where the field is unbounded or does not reach the level.
    """
    if not resolution >= 2:
        fail(f"the resolution is {resolution}; at least 2 cells are accepted")
    level = number(level, "level")
    chosen = quantities(scene, **choices) if chosen is None else chosen
    return [_surface(quantity, level, int(resolution), progress) for quantity in chosen]


def _surface(quantity: Quantity, level: float, resolution: int, progress) -> Surface:
    source = shifted(quantity, level)
    mesh = source.mesh(resolution=resolution, size=0, progress=progress)
    vertices = np.array(mesh.vertices)
    if not len(vertices):
        fail(f"there is no surface of {quantity.name} at the level {brief(level)}")
    fractions = quantity.scene.fractions(vertices)
    plain = quantity.kind in ("field", "colors")
    return Surface(
        surface_name(quantity, level), quantity.scene, quantity, vertices, np.array(mesh.faces),
        mesh.normals.reshape(-1, 4, 3).mean(axis=1), None if plain else quantity.values(vertices),
        fractions @ material_colors(quantity.scene), fractions,
    )  # fmt: skip


def surface_name(quantity: Quantity, level: float) -> str:
    return f"{quantity.name}, level {brief(level)}" if level else quantity.name


def shifted(quantity: Quantity, level: float, view=None):
    """The scene whose solid is where the quantity's field is at least `level`; of quantities that
    are no fields, where the solid's is. view: (3,), from the object towards the camera."""
    scene = quantity.scene
    field = quantity.field if quantity.kind == "field" else scene.solid
    whole = quantity.kind != "field" or quantity.name.split(",")[0] == "solid"
    if whole and not level and view is None:
        return scene
    document = json.loads(scene.to_json())
    if view is not None:
        document["view"] = {"direction": [float(value) for value in view]}
    extra = {}
    if not whole or level:
        for stated_of_the_solid in ("bounds", "lipschitz"):
            document.pop(stated_of_the_solid, None)
        extra[OWN_NAME] = sardf.offset(field, -level) if level else field
        document["solid"] = OWN_NAME
    try:
        return sardf.Scene.from_json(json.dumps(document), extra)
    except sardf.Error as error:
        return fail(f"{surface_name(quantity, level)} has no surface: {error.message}")


def view_of(scene, view=None) -> np.ndarray:
    """The unit vector (3,) from the object towards the camera: the given one or the scene's."""
    if view is None:
        return np.array(scene.camera()["matrix_world"], float).reshape(4, 4)[:3, 2]
    view = point(view, "view")
    if not np.linalg.norm(view) > 0:
        fail('the view is (0, 0, 0); a direction towards the camera is accepted, as in "1,-2,1"')
    return view / np.linalg.norm(view)


def picture(
    quantity: Quantity, level=0.0, view=None, width=640, height=480, progress=None
) -> np.ndarray:
    """A picture (height, width, 3) of the field's surface, sRGB from 0 to 1, by POV-Ray.

    view: (3,), from the object towards the camera; None for the scene's. Raises Error for a
    quantity that is no field, Failure where POV-Ray is missing or fails.
    """
    import matplotlib.image

    level = number(level, "level")
    if quantity.kind not in ("field", "colors"):
        fail(f"POV-Ray draws surfaces of fields in their base colours, and {quantity.name} is none;"
             " through the core is accepted")  # fmt: skip
    scene = shifted(quantity, level, None if view is None else view_of(quantity.scene, view))
    with tempfile.TemporaryDirectory() as folder:
        image = Path(folder) / "surface.png"
        try:
            scene.povray(
                str(Path(folder) / "surface.pov"), render=str(image), width=width, height=height,
                progress=progress,
            )  # fmt: skip
        except sardf.Error as error:
            raise Failure(str(error)) from None
        return matplotlib.image.imread(image)[..., :3]

"""What can be plotted: fields, fractions, attributes and mixed colours, as functions of points."""

import json
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

import sardf
from sardf._words import choose, components_of, fail, variants
from sardf.plot.colors import linear_from

SHOWN = ("value", "gradient", "error")


@dataclass(frozen=True)
class Quantity:
    """A function on the scene, and how it is to be read.

    name: the panel's title and the column of a table.
    kind: "field", "gradient", "error", "fraction", "attribute" or "colors".
    label: what a colour bar says, with the unit.
    at: points (N, 3) in scene units -> (N,), or (N, 3) linear colours for the kind "colors".
    scale: quantities of the same scale share their colours' limits.
    scene: the scene it comes from, with its blend.
    field: the Field that it plots or whose gradient or error it plots; None for the rest.
    """

    name: str
    kind: str
    label: str
    at: Callable[[np.ndarray], np.ndarray]
    scale: tuple
    scene: object
    field: object = None

    def values(self, points) -> np.ndarray:
        """Values at points (..., 3): (...), or (..., 3) for colours; NaN where not finite."""
        points = np.asarray(points, float)
        with np.errstate(all="ignore"):
            values = np.asarray(self.at(np.ascontiguousarray(points.reshape(-1, 3))), float)
        values = np.where(np.isfinite(values), values, np.nan)
        return values.reshape(points.shape[:-1] + values.shape[1:])

    @property
    def of_material(self) -> bool:
        """Whether it belongs to the material, which is only inside the solid."""
        return self.kind in ("fraction", "attribute", "colors")


@dataclass
class Variant:
    """A scene with one blend, as the source of quantities."""

    title: str
    scene: object
    fields: dict = field(init=False)

    def __post_init__(self):
        self.fields = self.scene.fields

    def named(self, name: str) -> str:
        return ", ".join(filter(None, (name, self.title)))

    def field_of(self, text):
        """The Field of a name, "solid", a formula "=..." or a Field."""
        if isinstance(text, sardf.Field):
            return text
        if text.startswith("="):
            return sardf.formula(text[1:], **{"solid": self.scene.solid, **self.fields})
        return choose("field", text, {"solid": self.scene.solid, **self.fields})

    def quantity_of_field(self, text, show: str) -> Quantity:
        source, scene = self.field_of(text), self.scene
        name = text if isinstance(text, str) else "field"
        unit = f" ({scene.units})" if source.is_distance else ""
        if show == "gradient":
            slope = _slope(source)
            label = "length of the gradient"
            return Quantity(self.named(f"|∇ {name}|"), show, label, slope, (show,), scene, source)
        if show == "error":
            error = sardf.blend_error(source)
            label = f"error against min/max{unit}"
            return Quantity(
                self.named(f"error of {name}"), show, label, error, (show,), scene, source
            )
        label = f"distance{unit}" if source.is_distance else name
        return Quantity(self.named(name), "field", label, source, ("field",), scene, source)

    def quantity_of_fraction(self, material: str) -> Quantity:
        scene = self.scene
        column = scene.materials.index(choose("material", material, scene.materials))
        return Quantity(
            self.named(material), "fraction", "volume fraction",
            lambda points: scene.fractions(points)[:, column], ("fraction",), scene,
        )  # fmt: skip

    def quantities_of_attribute(self, name: str) -> list[Quantity]:
        """One quantity for a number, one for each component of a vector."""
        evaluate = choose("attribute", name, self.scene.attributes)
        components = components_of(evaluate)
        label = name + unit_of(self.scene, name)
        if isinstance(components, list):
            return [
                Quantity(
                    self.named(f"{name}_{component}"), "attribute", label,
                    lambda points, component=component: evaluate(points)[component],
                    ("attribute", name), self.scene,
                )
                for component in components
            ]  # fmt: skip
        if components == 1:
            return [
                Quantity(
                    self.named(name), "attribute", label, evaluate, ("attribute", name), self.scene
                )
            ]
        return [
            Quantity(
                self.named(f"{name}_{'xyzw'[i % 4]}"), "attribute", label,
                lambda points, i=i: evaluate(points)[:, i], ("attribute", name), self.scene,
            )
            for i in range(components)
        ]  # fmt: skip

    def colors(self) -> Quantity:
        scene, table = self.scene, material_colors(self.scene)
        return Quantity(
            self.named("materials"), "colors", "base colour",
            lambda points: scene.fractions(points) @ table, ("colors",), scene,
        )  # fmt: skip


def quantities(
    scene, fields=(), fractions=(), attributes=(), materials=False, blends=(), show="value"
) -> list[Quantity]:
    """What is to be plotted, in order: one for each choice and, within it, for each blend.

    fields: names of fields, "solid", formulas over them that begin with "=", or Fields.
    fractions, attributes: names; a vector attribute gives its components.
    materials: also the base colours mixed by the fractions.
    blends: "sardf=0.5", "min_max", ...: the scene with all its booleans joined that way; "scene"
        for the scene as it is.
    show: of fields the "value", the "gradient" (its length) or the "error" (the field minus the
        same tree with min and max, in scene units).
    The solid alone where nothing is chosen. Raises Error for a name that does not exist.
    """
    choose("view of a field", show, SHOWN)
    if not (fields or fractions or attributes or materials):
        fields = ("solid",)
    if show != "value" and not fields:
        fail(f"the {show} is that of a field; name one")
    sources = [Variant(*variant) for variant in variants(scene, blends)]
    made = []
    for name in fields:
        made.append([source.quantity_of_field(name, show) for source in sources])
    for name in fractions:
        made.append([source.quantity_of_fraction(name) for source in sources])
    for name in attributes:
        columns = [source.quantities_of_attribute(name) for source in sources]
        made += [list(row) for row in zip(*columns, strict=True)]
    if materials:
        made.append([source.colors() for source in sources])
    return _with_names_apart([quantity for row in made for quantity in row])


def material_colors(scene) -> np.ndarray:
    """Linear base colours (materials, 3), in the order of scene.materials."""
    written = json.loads(scene.to_json()).get("materials", {})
    return np.array([linear_from(written.get(name, {}).get("color")) for name in scene.materials])


def unit_of(scene, attribute: str) -> str:
    """What follows an attribute's name in a label: its unit in brackets where it has one."""
    written = json.loads(scene.to_json())["attributes"][attribute]
    unit = written.get("unit", "") if isinstance(written, dict) else ""
    return f" ({unit})" if unit else ""


def _slope(source) -> Callable:
    return lambda points: np.linalg.norm(source.gradient(points), axis=1)


def _with_names_apart(made: list[Quantity]) -> list[Quantity]:
    """The quantities without repetitions, so that names can be columns."""
    names = [quantity.name for quantity in made]
    for name in names:
        if names.count(name) > 1:
            fail(f"'{name}' is asked for twice")
    return made

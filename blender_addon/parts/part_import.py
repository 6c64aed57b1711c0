# SPDX-License-Identifier: GPL-3.0-or-later
"""A scene file as a part: objects for what Blender has a counterpart of, text for the rest."""

import json
from pathlib import Path

import bpy
from mathutils import Color, Matrix

from . import part_objects, part_scene, part_section_objects, scene_text
from .import_fractions import read_fractions
from .import_numbers import NotANumber, Numbers
from .import_shapes import shape_of
from .part_error import PartError

BOOLEANS = ("union", "intersection", "difference")


def import_scene(sardf, path, context):
    """The new part of a scene file. Raises PartError and sardf.Error; then nothing is left."""
    path = Path(path).resolve()
    try:
        text = path.read_text(encoding="utf-8")
        document = scene_text.parse(text)
    except (OSError, ValueError) as error:
        sardf.load(str(path))  # says it with line and column
        raise PartError(f"{path}: cannot be read: {error}") from None
    if '"fitted"' not in text:  # to be solved first, which the bake does with a progress bar
        sardf.load(str(path))
    importer = _Importer(sardf, document, context)
    try:
        return importer.run(document.get("title") or path.stem, str(path.parent))
    except BaseException as error:
        part_objects.remove_part(importer.part)
        if isinstance(error, (LookupError, TypeError, ValueError, AttributeError)):
            sardf.load(str(path))  # a file of another form than scenes have: says where
        raise


class _Importer:
    def __init__(self, sardf, document, context):
        self.document = document
        self.context = context
        self.fields = document.get("fields", {})
        self.numbers = Numbers(sardf, document)
        self.collection = context.collection
        self.objects = {}  # name of a field -> its object, or None
        self.part = None

    def run(self, title, folder):
        self.part = part = part_objects.new_part(title, self.collection)
        settings = part.sardf_part
        settings.units = self.document.get("units", "mm")
        settings.folder = folder
        solid = self.document["solid"]
        if isinstance(solid, str) and _boolean(self.fields.get(solid)):
            settings.solid_field = solid
            self.objects[solid] = part
            self._stack(part, self.fields[solid])
        elif _boolean(solid):
            self._stack(part, solid)
        else:
            self._entry(part, solid)
        for name in self.fields:
            self._field_entry(name)
        for name, material in self.document.get("materials", {}).items():
            self._material(name, material)
        read_fractions(self, self.document.get("fractions"))
        for number, section in enumerate(self.document.get("sections", ()), 1):
            self._section(section, f"section {number}")
        return self._remember()

    def _remember(self):
        """Keep the file's document, and what the objects give before anyone touches them."""
        self.context.view_layer.update()
        settings = self.part.sardf_part
        settings.imported = json.dumps(self.document)
        depsgraph = self.context.evaluated_depsgraph_get()
        settings.generated = json.dumps(part_scene.generated(self.part, depsgraph)[0])
        return self.part

    def _field_entry(self, name):
        """An entry that is no part of the solid, for a field with an object and no entry yet."""
        entries = self.part.sardf_part.entries
        item = self.object_of(name)
        if item is None or item == self.part or any(entry.object == item for entry in entries):
            return
        self._add(self.part, item, "none", name, field=name)

    def _stack(self, part, boolean):
        """The operands of a boolean as entries of a part."""
        word, given = next(iter(boolean.items()))
        operands = given["of"] if isinstance(given, dict) else given
        blend = given.get("blend", "min_max") if isinstance(given, dict) else "min_max"
        if _boolean(operands[0]):
            self._stack(part, operands[0])
        else:
            self._entry(part, operands[0])
        for operand in operands[1:]:
            self._entry(part, operand, word, blend)

    def _entry(self, part, value, operation="union", blend="min_max"):
        name, radius = self._blend(blend)
        how = {"blend": name} | ({} if radius is None else {"radius": radius})
        if isinstance(value, str) and not value.startswith("="):
            item = self.object_of(value)
            if item is not None and item != self.part:
                self._add(part, item, operation, value, field=value, **how)
                return
            self._add_text(part, value, value, operation, **how)
            return
        item = self._object(value, _label(value))
        if item is not None:
            self._add(part, item, operation, item.name, inline=True, **how)
            return
        text = value if isinstance(value, str) else json.dumps(value)
        if isinstance(value, (int, float)):
            text = f"={text}"
        self._add_text(part, _label(value), text, operation, inline=True, **how)

    def _add(self, part, item, operation, name, **more):
        entry = part_objects.add_entry(part, item, operation, name, **more)
        entry.operation = operation  # even of what is no solid: the file says so
        entry.as_feature = item.type == "CURVE"
        return entry

    def _add_text(self, part, name, text, operation, **more):
        entry = part.sardf_part.entries.add()
        entry.name, entry.text, entry.operation = name, text, operation
        for key, value in more.items():
            setattr(entry, key, value)

    def _blend(self, blend):
        if isinstance(blend, str):
            return blend, None
        name, value = next(iter(blend.items()))
        if isinstance(value, dict):
            value = next(iter(value.values()), None)
        try:
            return name, None if value is None else self.numbers.number(value)
        except NotANumber:
            return name, None

    def object_of(self, name):
        """The object of a named field; None where it has no counterpart."""
        if name not in self.objects:
            self.objects[name] = None  # while it is being made
            self.objects[name] = self._object(self.fields.get(name), name)
        return self.objects[name]

    def _object(self, value, name):
        if _boolean(value):
            inner = part_objects.new_part(name, self.collection)
            inner.parent = self.part
            self._stack(inner, value)
            return inner
        shape = shape_of(value, self.numbers)
        if shape is None:
            return None
        item = _made(shape, name, self.collection)
        item.parent = self.part
        item.matrix_basis = shape.matrix
        return item

    def _material(self, name, given):
        item = self.part.sardf_part.materials.add()
        item.name = name
        for key in ("color", "emission"):
            if key in given:
                setattr(item, key, self._color(given[key]))
        for key in ("roughness", "metallic", "density", "index_of_refraction"):
            if key in given:
                setattr(item, key, self.numbers.number(given[key]))

    def _color(self, value):
        if isinstance(value, str):
            levels = (int(value[i : i + 2], 16) / 255 for i in (1, 3, 5))
            return tuple(Color(tuple(levels)).from_srgb_to_scene_linear())
        return self.numbers.vector(value)

    def _section(self, section, name):
        """Section objects for what a section removes; several where these cut together."""
        keep = section.get("keep", [])
        shapes = [shape_of(each, self.numbers) for each in _together(section["remove"])]
        is_solid = all(s is not None and s.kind not in ("point", "poly", "nurbs") for s in shapes)
        if not is_solid or not all(isinstance(each, str) for each in keep):
            made = self.part.sardf_part.sections.add()
            made.name, made.text = name, json.dumps(section)
            return
        size = part_section_objects.size_of(self.part)
        for number, shape in enumerate(shapes):
            made = self.part.sardf_part.sections.add()
            made.name = name if len(shapes) == 1 else f"{name} {'abcdefghijklmnop'[number % 16]}"
            made.operation = "intersection" if number else "union"
            made.keep = "" if number else ", ".join(keep)
            made.object = _made(shape, made.name, self.collection)
            part_section_objects.mark(made.object)
            made.object.parent = self.part
            made.object.matrix_basis = shape.matrix
            if shape.kind == "half_space":  # it has no size: this is how large it is drawn
                made.object.matrix_basis @= Matrix.Scale(size, 4)


def _together(removed):
    """The operands of an intersection that entries of the list can say, or the field alone."""
    if _boolean(removed) and "intersection" in removed:
        given = removed["intersection"]
        if isinstance(given, list) or given.keys() == {"of"}:
            return given if isinstance(given, list) else given["of"]
    return [removed]


def _boolean(value):
    """Whether a value is a union, intersection or difference that entries can say."""
    if not isinstance(value, dict) or len(value) != 1 or next(iter(value)) not in BOOLEANS:
        return False
    given = next(iter(value.values()))
    return bool(given["of"] if isinstance(given, dict) else given)


def _label(value):
    return next(iter(value)) if isinstance(value, dict) and value else "formula"


def _made(shape, name, collection):
    """The object of a Shape, at the origin."""
    if shape.kind == "point":
        item = bpy.data.objects.new(name, None)
        item.empty_display_type = "SPHERE"
        item.empty_display_size = 0.25
    elif shape.kind in ("poly", "nurbs"):
        item = bpy.data.objects.new(name, _curve(shape, name))
    else:
        return part_objects.new_primitive(shape.kind, name, collection, **shape.values)
    collection.objects.link(item)
    return item


def _curve(shape, name):
    data = bpy.data.curves.new(name, "CURVE")
    data.dimensions = "3D"
    spline = data.splines.new("POLY" if shape.kind == "poly" else "NURBS")
    spline.points.add(len(shape.points) - 1)
    weights = shape.weights or [1.0] * len(shape.points)
    pairs = zip(shape.points, weights, strict=True)
    spline.points.foreach_set("co", [each for point, weight in pairs for each in (*point, weight)])
    spline.use_cyclic_u = shape.closed
    if shape.kind == "nurbs":
        spline.order_u = shape.degree + 1
        spline.use_endpoint_u = not shape.closed
    return data

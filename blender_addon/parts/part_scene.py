# SPDX-License-Identifier: GPL-3.0-or-later
"""A part as a scene: the dictionary that a scene file holds.

Everything else (bake, preview, export) takes the dictionary and knows nothing of objects.
"""

from dataclasses import dataclass
from pathlib import Path

from . import part_features, part_materials, part_properties, part_sections, scene_text, words
from .part_error import PartError
from .part_fields import object_field
from .part_frame import Frame, objects_in_scenes, with_values
from .part_join import joined_document
from .part_text import field_from_text, json_from
from .transforms import Flat, number, placed


@dataclass
class Reading:
    """What a part is: its scene as a scene file has it, and part_sections.Cut for each of the
    scene's sections, in their order. `warnings`: what is read otherwise than it may be meant."""

    scene: dict
    warnings: list
    cuts: list


def read(part, depsgraph):
    """The Reading of a part, with absolute file names.

    Values are those of the evaluated `depsgraph`: animated and driven ones count. Raises
    PartError.
    """
    reading = _read(part, depsgraph)
    folder = part.sardf_part.folder
    if folder:
        reading.scene = absolute_paths(reading.scene, folder)
    return reading


def scene_of(part, depsgraph):
    """(scene, warnings) of a part as `read` has it: a dictionary for
    sardf.Scene.from_json(json.dumps(scene))."""
    reading = read(part, depsgraph)
    return reading.scene, reading.warnings


def document_of(part, depsgraph):
    """As scene_of, with file names as the imported scene file has them."""
    reading = _read(part, depsgraph)
    return reading.scene, reading.warnings


def _read(part, depsgraph):
    builder = _Builder(part, depsgraph)
    scene, warnings = builder.document()
    settings = part.sardf_part
    if settings.imported:
        scene = _with_file(part, scene)
    # What cuts all parts is no part's own, so a file's words of its sections stay.
    of_all = part_sections.cuts_of_all(builder, settings)
    if of_all:
        scene["sections"] = [*scene.get("sections", ()), *(cut.section for cut in of_all)]
    if not settings.imported:
        scene = {key: value for key, value in scene.items() if value not in ({}, [])}
    return Reading(scene, warnings, builder.cuts + of_all)


def _with_file(part, now):
    """What the objects give now in the words of the file that the part came from."""
    then = json_from(part.sardf_part.generated, f"what '{part.name}' remembers of its objects")
    original = json_from(part.sardf_part.imported, f"what '{part.name}' remembers of its file")
    return scene_text.merged(now, then, original)


def generated(part, depsgraph):
    """(document, warnings): what the objects and lists of a part give by themselves."""
    return _Builder(part, depsgraph).document()


class _Builder:
    """One run over a part and the parts in it; all matrices are relative to the outermost."""

    def __init__(self, part, depsgraph, path=()):
        self.part = part
        self.depsgraph = depsgraph
        self.frame = Frame(part, depsgraph)
        self.fields = {}
        self.parameters = {}
        self.warnings = []
        self.cuts = []
        self._shown = objects_in_scenes()
        self._path = [*path, part]  # the parts that contain what is being built
        self._names = {}  # pointer of an object -> the name of its field
        self._reserved = self._file_names()

    def document(self):
        check(self.part)
        settings = self.part.sardf_part
        evaluated = self.frame.evaluated(self.part).sardf_part
        self._name_entries(settings)
        self.solid = self._named_solid(self.stack(self.part, evaluated), settings)
        scene = {
            "sardf": 1,
            "title": self.part.name,
            "units": settings.units,
            "parameters": self.parameters,
            "fields": self.fields,
            "solid": self.solid,
            "materials": part_materials.materials_of(settings, evaluated),
        }
        fractions = part_features.fractions_of(self, settings, evaluated)
        if fractions is not None:
            scene["fractions"] = fractions
        self.cuts = part_sections.cuts_of(self, settings, evaluated)
        scene["sections"] = [cut.section for cut in self.cuts]
        return scene, self.warnings

    def _named_solid(self, solid, settings):
        """The solid under the name that the file gave it, or in a part of our own any name."""
        if isinstance(solid, str) or (settings.imported and not settings.solid_field):
            return solid
        name = settings.solid_field or self.new_name("solid")
        self.fields[name] = solid
        return name

    def stack(self, part, evaluated):
        """The entries of a part joined from the first to the last: a name or a field."""
        made, last = None, None
        for entry, values in with_values(part.sardf_part.entries, evaluated.entries):
            try:
                value = self.reference(entry, part)
            except PartError as error:
                if not entry.mute:
                    raise
                self.warnings.append(str(error))
                continue
            if value is None or entry.mute or entry.operation == "none":
                continue
            if made is None:
                made = value
                continue
            how = (entry.operation, blend_of(entry.blend, values.radius))
            if how == last:
                made[how[0]]["of"].append(value)
                continue
            blend = {} if how[1] == "min_max" else {"blend": how[1]}
            made, last = {how[0]: {"of": [made, value]} | blend}, how
        if made is None:
            raise PartError(
                f"the part '{part.name}' has no entry that makes a solid; "
                "add primitives or other objects to it"
            )
        return made

    def reference(self, entry, part):
        """What stands for an entry in other fields: its name, or the field itself where it has
        none; None for an entry without content, which is warned of."""
        if entry.object is None and not entry.text:
            self.warnings.append(f"'{part.name}': the object of '{entry.name}' is gone")
            return None
        if entry.object is not None:
            if not self.is_there(entry.object):
                self.warnings.append(
                    f"'{part.name}': the object of the entry '{entry.name}' was deleted; "
                    "the entry is left out"
                )
                return None
            known = self._names.get(entry.object.as_pointer())
            if known in self.fields:
                return known
        field = self._entry_field(entry, part)
        if entry.inline:
            return field
        if entry.object is None:
            if isinstance(field, str) and not field.startswith("="):
                return field  # the name of a field of the file
            name = entry.field or self.new_name(entry.name)
        else:
            name = self._names.get(entry.object.as_pointer()) or self.new_name(entry.name)
            self._names[entry.object.as_pointer()] = name
        self.fields[name] = field
        return name

    def _entry_field(self, entry, part):
        if entry.object is None:
            field = field_from_text(entry.text, f"the entry '{entry.name}' of '{part.name}'")
            return self._carried(field, part)
        if entry.object.sardf_part.is_part:
            return self.part_field(entry.object, entry.field or entry.name)
        return self.object_field(entry.object, entry.as_feature)

    def object_field(self, item, as_feature):
        return object_field(item, self.frame, self.warnings, as_feature)

    def _carried(self, field, part):
        """A field written in the frame of `part`, in that of the outermost part."""
        if part == self.part or isinstance(field, str) and not field.startswith("="):
            return field
        try:
            return placed(field, self.frame.matrix(part))
        except Flat:
            raise PartError(f"the part '{part.name}' has a scale of 0") from None

    def part_field(self, part, name):
        """The solid of a part inside this one."""
        if part in self._path:
            names = " > ".join(each.name for each in [*self._path, part])
            raise PartError(f"the part '{part.name}' contains itself: {names}")
        check(part)
        if part.sardf_part.imported:
            return self._foreign(part, name)
        self._path.append(part)
        try:
            self._name_entries(part.sardf_part)
            return self.stack(part, self.frame.evaluated(part).sardf_part)
        finally:
            self._path.pop()

    def _foreign(self, part, name):
        """A part that came from a file of its own: its names must not meet ours."""
        inner = _Builder(part, self.depsgraph, self._path)
        now, warnings = inner.document()
        settings = part.sardf_part
        scene = _with_file(part, now)
        if settings.folder:
            scene = absolute_paths(scene, settings.folder)
        self.warnings += warnings
        prefix = scene_text.field_name(name)
        fields, parameters, solid = joined_document(scene, prefix)
        self.fields |= fields
        self.parameters |= parameters
        try:
            return placed(solid, self.frame.matrix(part))
        except Flat:
            raise PartError(f"the part '{part.name}' has a scale of 0") from None

    def is_there(self, item):
        return item.library is not None or item.as_pointer() in self._shown

    def name_of(self, item):
        """The name of the field that an object has as an entry, or None."""
        name = self._names.get(item.as_pointer())
        return name if name in self.fields else None

    def new_name(self, wanted):
        """A name that no field has yet; it is taken from now on."""
        name = scene_text.field_name(wanted, self._reserved)
        self._reserved.add(name)
        return name

    def _name_entries(self, settings):
        """Names of all entries before any is built, so that each can be referred to."""
        for entry in settings.entries:
            if entry.object is None or entry.inline:
                continue
            pointer = entry.object.as_pointer()
            if pointer not in self._names:
                self._names[pointer] = entry.field or self.new_name(entry.name)

    def _file_names(self):
        """Names that a file's fields and parameters have already."""
        if not self.part.sardf_part.imported:
            return set()
        what = f"what '{self.part.name}' remembers of its file"
        original = json_from(self.part.sardf_part.imported, what)
        return {*original.get("fields", ()), *original.get("parameters", ())}


def check(part):
    """Raises PartError for what is no part, or was made by a newer version of the add-on."""
    settings = part.sardf_part
    if not settings.is_part:
        raise PartError(f"'{part.name}' is no sardf part")
    if settings.version > part_properties.VERSION:
        raise PartError(
            f"the part '{part.name}' was made by a newer version of the add-on: "
            f"its data is of version {settings.version}, {part_properties.VERSION} is known"
        )


def blend_of(name, radius):
    """A blend as the scene file says it."""
    parameter = words.blend_parameter(name)
    if not parameter:
        return name
    return {name: number(radius)} if radius > 0 else "min_max"


def absolute_paths(value, folder):
    """JSON data with each relative "path" made absolute."""
    if isinstance(value, dict):
        return {
            key: str(Path(folder, inner)) if key == "path" and isinstance(inner, str)
            else absolute_paths(inner, folder)
            for key, inner in value.items()
        }  # fmt: skip
    if isinstance(value, list):
        return [absolute_paths(inner, folder) for inner in value]
    return value

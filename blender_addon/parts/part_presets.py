# SPDX-License-Identifier: GPL-3.0-or-later
"""Common material distributions, as entries of a part's lists that can be changed afterwards."""

from dataclasses import dataclass

from .part_error import PartError

STEEL, BRONZE, CERAMIC, HARD = (
    (0.26, 0.28, 0.31), (0.45, 0.23, 0.08), (0.65, 0.62, 0.52), (0.03, 0.05, 0.15)
)  # fmt: skip


@dataclass(frozen=True)
class Preset:
    """`materials`: (name, linear colour, metallic), what is put on first."""

    title: str
    description: str
    materials: tuple


PRESETS = {
    "lined_bore": Preset(
        "Lined Bore",
        "A lining of the given depth around the chosen entry, which is subtracted",
        (("lining", BRONZE, 1.0), ("body", STEEL, 1.0)),
    ),
    "graded_coating": Preset(
        "Graded Coating",
        "From a coating on the part's surface to the body at the given depth",
        (("coating", CERAMIC, 0.0), ("body", STEEL, 1.0)),
    ),
    "hardened_faces": Preset(
        "Hardened Faces",
        "Hard at the chosen faces of the chosen entry, tough from the given depth on",
        (("hard", HARD, 1.0), ("body", STEEL, 1.0)),
    ),
    "inlay": Preset(
        "Inlay",
        "The chosen entry is a body of its own material inside the part",
        (("inlay", BRONZE, 1.0), ("body", STEEL, 1.0)),
    ),
}


def apply(part, choice, depth, faces=""):
    """Replace the part's features by a preset's. Raises PartError."""
    settings = part.sardf_part
    target = _TARGETS[choice](part)
    preset = PRESETS[choice]
    _forget_materials(settings, preset)
    names = [_material(settings, *material) for material in preset.materials]
    settings.features.clear()
    settings.feature_index = 0
    if choice == "inlay":
        settings.rule = "partition"
        _feature(settings, target, names[0], surface=False)
        _feature(settings, part, names[1], surface=False)
        return
    settings.rule = "ramp"
    stops = [(names[0], 0.0), (names[1], depth)]
    if choice == "lined_bore":  # a lining is one material, with a short way to the next
        stops.insert(1, (names[0], 0.8 * depth))
    for name, distance in stops:
        _feature(settings, target, name, distance=distance, faces=faces)


def _feature(settings, item, material, **more):
    feature = settings.features.add()
    feature.name = material
    feature.object = item
    feature.material = material
    for key, value in more.items():
        setattr(feature, key, value)


def _material(settings, name, color, metallic):
    """The name of the part's material of that name, made if there is none."""
    if name not in settings.materials:
        item = settings.materials.add()
        item.name, item.color, item.metallic = name, color, metallic
        item.roughness = 0.35
    return name


def _forget_materials(settings, preset):
    """Remove what an earlier preset brought, unless it was changed since."""
    kept = {material[0] for material in preset.materials}
    made = {m[0]: m[1] for each in PRESETS.values() for m in each.materials if m[0] not in kept}
    for place in reversed(range(len(settings.materials))):
        item = settings.materials[place]
        color = made.get(item.name)
        plain = color and max(abs(a - b) for a, b in zip(color, item.color, strict=True)) < 1e-6
        if plain and item.source is None:
            settings.materials.remove(place)
    settings.material_index = 0


def _bore(part):
    entries = part.sardf_part.entries
    chosen = _chosen(part)
    if chosen is not None and chosen.operation == "difference" and chosen.object:
        return chosen.object
    found = next((e.object for e in entries if e.operation == "difference" and e.object), None)
    if found is None:
        raise PartError(f"no entry of '{part.name}' is subtracted; a bore is")
    return found


def _chosen(part):
    entries, index = part.sardf_part.entries, part.sardf_part.entry_index
    return entries[index] if 0 <= index < len(entries) else None


def _chosen_object(part):
    chosen = _chosen(part)
    if chosen is None or chosen.object is None:
        raise PartError(f"no entry of '{part.name}' with an object is chosen")
    return chosen.object


_TARGETS = {
    "lined_bore": _bore,
    "graded_coating": lambda part: part,
    "hardened_faces": _chosen_object,
    "inlay": _chosen_object,
}

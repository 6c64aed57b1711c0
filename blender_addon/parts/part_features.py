# SPDX-License-Identifier: GPL-3.0-or-later
"""A part's list of features as the fraction rule of the scene file.

`builder` is the part_scene builder at work, which knows the fields and their names.
"""

import re

from . import scene_text
from .part_error import PartError
from .part_fields import is_feature
from .part_frame import with_values
from .part_text import field_from_text, json_from
from .transforms import number


def fractions_of(builder, settings, evaluated):
    """The rule, or None for the first material everywhere. Raises PartError."""
    if settings.rule == "text":
        return json_from(settings.rule_text, "the fraction rule") if settings.rule_text else None
    if settings.rule == "none" or not settings.materials:
        return None
    items = list(with_values(settings.features, evaluated.features))
    if not items:
        raise PartError(
            f"the rule {settings.rule} of '{builder.part.name}' has no features; add some"
        )
    return {settings.rule: _RULES[settings.rule](builder, items)}


def _inverse_distance(builder, items):
    made = []
    for feature, values in items:
        each = {"at": feature_at(builder, feature)}
        each |= _content(builder, feature, each)
        exponent = number(values.exponent)
        each |= {} if exponent == 1 else {"exponent": exponent}
        influence = feature.influence.strip()
        if influence:
            each["influence"] = _number_or_formula(influence)
        made.append(each)
    return {"features": made}


def _blend_between(builder, items):
    if len(items) != 2:
        raise PartError(
            f"the rule blend_between of '{builder.part.name}' has {len(items)} features; it is "
            "for two"
        )
    made = []
    for feature, _ in items:
        each = {"at": feature_at(builder, feature)}
        made.append(each | _content(builder, feature, each))
    return {"of": made}


def _ramp(builder, items):
    field = {"at": feature_at(builder, items[0][0])}
    stops = []
    for feature, values in items:
        stop = {"at": number(values.distance)}
        stops.append(stop | _content(builder, feature, field))
    if any(a["at"] > b["at"] for a, b in zip(stops, stops[1:], strict=False)):
        raise PartError(
            f"the distances of the ramp of '{builder.part.name}' do not rise from feature to "
            "feature"
        )
    return {"field": field["at"], "stops": stops}


def _partition(builder, items):
    made = []
    for feature, _ in items:
        each = {"solid": feature_at(builder, feature, solid=True)}
        made.append(each | _content(builder, feature, {"at": each["solid"]}))
    return {"of": made}


_RULES = {
    "inverse_distance": _inverse_distance,
    "blend_between": _blend_between,
    "ramp": _ramp,
    "partition": _partition,
}


def feature_at(builder, feature, solid=False):
    """The field that a feature's distance is taken of. `solid`: as it is, never its surface."""
    if feature.object is None:
        if not feature.text:
            raise PartError(f"the feature '{feature.name}' has no object; choose one")
        return field_from_text(feature.text, f"the feature '{feature.name}'")
    if not builder.is_there(feature.object):
        raise PartError(f"the object of the feature '{feature.name}' was deleted")
    field, is_line = _object_field(builder, feature, solid)
    if solid or is_line or not feature.surface:
        return field
    return {"boundary": {"solid": field} | _faces(feature)}


def _object_field(builder, feature, solid):
    """The field of a feature's object, and whether it is a feature already."""
    item = feature.object
    if item == builder.part:
        return builder.solid, False
    entry = next((e for e in builder.part.sardf_part.entries if e.object == item), None)
    if entry is not None:
        name = builder.name_of(item)
        if name is not None:
            return name, is_feature(item, entry.as_feature)
    if item.sardf_part.is_part:
        return builder.part_field(item, item.name), False
    as_feature = not solid and (feature.surface or item.type == "CURVE")
    field = builder.object_field(item, as_feature)
    line = is_feature(item, as_feature)
    if line and item.type == "MESH":
        _innermost(field, "mesh_surface").update(_faces(feature))
    return field, line


def _innermost(field, word):
    """The parameters of the operation `word` under what moves it."""
    while word not in field:
        field = next(iter(field.values()))["field"]
    return field[word]


def _faces(feature):
    words = [word for word in re.split(r"[,\s]+", feature.faces.strip()) if word]
    if not words:
        return {}
    if not all(word.isdigit() for word in words):
        raise PartError(
            f"the faces of the feature '{feature.name}' are '{feature.faces}'; numbers separated "
            "by commas are accepted"
        )
    return {"faces": [int(word) for word in words]}


def _content(builder, feature, at):
    """What a feature is made of: "material", or "fractions" where it is a mixture."""
    if feature.fractions.strip():
        return {"fractions": json_from(feature.fractions, f"the fractions of '{feature.name}'")}
    known = [item.name for item in builder.part.sardf_part.materials]
    for name in filter(None, (feature.material, feature.other)):
        if name not in known:
            raise PartError(
                f"the feature '{feature.name}' asks for the material '{name}'; "
                f"accepted are {', '.join(known)}"
            )
    if not feature.material:
        raise PartError(f"the feature '{feature.name}' has no material; choose one")
    function = feature.function.strip().removeprefix("=").strip()
    if not function:
        return {"material": feature.material}
    if not feature.other or feature.other == feature.material:
        raise PartError(
            f"the feature '{feature.name}' has a function but no other material for the rest"
        )
    return {"fractions": {"functions": {
        feature.material: "=" + _of_distance(builder, feature, function, at),
        feature.other: "rest",
    }}}  # fmt: skip


def _of_distance(builder, feature, function, at):
    """The formula with a field's name in place of u."""
    if "u" not in scene_text.NAME.findall(function):
        return function
    if not isinstance(at["at"], str) or at["at"].startswith("="):
        name = builder.new_name(f"distance_to_{feature.name}")
        builder.fields[name], at["at"] = at["at"], name
    return scene_text.replace_name(function, "u", at["at"])


def _number_or_formula(text):
    try:
        return float(text)
    except ValueError:
        return text if text.startswith("=") else f"={text}"

# SPDX-License-Identifier: GPL-3.0-or-later
"""A scene file's fraction rule as a part's list of features, or else as text."""

import json

from .import_numbers import NotANumber

FORMS = {  # rule -> the key of its list, its other keys, and the key of an item's field
    "inverse_distance": ("features", set(), "at", {"exponent", "influence"}),
    "blend_between": ("of", set(), "at", set()),
    "ramp": ("stops", {"field"}, "", {"at"}),
    "partition": ("of", set(), "solid", set()),
}


def read_fractions(importer, rule):
    """Fill the features of the importer's part."""
    settings = importer.part.sardf_part
    if rule is None:
        return
    word = next(iter(rule)) if isinstance(rule, dict) and len(rule) == 1 else ""
    if word not in FORMS or not _fits(word, rule[word]):
        settings.rule, settings.rule_text = "text", json.dumps(rule)
        return
    settings.rule = word
    given = rule[word]
    listed, _, key, _ = FORMS[word]
    try:
        for number, item in enumerate(given[listed], 1):
            feature = settings.features.add()
            feature.name = _name(item.get(key) or given.get("field"), number)
            # A ramp's field is that of its first feature.
            _read_field(importer, feature, item[key] if key else given["field"], word)
            _read_content(importer, feature, item, word)
    except NotANumber:
        settings.features.clear()
        settings.rule, settings.rule_text = "text", json.dumps(rule)


def _fits(word, given):
    listed, others, key, more = FORMS[word]
    accepted = {*more, key, "material", "fractions"}
    return (
        isinstance(given, dict)
        and given.keys() == {listed, *others}
        and (word != "blend_between" or len(given[listed]) == 2)
        and all(item.keys() <= accepted for item in given[listed])
    )


def _name(field, number):
    if isinstance(field, dict):
        field = next(iter(field.values())) if "boundary" in field else next(iter(field))
        field = field.get("solid") if isinstance(field, dict) else field
    return field if isinstance(field, str) and not field.startswith("=") else f"feature {number}"


def _read_field(importer, feature, field, word):
    inner, faces = field, None
    feature.surface = False
    if isinstance(field, dict) and "boundary" in field and word != "partition":
        inner = field["boundary"]
        if isinstance(inner, dict) and "solid" in inner:
            if not inner.keys() <= {"solid", "faces"}:
                inner = None
            else:
                inner, faces = inner["solid"], inner.get("faces")
        feature.surface = True
    item = None
    if isinstance(inner, str) and not inner.startswith("="):
        item = importer.object_of(inner)
    if item is None or (feature.surface and item.type == "CURVE"):
        feature.text = field if isinstance(field, str) else json.dumps(field)
        return
    feature.object = item
    if faces:
        feature.faces = ", ".join(str(int(importer.numbers.number(face))) for face in faces)


def _read_content(importer, feature, item, word):
    if "material" in item:
        feature.material = item["material"]
    elif "fractions" in item:
        feature.fractions = json.dumps(item["fractions"])
    if word == "ramp":
        feature.distance = importer.numbers.number(item["at"])
    if "exponent" in item:
        feature.exponent = importer.numbers.number(item["exponent"])
    if "influence" in item:
        value = item["influence"]
        if isinstance(value, dict):
            raise NotANumber
        feature.influence = str(value)

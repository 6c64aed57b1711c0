# SPDX-License-Identifier: GPL-3.0-or-later
"""Scene files as JSON data: read with their comments, compared, and edited without losing words.

A part that came from a scene file remembers the file's document and the document that its Blender
objects gave right then. Whatever they give later, `merged` puts only the differences into the
file's document: what was not touched keeps its formulas, names and form.
"""

import json
import re

# A string, which is kept, or a comment.
_PIECE = re.compile(r'"(?:[^"\\]|\\.)*"|//[^\n]*|/\*.*?\*/', re.DOTALL)
CLOSE = 2e-6  # of the largest number beside it: less is single precision's rounding
# Objects whose keys are names, as those of each material are, which go together in any choice;
# every other object is an operation with its parameters.
COLLECTIONS = {(), ("fields",), ("materials",), ("attributes",), ("parameters",)}


def parse(text):
    """The document of a scene file's text. Raises ValueError."""
    return json.loads(_PIECE.sub(lambda m: m[0] if m[0].startswith('"') else " ", text))


def same(a, b):
    """Whether two pieces of JSON data are equal but for rounding."""
    if _is_number(a) and _is_number(b):
        return abs(a - b) <= CLOSE * max(abs(a), abs(b))
    if isinstance(a, list) and isinstance(b, list):
        if len(a) != len(b):
            return False
        if a and all(map(_is_number, a)) and all(map(_is_number, b)):
            allowed = CLOSE * max(abs(value) for value in (*a, *b))
            return all(abs(p - q) <= allowed for p, q in zip(a, b, strict=True))
        return all(same(p, q) for p, q in zip(a, b, strict=True))
    if isinstance(a, dict) and isinstance(b, dict):
        return a.keys() == b.keys() and all(same(a[key], b[key]) for key in a)
    return type(a) is type(b) and a == b


def merged(now, then, original, path=()):
    """`original` with every change that leads from `then` to `now`.

    Where the three have one form, each part is looked at by itself; else `now` counts.
    """
    if same(now, then):
        return original
    if all(isinstance(each, dict) for each in (now, then, original)):
        collection = path in COLLECTIONS or (path[:1] == ("materials",) and len(path) == 2)
        # An operation's words that only the file has may not go with the new ones, as a rotation's
        # angle does not with a quaternion.
        if collection or (original.keys() <= then.keys() and now.keys() <= then.keys()):
            return _merged_object(now, then, original, path, collection)
    elif all(isinstance(each, list) for each in (now, then, original)) and (
        len(now) == len(then) == len(original)
    ):
        triples = zip(now, then, original, strict=True)
        return [merged(*triple, (*path, "")) for triple in triples]
    return now


def _merged_object(now, then, original, path, collection):
    result = {}
    for key in _order(now, then, original):
        if key in now and key in then:
            if not same(now[key], then[key]):
                before = original.get(key, then[key])
                result[key] = merged(now[key], then[key], before, (*path, key))
            elif key in original:
                result[key] = original[key]
        elif key in now:
            result[key] = now[key]
        elif key not in then and collection:
            result[key] = original[key]
    return result


def _order(now, then, original):
    """All keys, in the file's order unless the common ones were put into another."""
    common = [key for key in now if key in then]
    if common == [key for key in then if key in now]:
        return [*original, *(key for key in now if key not in original)]
    return [*now, *(key for key in original if key not in now)]


def _is_number(value):
    return isinstance(value, (int, float)) and not isinstance(value, bool)


NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")
TAKEN = ("x", "y", "z", "u", "pi")


def field_name(text, taken=()):
    """A name that scene files accept, as near to `text` as can be, and not in `taken`."""
    name = re.sub(r"[^A-Za-z0-9_]+", "_", text).strip("_") or "field"
    if not name[0].isalpha():
        name = f"field_{name}"
    if name in TAKEN:
        name = f"{name}_"
    candidate, count = name, 1
    while candidate in taken:
        count += 1
        candidate = f"{name}_{count}"
    return candidate


def replace_name(formula, name, by):
    """A formula with one of its names replaced."""
    return NAME.sub(lambda m: by if m[0] == name else m[0], formula)

"""Scenes written in Python: the words of a scene file, with fields in place of their names."""

import json

from sardf import _core


class blend:
    """Sets how booleans join fields inside a `with` block.

        with sardf.blend(sardf=0.5):
            part = block - bore

    The keyword is the blend's name in scene files, its value the first parameter: `sardf=R`,
    `sardf_c1=R`, `smooth=k`; `min_max=True` and `r_function=True` have none.
    """

    def __init__(self, **chosen):
        if len(chosen) != 1:
            _core._fail(f"blend takes one keyword of {', '.join(_core._blends)}")
        name, value = next(iter(chosen.items()))
        if name not in _core._blends:
            _core._fail(f"there is no blend '{name}'; accepted are {', '.join(_core._blends)}")
        make = getattr(_core, _core._blends[name])
        self._blend = make() if value is True else make(value)

    def __enter__(self):
        self._former = _core._set_blend(self._blend)
        return self._blend

    def __exit__(self, *exception):
        _core._set_blend(self._former)


class _Names:
    """Gives each field that a scene mentions a name, and the file's word for it."""

    def __init__(self):
        self.fields = {}

    def plain(self, value):
        """The value as JSON data, fields replaced by names."""
        if isinstance(value, _core.Field):
            for name, field in self.fields.items():
                if field is value:
                    return name
            name = f"field_{len(self.fields) + 1}"
            self.fields[name] = value
            return name
        if isinstance(value, _core.Blend):
            return {value.name: value.parameters[0]} if value.parameters else {value.name: {}}
        if isinstance(value, dict):
            return {str(key): self.plain(item) for key, item in value.items()}
        if isinstance(value, (list, tuple)):
            return [self.plain(item) for item in value]
        if hasattr(value, "tolist"):
            return value.tolist()
        return value


def with_names(value):
    """A rule as JSON text, and the fields that it names."""
    names = _Names()
    return json.dumps(names.plain(value)), names.fields


def Scene(solid, materials=None, fractions=None, **rest):
    """A scene from Python: the keys of a scene file, with fields wherever a file names one.

    solid: Field, positive inside.
    materials: {name: {"color": "#8a8f98" or (r, g, b) linear, "density": g/cm³, ...}}.
    fractions: {"inverse_distance": {"features": [{"at": field, "material": name}, ...]}} or any
        other rule of scene files.
    rest: title, units, attributes, sections, bounds, lipschitz, view, fields; progress, as
        sardf.load takes it.

    Returns sardf._core.Scene; raises Error where a scene file would.
    """
    names = _Names()
    fields, progress = rest.pop("fields", {}), rest.pop("progress", None)
    names.fields.update(fields)
    document = {"sardf": 1, **rest, "solid": solid}
    if materials is not None:
        document["materials"] = materials
    if fractions is not None:
        document["fractions"] = fractions
    text = json.dumps(names.plain(document))
    return _core.Scene.from_json(text, names.fields, progress)


Scene.from_json = _core.Scene.from_json

# SPDX-License-Identifier: GPL-3.0-or-later
"""Numbers of a scene file, where a formula of its parameters may stand for each."""

import json


class NotANumber(Exception):
    """A value that is no number, or whose formula is none of parameters alone."""


class Numbers:
    """Reads numbers, vectors and axes; the core evaluates what is a formula."""

    def __init__(self, sardf, document):
        self._sardf = sardf
        self._parameters = document.get("parameters", {})
        self._known = {}

    def number(self, value):
        if isinstance(value, (int, float)) and not isinstance(value, bool):
            return float(value)
        if not isinstance(value, str) or not value.startswith("="):
            raise NotANumber
        if value not in self._known:
            self._known[value] = self._evaluated(value)
        if self._known[value] is None:
            raise NotANumber
        return self._known[value]

    def vector(self, value, default=None, size=3):
        """`size` numbers; fewer get zeros, as points of two have."""
        if value is None and default is not None:
            return list(default)
        if not isinstance(value, list) or not value:
            raise NotANumber
        return [self.number(each) for each in value] + [0.0] * (size - len(value))

    def axis(self, value, default="z"):
        value = default if value is None else value
        units = {"x": [1.0, 0.0, 0.0], "y": [0.0, 1.0, 0.0], "z": [0.0, 0.0, 1.0]}
        return units[value] if isinstance(value, str) and value in units else self.vector(value)

    def _evaluated(self, formula):
        scene = {
            "sardf": 1,
            "parameters": self._parameters,
            "fields": {"sardf_value": formula},
            "solid": {"sphere": {"radius": 1}},
        }
        try:
            field = self._sardf.Scene.from_json(json.dumps(scene)).fields["sardf_value"]
        except self._sardf.Error:  # it names fields of the file
            return None
        here, there = field([(0.0, 0.0, 0.0), (0.7, -0.4, 0.3)])
        return float(here) if here == there else None

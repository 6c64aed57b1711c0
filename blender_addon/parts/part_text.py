# SPDX-License-Identifier: GPL-3.0-or-later
"""Text that a user types where a field or a rule is wanted."""

from . import scene_text
from .part_error import PartError


def field_from_text(text, what):
    """A field's name, formula or JSON object. Raises PartError."""
    text = text.strip()
    return json_from(text, what) if text[:1] in ("{", '"') else text


def json_from(text, what):
    try:
        return scene_text.parse(text)
    except ValueError as error:
        raise PartError(f"{what} is no JSON: {error}") from None

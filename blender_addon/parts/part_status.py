# SPDX-License-Identifier: GPL-3.0-or-later
"""What the panel says about a part: what is wrong with it, and what its distances are worth.

Nothing of it is stored in the .blend; it is found anew after every change.
"""

from dataclasses import dataclass

from . import part_bake, part_now

MOST_ENTRIES = 500  # of a part that is read again while the panel is drawn
WORTH = {
    "exact": "the exact distance",
    "bound": "a bound: never more than the distance",
    "estimate": "an estimate: its sign is right",
}


@dataclass
class Status:
    """`error`: why there is no scene, or ""; `lines`: warnings and labels."""

    error: str = ""
    lines: tuple = ()


_checked = {}  # name of a part -> lines of the core's last check


def status(part, depsgraph):
    """The Status of a part as it is now."""
    checked = _checked.get(part.name_full, ())
    if len(part.sardf_part.entries) > MOST_ENTRIES:
        lines = (f"{len(part.sardf_part.entries)} entries: press Check to read them",)
        return Status(lines=(*lines, *checked))
    now = part_now.now(part, depsgraph)
    if now.error is not None:
        return Status(error=str(now.error))
    return Status(lines=(*now.reading.warnings, *_about_baked(part, now), *checked))


def _about_baked(part, now):
    """Which of the part's two pictures is seen, where it is baked."""
    if not part_bake.is_seen(part):
        return ()
    if part_bake.mark_of(part) == now.mark:
        if part.sardf_part.show == "newer":
            return ("the baked object is up to date: it is shown in place of a preview",)
        return ("the baked object is up to date",)
    return ("the part was changed since it was baked",)


def check(sardf, part, depsgraph):
    """Sentences of the core about a part. Raises PartError and sardf.Error."""
    now = part_now.now(part, depsgraph)
    if now.error is not None:
        raise now.error
    scene = sardf.Scene.from_json(now.text)
    inside, outside = scene.solid.exactness
    lines = [f"inside: {WORTH[inside]}", f"outside: {WORTH[outside]}"]
    for name, field in scene.fields.items():
        if "estimate" in field.exactness and name in _entry_names(part):
            lines.append(f"{name}: {WORTH['estimate']}")
    _checked[part.name_full] = tuple(lines)
    return [*now.reading.warnings, *lines, *scene.warnings()]


def _entry_names(part):
    return {entry.field or entry.name for entry in part.sardf_part.entries}


def register():
    part_now.on_change(_checked.clear)


def unregister():
    part_now.off_change(_checked.clear)
    _checked.clear()

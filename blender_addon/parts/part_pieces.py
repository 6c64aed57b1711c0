# SPDX-License-Identifier: GPL-3.0-or-later
"""A part in the pieces that its sections cut it into: what each is, and its object."""

import dataclasses
import itertools

from mathutils import Matrix, Vector

from ..baked import assemble
from . import part_bake, part_scene
from .part_error import PartError

MOST = 4  # sections: each doubles the pieces
PIECE = "sardf_piece"  # custom property of a piece's object: 0 or 1 for each section, 1: taken off


@dataclasses.dataclass
class Piece:
    """`code`: 0 or 1 for each section, 1 where it is on the side that the section takes off;
    `scene`: as part_scene has it; `moves`: (section object, unit vector of the part's frame) by
    whose spread it is moved."""

    code: str
    scene: dict
    moves: list


def pieces_of(part, reading):
    """The Piece of every choice of sides; the first is what the sections leave. Raises
    PartError."""
    sections = reading.scene.get("sections", [])
    if not sections:
        raise PartError(f"no section cuts '{part.name}' into pieces; add one")
    if len(sections) > MOST:
        raise PartError(
            f"the {len(sections)} sections of '{part.name}' would make {2 ** len(sections)} "
            f"pieces; {MOST} sections are accepted at most: mute some"
        )
    return [_piece(reading, code) for code in itertools.product((0, 1), repeat=len(sections))]


def _piece(reading, code):
    pairs = list(zip(code, reading.scene["sections"], strict=True))
    sections = [_other_side(section) if taken else section for taken, section in pairs]
    moves = []
    if len(reading.cuts) == len(code):
        taken_off = (cut for taken, cut in zip(code, reading.cuts, strict=True) if taken)
        moves = [move for cut in taken_off for move in cut.moves]
    return Piece("".join(map(str, code)), reading.scene | {"sections": sections}, moves)


def _other_side(section):
    """The section that leaves what this one removes."""
    removed, keep = section["remove"], section.get("keep", [])
    if keep:
        removed = {"difference": {"of": [removed, *keep]}}
    return {"remove": {"complement": {"field": removed}}}


def requests_of(part, request, depsgraph):
    """[(Piece, job.Request), ...] for a part and the Request of all of it. Raises PartError."""
    made = []
    for piece in pieces_of(part, part_scene.read(part, depsgraph)):
        path = request.path if "1" not in piece.code else f"{request.path} piece {piece.code}"
        made.append((piece, dataclasses.replace(
            request, path=path, scene=piece.scene, sections=True)))  # fmt: skip
    return made


def shift_of(piece, depsgraph):
    """How far the piece is moved in the part's frame, as `depsgraph` has the spreads."""
    return sum(
        (item.evaluated_get(depsgraph).sardf_section.spread * way for item, way in piece.moves),
        Vector(),
    )


def place(scene, part, piece, made, built):
    """The object of a piece under the part's Empty: a new one, or the earlier one renewed. Its
    delta location follows the spreads of the sections that took it off."""
    if "1" not in piece.code:
        return part_bake.place(scene, part, made, built)
    earlier = find(part).get(piece.code)
    item = assemble.place(scene, made, built, earlier or assemble.NEW)
    if earlier is None:
        item[PIECE] = piece.code
        item.name = f"{part.name} piece {piece.code}"
        item.parent = part
        item.matrix_parent_inverse = Matrix.Identity(4)
        part_bake.put_beside(part, item)
    _follow(item, piece.moves)
    return item


def _follow(item, moves):
    item.driver_remove("delta_location")
    item.delta_location = (0, 0, 0)
    for axis in range(3) if moves else ():
        driver = item.driver_add("delta_location", axis).driver
        terms = []
        for number, (section, way) in enumerate(moves):
            variable = driver.variables.new()
            variable.name = f"spread_{number}"
            variable.targets[0].id = section
            variable.targets[0].data_path = "sardf_section.spread"
            terms.append(f"{way[axis]:.7f}*{variable.name}")
        driver.expression = " + ".join(terms)


def find(part):
    """{code: object} of the pieces that were baked of a part, but for what the sections leave."""
    return {item[PIECE]: item for item in part.children if PIECE in item and item.users_scene}

# SPDX-License-Identifier: GPL-3.0-or-later
"""Where objects stand in a part's frame, as the evaluated scene has them."""

import bpy

from .part_error import PartError
from .transforms import Flat, take_apart


class Frame:
    """The frame of one part: matrices of other objects relative to it.

    Values that are animated or driven are the evaluated ones of `depsgraph`.
    """

    def __init__(self, part, depsgraph):
        self.part = part
        self.depsgraph = depsgraph
        self._inverse = None
        self._known = {part.as_pointer(): None}  # the part itself stands at the origin

    def evaluated(self, item):
        return item.evaluated_get(self.depsgraph)

    def matrix(self, item):
        """4x4, from the object's own frame to the part's. Raises PartError."""
        steps = self._steps(item)
        if steps is not None:
            product = steps[0]
            for step in steps[1:]:
                product = step @ product
            return product
        return self._inverse_world() @ self.evaluated(item).matrix_world

    def _steps(self, item):
        """The matrices from the object up to the part, if that is all that places it.

        Going through the world would add rounding of the size of the part's distance from its
        origin, so that a part that is moved would seem to change.
        """
        steps = []
        while item != self.part:
            if item.parent is None or item.parent_type != "OBJECT" or len(item.constraints):
                return None
            steps.append(item.matrix_parent_inverse @ self.evaluated(item).matrix_basis)
            item = item.parent
        return steps or None

    def _inverse_world(self):
        if self._inverse is None:
            world = self.evaluated(self.part).matrix_world
            try:
                take_apart(world)
            except Flat:
                raise PartError(
                    f"the part '{self.part.name}' has a scale of 0; give it another scale"
                ) from None
            self._inverse = world.inverted()
        return self._inverse


def objects_in_scenes():
    """The objects that some scene shows: pointers keep others alive that were deleted."""
    return {item.as_pointer() for scene in bpy.data.scenes for item in scene.objects}


def with_values(items, evaluated):
    """Pairs of list items: those of the object, whose pointers count, and the evaluated ones,
    whose numbers do. Until Blender evaluates a list that has grown, its own numbers stand."""
    return zip(items, evaluated if len(evaluated) == len(items) else items, strict=True)

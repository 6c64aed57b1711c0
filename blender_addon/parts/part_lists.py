# SPDX-License-Identifier: GPL-3.0-or-later
"""Editing the lists of a part: entries, materials, features, sections."""

from typing import ClassVar

import bpy

from . import part_objects
from .part_error import PartError

LISTS = {  # list -> its index, and what one item is called
    "entries": ("entry_index", "entry"),
    "materials": ("material_index", "material"),
    "features": ("feature_index", "feature"),
    "sections": ("section_index", "section"),
}


def editable_part(context):
    """The active object's part. Raises PartError where there is none, or it is of a library."""
    part = part_objects.part_of(context.active_object)
    if part is None:
        raise PartError("no part is active; select one or make one by Add > sardf")
    if part.library is not None:
        raise PartError(
            f"the part '{part.name}' is linked from {part.library.filepath}: it is changed there, "
            "or here once it is made local"
        )
    return part


def add_selected(context, part):
    """Entries for the selected objects that have none; the active object's comes last."""
    known = {entry.object for entry in part.sardf_part.entries}
    chosen = [item for item in context.selected_objects if item != part and item not in known]
    chosen = [i for i in chosen if i.parent != part or i != part.sardf_part.baked]
    chosen = [item for item in chosen if not item.sardf_section.is_section]
    if not chosen:
        raise PartError("no object is selected that is not in the part yet")
    for item in chosen:
        part_objects.add_entry(part, item)
    return len(chosen)


def add_item(context, part, which):
    """A new item at the end of a list; returns it."""
    settings = part.sardf_part
    if which == "entries":
        add_selected(context, part)
        return settings.entries[-1]
    items = getattr(settings, which)
    item = items.add()
    index, word = LISTS[which]
    item.name = _free_name(word, items)
    setattr(settings, index, len(items) - 1)
    if which in ("features", "sections"):
        others = [each for each in context.selected_objects if each != part]
        item.object = others[0] if others else None
    if which == "features":
        item.material = settings.materials[0].name if settings.materials else ""
        item.name = item.object.name if item.object else item.name
        if settings.rule == "none":
            settings.rule = "inverse_distance"
    part.update_tag()
    return item


def _free_name(word, items):
    number = len(items)
    while f"{word} {number}" in items:
        number += 1
    return f"{word} {number}"


def remove_item(part, which, index):
    items = getattr(part.sardf_part, which)
    items.remove(index)
    setattr(part.sardf_part, LISTS[which][0], max(0, min(index, len(items) - 1)))
    part.update_tag()


class SARDF_OT_list(bpy.types.Operator):
    bl_idname = "sardf.list"
    bl_label = "Edit the Part's List"
    bl_description = "Add, remove or move an item"
    bl_options: ClassVar[set] = {"REGISTER", "UNDO", "INTERNAL"}

    which: bpy.props.EnumProperty(
        name="List", description="Which list of the part",
        items=[(name, name.title(), f"The part's {name}") for name in LISTS],
    )  # fmt: skip
    action: bpy.props.EnumProperty(
        name="Action",
        description="What to do with the chosen item",
        items=[
            ("add", "Add", "Add an item: for the selected objects, where the list is of objects"),
            ("remove", "Remove", "Remove the chosen item; its object stays"),
            ("up", "Up", "Move the chosen item one place up"),
            ("down", "Down", "Move the chosen item one place down"),
            ("show", "Select", "Select the chosen item's object"),
            ("restore", "Restore", "Bring the chosen item's deleted object back into the scene"),
        ],
    )

    @classmethod
    def description(cls, _context, properties):
        actions = cls.bl_rna.properties["action"].enum_items
        return actions[properties.action].description

    def execute(self, context):
        try:
            part = editable_part(context)
            getattr(self, f"_{self.action}")(context, part)
        except PartError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        return {"FINISHED"}

    def _chosen(self, part):
        items = getattr(part.sardf_part, self.which)
        index = getattr(part.sardf_part, LISTS[self.which][0])
        if not 0 <= index < len(items):
            raise PartError(f"no item of the {self.which} of '{part.name}' is chosen")
        return items, index

    def _add(self, context, part):
        add_item(context, part, self.which)

    def _remove(self, _context, part):
        remove_item(part, self.which, self._chosen(part)[1])

    def _up(self, _context, part, step=-1):
        items, index = self._chosen(part)
        target = index + step
        if 0 <= target < len(items):
            items.move(index, target)
            setattr(part.sardf_part, LISTS[self.which][0], target)
            part.update_tag()

    def _down(self, context, part):
        self._up(context, part, 1)

    def _object(self, part):
        items, index = self._chosen(part)
        item = getattr(items[index], "object", None)
        if item is None:
            raise PartError(f"'{items[index].name}' has no object")
        return item

    def _show(self, context, part):
        item = self._object(part)
        if item.name not in context.view_layer.objects:
            raise PartError(f"'{item.name}' is not in this view layer")
        for other in context.selected_objects:
            other.select_set(False)
        item.select_set(True)
        context.view_layer.objects.active = item

    def _restore(self, context, part):
        item = self._object(part)
        if item.users_scene:
            raise PartError(f"'{item.name}' is in a scene already")
        context.collection.objects.link(item)


def register():
    bpy.utils.register_class(SARDF_OT_list)


def unregister():
    bpy.utils.unregister_class(SARDF_OT_list)

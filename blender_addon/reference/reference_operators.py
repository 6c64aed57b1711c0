# SPDX-License-Identifier: GPL-3.0-or-later
"""Render in POV-Ray and compare; show one of the pictures."""

import traceback
from typing import ClassVar

import bpy

from .. import core, window
from ..baked.store import StoreError
from ..parts.part_error import PartError
from . import compare, pictures, work


class SARDF_OT_reference(window.Polling, bpy.types.Operator):
    """Render in a worker thread and a child process while Blender stays usable.

    The thread runs work.make and never touches bpy; the timer polls it. Images and baked objects
    are made only when all is there, so that Esc leaves nothing behind and one undo step takes
    everything back. Without a window the same happens in one go.
    """

    bl_idname = "sardf.reference"
    bl_label = "Render in POV-Ray"
    bl_description = (
        "Render the parts from their exact fields in POV-Ray, seen by the active camera under the "
        "scene's lights, and show the difference to Cycles (Esc cancels)"
    )
    bl_options: ClassVar[set] = {"UNDO"}

    work = None  # of the session, not of the file: the running work.Work, or None
    watch = window.Watch(("VIEW_3D", "IMAGE_EDITOR"))
    title = "Reference"

    @classmethod
    def poll(cls, _context):
        return SARDF_OT_reference.work is None

    def execute(self, context):
        try:
            sardf = core.load()
            order = compare.order_of(context)
            made = work.make(sardf, order)
        except (core.MissingCore, compare.Unready) as error:
            return self._fail(error)
        except sardf.Error as error:
            return self._fail(_told(error))
        return self._commit(context, order, made)

    def invoke(self, context, _event):
        if bpy.app.background:
            return self.execute(context)
        try:
            sardf = core.load()
            self._order = compare.order_of(context)
        except (core.MissingCore, compare.Unready) as error:
            return self._fail(error)
        SARDF_OT_reference.work = work.Work(sardf, self._order)
        self._waited = False
        self.watch.begin(context, self)
        self._show(context)
        return {"RUNNING_MODAL"}

    def poll_work(self, context):
        running = SARDF_OT_reference.work
        if running.running or not self._waited:
            self._waited = not running.running  # so that what comes now is shown before it blocks
            self._show(context)
            return {"PASS_THROUGH"}
        self.cancel(context)
        if running.error is not None:
            if not isinstance(running.error, core.load().Error):
                traceback.print_exception(running.error)  # ours to mend: show where
            return self._fail(_told(running.error))
        return self._commit(context, self._order, running.made)

    def cancel(self, context):
        """The thread ends by itself, and POV-Ray with it, within 0.1 s."""
        stop(context)

    def _commit(self, context, order, made):
        for text in order.stage.warnings:
            self.report({"WARNING"}, text)
        try:
            compare.place_baked(context, order, made)
            for look in order.looks:
                self.report({"INFO"}, compare.store(context, order, made, look))
        except (compare.Unready, PartError, StoreError) as error:
            return self._fail(error)
        return {"FINISHED"}

    def _show(self, context):
        running = SARDF_OT_reference.work
        if running.running:
            text = f"Rendering in POV-Ray {100 * running.share:.0f} %"
        else:
            text = "Comparing with Cycles" if self._order.bake else "Storing the picture"
        self.watch.tell(context, text, running.share)

    def _fail(self, error):
        self.report({"ERROR"}, str(error))
        return {"CANCELLED"}


class SARDF_OT_reference_show(bpy.types.Operator):
    bl_idname = "sardf.reference_show"
    bl_label = "Show"
    bl_description = "Show this picture in the Image Editors of the window"

    kind: bpy.props.EnumProperty(
        name="Picture",
        description="Which of the last comparison's pictures",
        items=(
            ("reference", "POV-Ray", "The reference"),
            ("cycles", "Cycles", "The baked objects in Cycles"),
            ("difference", "Difference ×16", "16 times the absolute difference"),
        ),
    )

    def execute(self, context):
        if pictures.find(self.kind) is None:
            self.report({"ERROR"}, f"there is no image '{pictures.NAMES[self.kind]}' yet")
            return {"CANCELLED"}
        if not pictures.show(context, self.kind):
            name = pictures.NAMES[self.kind]
            self.report({"WARNING"}, f"open an Image Editor; the image is called '{name}'")
        return {"FINISHED"}


def _told(error):
    """An error of the core, with where the add-on lets one name the program."""
    text = str(error)
    missing = "POV-Ray 3.7 was not found" in text
    return f"{text}; or name it in the add-on's preferences" if missing else text


def stop(context):
    """Stop the work, forget it, and take back what the window shows of it."""
    if SARDF_OT_reference.work is not None:
        SARDF_OT_reference.work.cancel()
        SARDF_OT_reference.work = None
    SARDF_OT_reference.watch.end(context)


CLASSES = (SARDF_OT_reference, SARDF_OT_reference_show)


def register():
    for cls in CLASSES:
        bpy.utils.register_class(cls)


def unregister():
    stop(bpy.context)
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)

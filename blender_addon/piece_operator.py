# SPDX-License-Identifier: GPL-3.0-or-later
"""Baking a part in the pieces that its sections cut it into."""

import time
import traceback
from typing import ClassVar

import bpy

from . import core, operators
from .baked import images, job
from .parts import part_bake, part_objects, part_pieces
from .parts.part_error import PartError


class SARDF_OT_bake_pieces(bpy.types.Operator):
    """As SARDF_OT_bake, one piece after the other; Blender data is made when all are there."""

    bl_idname = "sardf.bake_pieces"
    bl_label = "Bake Pieces"
    bl_description = (
        "Bake what the active object's part is on both sides of its sections, each piece as an "
        "object that the sections' Spread moves (Esc cancels)"
    )
    bl_options: ClassVar[set] = {"UNDO"}

    @classmethod
    def poll(cls, context):
        part = part_objects.part_above(context.active_object)
        return operators.SARDF_OT_bake.job is None and part is not None

    def execute(self, context):
        if not self._begin(context):
            return {"CANCELLED"}
        while self._step(context):
            time.sleep(0.002)
        return self._result

    def invoke(self, context, _event):
        if bpy.app.background:
            return self.execute(context)
        if not self._begin(context) or not self._step(context):
            return {"CANCELLED"}
        manager = context.window_manager
        self._timer = manager.event_timer_add(operators.POLL_SECONDS, window=context.window)
        manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        if event.type == "ESC" and event.value == "PRESS":
            self.cancel(context)
            self.report({"INFO"}, "Bake cancelled")
            return {"CANCELLED"}
        if event.type != "TIMER":
            return {"PASS_THROUGH"}
        if self._step(context):
            context.workspace.status_text_set(f"sardf: {self._stage} (Esc cancels)")
            return {"PASS_THROUGH"}
        self._end(context)
        return self._result

    def cancel(self, context):
        """Esc, or Blender ends the operator itself: nothing of it is left."""
        self._drop()
        self._end(context)

    def _begin(self, context):
        part = part_objects.outermost(part_objects.part_of(context.active_object))
        self._built, self._stage, self._result = [], "", {"CANCELLED"}
        try:
            if part is None:
                raise PartError("no part is active; select one")
            self._sardf = core.load()
            depsgraph = context.evaluated_depsgraph_get()
            self._wanted, warnings = part_pieces.requests_of(part, context.scene.sardf, depsgraph)
        except (core.MissingCore, PartError) as error:
            self.report({"ERROR"}, str(error))
            return False
        for text in warnings:
            self.report({"WARNING"}, text)
        self._part = part_bake.key_of(part)
        self._steps = self._work(context)
        return True

    def _step(self, context):
        """Go on for a moment; whether anything is left to be done."""
        try:
            self._stage = next(self._steps)
        except StopIteration:
            return False
        except Exception as error:
            self._drop()
            if not isinstance(error, (PartError, self._sardf.Error)):
                traceback.print_exception(error)  # ours to mend: show where
            self.report({"ERROR"}, str(error))
            return False
        finally:
            operators.SARDF_OT_bake.stage = self._stage
        return True

    def _work(self, context):
        """Yields what is being done."""
        made = []
        for number, (piece, request) in enumerate(self._wanted, 1):
            running = operators.SARDF_OT_bake.job = job.Job(self._sardf, request)
            while running.running:
                share = f"{100 * running.share:.0f} %"
                yield f"piece {number}/{len(self._wanted)} {share}"
            if isinstance(running.error, job.NothingLeft):
                continue
            if running.error is not None:
                raise running.error
            made.append((piece, running.part))
        for piece, arrays in made:
            self._built.append((piece, arrays, {}))
            for channel, array in arrays.maps.items():
                name = f"{arrays.name} {channel}"
                self._built[-1][2][channel] = images.build_packed(name, channel, array)
                yield f"storing textures of {piece.code}"
        self._commit(context)

    def _commit(self, context):
        part = part_bake.find(self._part)
        kept = {piece.code for piece, _, _ in self._built}
        for code, item in part_pieces.find(part).items():
            if code not in kept:  # the sections cut no such piece any more
                bpy.data.objects.remove(item)
        if not any("1" not in code for code in kept):
            part_bake.place_nothing(part, self._wanted[0][0].scene)
        built, self._built = self._built, []
        for piece, arrays, textures in built:
            part_pieces.place(context.scene, part, piece, arrays, textures)
        operators.SARDF_OT_bake.job = None
        self.report({"INFO"}, f"Baked {len(built)} pieces of {part.name}")
        self._result = {"FINISHED"}

    def _drop(self):
        if operators.SARDF_OT_bake.job is not None:
            operators.SARDF_OT_bake.job.cancel()
        operators.SARDF_OT_bake.job = None
        for _, _, textures in self._built:
            for image in textures.values():
                bpy.data.images.remove(image)
        self._built = []

    def _end(self, context):
        operators.SARDF_OT_bake.job = None
        context.window_manager.event_timer_remove(self._timer)
        context.workspace.status_text_set(None)


def register():
    bpy.utils.register_class(SARDF_OT_bake_pieces)


def unregister():
    bpy.utils.unregister_class(SARDF_OT_bake_pieces)

# SPDX-License-Identifier: GPL-3.0-or-later
"""Baking a part in the pieces that its sections cut it into."""

import dataclasses
import time
import traceback
from typing import ClassVar

import bpy

from . import bake_operator, bake_plan, core, window
from .bake_operator import SARDF_OT_bake
from .baked import assemble, job, unwrap
from .parts import part_bake, part_objects, part_pieces
from .parts.part_error import PartError


class SARDF_OT_bake_pieces(window.Polling, bpy.types.Operator):
    """As SARDF_OT_bake, one piece after the other; Blender data is made when all are there."""

    bl_idname = "sardf.bake_pieces"
    bl_label = "Bake Pieces"
    bl_description = (
        "Bake what the active object's part is on both sides of its sections, each piece as an "
        "object that the sections' Spread moves (Esc cancels)"
    )
    bl_options: ClassVar[set] = {"UNDO"}

    watch = SARDF_OT_bake.watch
    title = "Bake"

    @classmethod
    def poll(cls, context):
        part = part_objects.part_above(context.active_object)
        return SARDF_OT_bake.job is None and part is not None

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
        self.watch.begin(context, self)
        self.watch.tell(context, self._stage, self._share)
        return {"RUNNING_MODAL"}

    def poll_work(self, context):
        if self._step(context):
            self.watch.tell(context, self._stage, self._share)
            return {"PASS_THROUGH"}
        self._end(context)
        return self._result

    def cancel(self, context):
        self._drop()
        self._end(context)

    def _begin(self, context):
        part = part_objects.outermost(part_objects.part_of(context.active_object))
        self._made, self._stage, self._share, self._result = [], "", 0.0, {"CANCELLED"}
        try:
            if part is None:
                raise PartError("no part is active; select one")
            self._sardf, self._plan = core.load(), bake_plan.make(context)
            if self._plan.target is not None:
                raise PartError(
                    "pieces have no mesh of before to be baked on: choose another UV Map than "
                    "Existing"
                )
            depsgraph = context.evaluated_depsgraph_get()
            self._wanted = part_pieces.requests_of(part, self._plan.request, depsgraph)
        except bake_plan.expected() as error:
            self.report({"ERROR"}, str(error))
            return False
        for text in self._plan.warnings:
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
            if not isinstance(error, bake_plan.expected()):
                traceback.print_exception(error)  # ours to mend: show where
            self.report({"ERROR"}, str(error))
            return False
        return True

    def _work(self, context):
        """Yields what is being done."""
        count = len(self._wanted)
        for number, (piece, request) in enumerate(self._wanted):
            name = f"{self._part[0]} piece {piece.code}"
            textures = bake_plan.store_of(context.scene.sardf, name, self._plan.packed)
            running = SARDF_OT_bake.job = job.Job(
                self._sardf, dataclasses.replace(request, store=textures)
            )
            while running.running:
                if running.to_unwrap is not None and unwrap.can_unwrap(context):
                    running.go_on(unwrap.smart(context, running.to_unwrap, request.size))
                self._share = (number + running.share) / count
                yield f"baking piece {number + 1} of {count}, {100 * running.share:.0f} %"
            if isinstance(running.error, job.NothingLeft):
                continue
            if running.error is not None:
                raise running.error
            self._made.append((piece, running.part))
        yield "making objects"
        self._commit(context)

    def _commit(self, context):
        part = part_bake.find(self._part)
        kept = {piece.code for piece, _ in self._made}
        for code, item in part_pieces.find(part).items():
            if code not in kept:  # the sections cut no such piece any more
                bpy.data.objects.remove(item)
        if not any("1" not in code for code in kept):
            part_bake.place_nothing(part, self._wanted[0][0].scene)
        SARDF_OT_bake.job = None
        count = len(self._made)
        while self._made:
            piece, arrays = self._made[0]
            built = assemble.build_images(self._sardf, arrays, self._plan.packed)
            part_pieces.place(context.scene, part, piece, arrays, built)
            self._made.pop(0)
        self.report({"INFO"}, f"Baked {count} pieces of {part.name}")
        self._result = {"FINISHED"}

    def _drop(self):
        if SARDF_OT_bake.job is not None:
            SARDF_OT_bake.job.cancel()
        SARDF_OT_bake.job = None
        for _, arrays in self._made:
            arrays.store.discard()
        self._made = []

    def _end(self, context):
        SARDF_OT_bake.job = None
        bake_operator.stop(context)


def register():
    bpy.utils.register_class(SARDF_OT_bake_pieces)


def unregister():
    bpy.utils.unregister_class(SARDF_OT_bake_pieces)

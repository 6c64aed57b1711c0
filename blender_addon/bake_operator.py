# SPDX-License-Identifier: GPL-3.0-or-later
"""The bake: of the active part or of the panel's scene file, with a window or without."""

import dataclasses
import traceback
from typing import ClassVar

import bpy

from . import bake_info, bake_plan, core, window
from .baked import assemble, clock, exact, job, unwrap
from .parts import part_bake, part_objects


class SARDF_OT_bake(window.Polling, bpy.types.Operator):
    """Mesh and bake in a worker thread while Blender stays usable.

    The thread runs job.make_part, writes the textures into a hidden folder and never touches bpy;
    the timer polls it. Blender data is made only when all is there, in one go, so that Esc leaves
    nothing behind and one undo step takes everything back. Without a window the same happens at
    once.
    """

    bl_idname = "sardf.bake"
    bl_label = "Bake"
    bl_description = (
        "Mesh the active object's part, or else the scene file, and bake its materials into "
        "textures (Esc cancels)"
    )
    bl_options: ClassVar[set] = {"UNDO"}

    job = None  # of the session, not of the file: the running job.Job, or None
    watch = window.Watch()
    title = "Bake"

    @classmethod
    def poll(cls, context):
        something = context.scene.sardf.filepath or part_objects.part_above(context.active_object)
        return SARDF_OT_bake.job is None and bool(something)

    def execute(self, context):
        try:
            sardf, plan = core.load(), self._plan(context)
            part = job.make_part(
                sardf, plan.request, None, lambda mesh: self._unwrapped(context, plan, mesh)
            )
            return self._commit(context, plan, part)
        except job.NothingLeft as error:
            return self._commit_nothing(plan, error)
        except bake_plan.expected() as error:
            return self._fail(error)

    def invoke(self, context, _event):
        if bpy.app.background:
            return self.execute(context)
        try:
            sardf, self._made = core.load(), self._plan(context)
        except bake_plan.expected() as error:
            return self._fail(error)
        bake_info.stop()  # what it measures is about to be known
        cost = bake_info.cost(context)
        request = self._made.request
        if cost is not None:
            shares = cost.mesh_seconds, cost.bake_seconds, cost.store_seconds
            request = dataclasses.replace(request, shares=shares)
        self._clock = clock.Clock(None if cost is None else cost.seconds)
        SARDF_OT_bake.job = job.Job(sardf, request)
        self.watch.begin(context, self)
        self._show(context)
        return {"RUNNING_MODAL"}

    def poll_work(self, context):
        running = SARDF_OT_bake.job
        try:
            bake_plan.check(self._made)
            if running.to_unwrap is not None and unwrap.can_unwrap(context):
                running.go_on(self._unwrapped(context, self._made, running.to_unwrap))
            if running.running:
                self._show(context)
                return {"PASS_THROUGH"}
            if running.error is not None:
                raise running.error
            SARDF_OT_bake.job = None  # what it made is ours now
            stop(context)
            return self._commit(context, self._made, running.part)
        except job.NothingLeft as error:
            stop(context)
            return self._commit_nothing(self._made, error)
        except bake_plan.expected() as error:
            stop(context)
            return self._fail(error)
        except Exception as error:
            traceback.print_exception(error)  # ours to mend: show where
            stop(context)
            return self._fail(error)

    def cancel(self, context):
        stop(context)

    def _plan(self, context):
        plan = bake_plan.make(context)
        self._warn(plan.warnings)
        return plan

    def _unwrapped(self, context, plan, mesh):
        return unwrap.smart(context, mesh, plan.request.size)

    def _commit(self, context, plan, part):
        """Make Blender data of what was baked. Raises what bake_plan.expected() lists."""
        settings, sardf = context.scene.sardf, core.load()
        try:
            parent = None if plan.part is None else part_bake.find(plan.part)
            target = plan.target and bake_plan.find_target(plan.target, len(part.mesh.vertices))
            built = assemble.build_images(sardf, part, plan.packed)
        finally:
            part.store.discard()  # nothing, once it is published
        if settings.set_units:
            assemble.set_units(context.scene, part.scene)
        if target is not None:
            item = assemble.place(context.scene, part, built, target, plan.layer)
        elif parent is None:
            item = assemble.place(context.scene, part, built)
        else:
            item = part_bake.place(context.scene, parent, part, built)
        if part.osl is not None:
            exact.use(context.scene)
        for other in context.selected_objects:
            other.select_set(False)
        if item.name in context.view_layer.objects:
            item.select_set(True)
            context.view_layer.objects.active = item
        self._warn(part.warnings)
        self.report(
            {"INFO"},
            f"Baked {part.name}: {len(part.mesh.faces)} faces, {part.texels_per_unit:.3g} texels "
            f"per {part.scene.units}",
        )
        return {"FINISHED"}

    def _commit_nothing(self, plan, error):
        """The baked object of before is emptied; a message says so, and no dialog."""
        if plan.part is not None:
            try:
                part_bake.place_nothing(part_bake.find(plan.part), plan.request.scene)
            except bake_plan.expected() as problem:
                return self._fail(problem)
        self.report({"WARNING"}, str(error))
        return {"FINISHED"}

    def _show(self, context):
        running, share = SARDF_OT_bake.job, SARDF_OT_bake.job.share
        text = clock.progress_text(share, self._clock.left(share))
        if running.to_unwrap is not None:
            text = "waits for Object Mode, to unwrap"
        self.watch.tell(context, f"Baking {text}", share, f"baking {clock.bar(share)} {text}")

    def _warn(self, warnings):
        for text in warnings:
            self.report({"WARNING"}, text)

    def _fail(self, error):
        self.report({"ERROR"}, str(error))
        return {"CANCELLED"}


def stop(context):
    """Stop the thread, forget the job, and take back what the window shows of it."""
    if SARDF_OT_bake.job is not None:
        SARDF_OT_bake.job.cancel()
        SARDF_OT_bake.job = None
    SARDF_OT_bake.watch.end(context)


def register():
    bpy.utils.register_class(SARDF_OT_bake)


def unregister():
    stop(bpy.context)
    bpy.utils.unregister_class(SARDF_OT_bake)

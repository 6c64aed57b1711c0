# SPDX-License-Identifier: GPL-3.0-or-later
"""What the panel's buttons do: load a scene file, bake it or the active part, render it."""

import traceback
from typing import ClassVar

import bpy
from bpy_extras.io_utils import ImportHelper

from . import core, properties
from .baked import assemble, images, job
from .parts import part_bake, part_objects
from .parts.part_error import PartError
from .picture import camera, render, studio

POLL_SECONDS = 0.05


class SARDF_OT_load(bpy.types.Operator, ImportHelper):
    bl_idname = "sardf.load"
    bl_label = "Load sardf Scene"
    bl_description = "Choose a sardf scene file"
    bl_options: ClassVar[set] = {"UNDO"}

    filename_ext = ".json"
    filter_glob: bpy.props.StringProperty(default="*.json", options={"HIDDEN"})

    def execute(self, context):
        settings = context.scene.sardf
        settings.filepath = self.filepath
        summary = properties.read_summary(settings)
        if summary.error:
            self.report({"ERROR"}, summary.error)
            return {"CANCELLED"}
        return {"FINISHED"}


class SARDF_OT_bake(bpy.types.Operator):
    """Mesh and bake in a worker thread while Blender stays usable.

    The thread runs job.make_part and never touches bpy; the timer polls it. Blender data is made
    only when all arrays are there, one image a tick, so that Esc leaves nothing behind and one
    undo step takes everything back. Without a window the same happens in one go.
    """

    bl_idname = "sardf.bake"
    bl_label = "Bake"
    bl_description = (
        "Mesh the active object's part, or else the scene file, and bake its materials into "
        "textures (Esc cancels)"
    )
    bl_options: ClassVar[set] = {"UNDO"}

    job = None  # of the session, not of the file: the running job.Job, or None
    stage = ""  # one line for panel and status bar

    @classmethod
    def poll(cls, context):
        something = context.scene.sardf.filepath or part_objects.part_above(context.active_object)
        return SARDF_OT_bake.job is None and bool(something)

    def execute(self, context):
        try:
            sardf = core.load()
            request = self._request(context)
        except (core.MissingCore, PartError) as error:
            return self._fail(error)
        try:
            part = job.make_part(sardf, request)
        except job.NothingLeft as error:
            return self._commit_nothing(request, error)
        except sardf.Error as error:
            return self._fail(error)
        return self._commit(context, part, dict(_packed_images(part)))

    def _request(self, context):
        """What to bake: the active object's part, or the scene file. Raises PartError."""
        part = part_objects.outermost(part_objects.part_of(context.active_object))
        self._part = None if part is None else part_bake.key_of(part)
        if part is None:
            if not context.scene.sardf.filepath:
                raise PartError("there is nothing to bake: no scene file, and no part is active")
            return properties.request(context.scene.sardf)
        depsgraph = context.evaluated_depsgraph_get()
        request, warnings = part_bake.request_of(part, context.scene.sardf, depsgraph)
        for text in warnings:
            self.report({"WARNING"}, text)
        return request

    def invoke(self, context, _event):
        if bpy.app.background:
            return self.execute(context)
        try:
            sardf = core.load()
            request = self._request(context)
        except (core.MissingCore, PartError) as error:
            return self._fail(error)
        SARDF_OT_bake.job, self._wanted = job.Job(sardf, request), request
        self._images, self._steps = {}, None
        manager = context.window_manager
        self._timer = manager.event_timer_add(POLL_SECONDS, window=context.window)
        manager.modal_handler_add(self)
        self._show(context)
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        if event.type == "ESC" and event.value == "PRESS":
            self._clean_up(context)
            self.report({"INFO"}, "Bake cancelled")
            return {"CANCELLED"}  # the thread ends by itself, within 0.1 s
        if event.type != "TIMER":
            return {"PASS_THROUGH"}
        running = SARDF_OT_bake.job
        if running.running:
            self._show(context)
            return {"PASS_THROUGH"}
        if running.error is not None:
            self._clean_up(context)
            if isinstance(running.error, job.NothingLeft):
                return self._commit_nothing(self._wanted, running.error)
            if not isinstance(running.error, core.load().Error):
                traceback.print_exception(running.error)  # ours to mend: show where
            return self._fail(running.error)
        return self._commit_a_step(context, running.part)

    def cancel(self, context):
        """Blender ends the operator itself: another file is loaded, or the window closes."""
        self._clean_up(context)

    def _commit_a_step(self, context, part):
        if self._steps is None:
            self._steps = _packed_images(part)
        made = next(self._steps, None)
        if made is not None:
            self._images[made[0]] = made[1]
            self._show(context)
            return {"PASS_THROUGH"}
        built, self._images = self._images, {}
        self._clean_up(context)
        return self._commit(context, part, built)

    def _commit(self, context, part, built):
        settings = context.scene.sardf
        try:
            parent = None if self._part is None else part_bake.find(self._part)
        except PartError as error:  # it was deleted meanwhile
            for image in built.values():
                bpy.data.images.remove(image)
            return self._fail(error)
        if settings.set_units:
            assemble.set_units(context.scene, part.scene)
        if parent is None:
            item = assemble.place(context.scene, part, built)
        else:
            item = part_bake.place(context.scene, parent, part, built)
        for other in context.selected_objects:
            other.select_set(False)
        item.select_set(True)
        context.view_layer.objects.active = item
        self.report({"INFO"}, f"Baked {part.name}: {len(part.mesh.faces)} faces")
        return {"FINISHED"}

    def _commit_nothing(self, request, error):
        """The baked object of before is emptied; a message says so, and no dialog."""
        if self._part is not None:
            try:
                part_bake.place_nothing(part_bake.find(self._part), request.scene)
            except PartError as problem:
                return self._fail(problem)
        self.report({"WARNING"}, str(error))
        return {"FINISHED"}

    def _show(self, context):
        running = SARDF_OT_bake.job
        if running.running:
            text = f"Baking {100 * running.share:.0f} %"
        else:
            text = f"Storing textures {len(self._images)}/{len(running.part.maps)}"
        SARDF_OT_bake.stage = text
        context.workspace.status_text_set(f"sardf: {text} (Esc cancels)")
        _redraw(context)

    def _clean_up(self, context):
        """Stop the thread, forget the job, and remove images of an unfinished commit."""
        SARDF_OT_bake.job.cancel()
        SARDF_OT_bake.job = None
        context.window_manager.event_timer_remove(self._timer)
        context.workspace.status_text_set(None)
        for image in self._images.values():
            bpy.data.images.remove(image)
        self._images = {}
        _redraw(context)

    def _fail(self, error):
        self.report({"ERROR"}, str(error))
        return {"CANCELLED"}


class SARDF_OT_render(bpy.types.Operator):
    bl_idname = "sardf.render"
    bl_label = "Render"
    bl_description = "Render the baked part with Cycles"
    bl_options: ClassVar[set] = {"UNDO"}

    @classmethod
    def poll(cls, context):
        source = properties.absolute_path(context.scene.sardf)
        return SARDF_OT_bake.job is None and assemble.find(context.scene, source) is not None

    def execute(self, context):
        return self._render(context)

    def invoke(self, context, _event):
        return self._render(context, *(() if bpy.app.background else ("INVOKE_DEFAULT",)))

    def _render(self, context, *how):
        try:
            sardf = core.load()
        except core.MissingCore as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        try:
            self._prepare(context, sardf)
        except sardf.Error as error:  # the file changed since it was baked
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        bpy.ops.render.render(*how)
        return {"FINISHED"}

    def _prepare(self, context, sardf):
        """Our Cycles settings, and with "Studio" our camera, lights and world."""
        scene = context.scene
        settings = scene.sardf
        render.set_common(scene)
        render.set_shaded(scene, settings.samples)
        if not settings.studio:
            return
        path = properties.absolute_path(settings)
        width, height = scene.render.resolution_x, scene.render.resolution_y
        view = sardf.load(path).camera(width=width, height=height)
        item = assemble.find(scene, path)
        camera.place(scene, view, item.matrix_world)
        context.view_layer.update()
        studio.build(scene, *assemble.ball(item), scene.camera)


def _packed_images(part):
    """(channel, packed image) for each baked channel, made as they are asked for."""
    for channel, array in part.maps.items():
        yield channel, images.build_packed(f"{part.name} {channel}", channel, array)


def _redraw(context):
    for window in context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "VIEW_3D":
                area.tag_redraw()


CLASSES = (SARDF_OT_load, SARDF_OT_bake, SARDF_OT_render)


def register():
    for cls in CLASSES:
        bpy.utils.register_class(cls)


def unregister():
    if SARDF_OT_bake.job is not None:
        SARDF_OT_bake.job.cancel()
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)

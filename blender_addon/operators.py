# SPDX-License-Identifier: GPL-3.0-or-later
"""What the File panel's buttons do: load a scene file, render what was baked of it."""

from typing import ClassVar

import bpy
from bpy_extras.io_utils import ImportHelper

from . import core, properties
from .bake_operator import SARDF_OT_bake
from .baked import assemble
from .picture import camera, render, studio


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


CLASSES = (SARDF_OT_load, SARDF_OT_render)


def register():
    for cls in CLASSES:
        bpy.utils.register_class(cls)


def unregister():
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)

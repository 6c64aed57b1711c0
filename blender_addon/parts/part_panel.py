# SPDX-License-Identifier: GPL-3.0-or-later
"""The active part in the sidebar's tab "sardf", and the menu Add > sardf."""

import bpy

from .. import window
from . import part_bake, part_materials, part_objects, part_properties, part_status, primitives

BLENDS_WITHOUT_RADIUS = ("min_max", "r_function")
SHAPE_ICONS = {
    "sphere": "MESH_UVSPHERE", "ellipsoid": "MESH_ICOSPHERE", "box": "MESH_CUBE",
    "rounded_box": "CUBE", "cylinder": "MESH_CYLINDER", "cone": "MESH_CONE",
    "torus": "MESH_TORUS", "capsule": "MESH_CAPSULE", "half_space": "MESH_PLANE",
    "formula": "SCRIPT",
}  # fmt: skip
OPERATION_ICONS = {"union": "SELECT_EXTEND", "intersection": "SELECT_INTERSECT",
                   "difference": "SELECT_SUBTRACT", "none": "DOT"}  # fmt: skip


class SARDF_UL_entries(bpy.types.UIList):
    def draw_item(self, _context, layout, _data, item, _icon, _active, _property, index=0):
        row = layout.row(align=True)
        gone = item.object is None and not item.text
        gone = gone or (item.object is not None and item.object.library is None
                        and not item.object.users_scene)  # fmt: skip
        row.alert = gone
        row.active = not item.mute
        row.label(icon="ERROR" if gone else OPERATION_ICONS[item.operation])
        row.prop(item, "name", text="", emboss=False)
        if gone:
            row.label(text="deleted")
        elif index > 0 and item.operation != "none" and item.blend != "min_max":
            row.label(text=item.blend)
        row.prop(item, "mute", text="", icon="HIDE_ON" if item.mute else "HIDE_OFF", emboss=False)


class SARDF_UL_materials(bpy.types.UIList):
    def draw_item(self, _context, layout, _data, item, _icon, _active, _property, _index=0):
        row = layout.row(align=True)
        swatch = row.row()
        swatch.ui_units_x = 2
        if item.source:
            swatch.prop(*part_materials.color_property(item.source), text="")
        else:
            swatch.prop(item, "color", text="")
        row.prop(item, "name", text="", emboss=False)


class SARDF_UL_named(bpy.types.UIList):
    """Features and sections: a name, and an object's name beside it."""

    def draw_item(self, _context, layout, _data, item, _icon, _active, _property, _index=0):
        row = layout.row(align=True)
        row.prop(item, "name", text="", emboss=False)
        if getattr(item, "material", ""):
            row.label(text=item.material)
        if hasattr(item, "mute"):
            icon = "HIDE_ON" if item.mute else "HIDE_OFF"
            row.prop(item, "mute", text="", icon=icon, emboss=False)


class _Panel:
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "sardf"

    def draw(self, context):
        self.layout.use_property_split = True
        self.layout.use_property_decorate = False
        part = part_objects.part_above(context.active_object)
        self.draw_part(context, part)


class ListPanel(_Panel):
    """Of one of a part's lists; there is none without a part."""

    bl_parent_id = "SARDF_PT_part"

    @classmethod
    def poll(cls, context):
        return part_objects.part_above(context.active_object) is not None


class SARDF_PT_part(_Panel, bpy.types.Panel):
    bl_idname = "SARDF_PT_part"
    bl_label = "Part"
    bl_order = 1

    def draw_part(self, context, part):
        layout = self.layout
        row = layout.row(align=True)
        row.operator("sardf.part_new", icon="ADD")
        row.operator("sardf.part_import", text="Import", icon="IMPORT")
        if part is None:
            return
        layout.prop(part, "name", text="Part")
        layout.prop(part.sardf_part, "units")
        draw_list(layout, "SARDF_UL_entries", part, "entries", rows=5)
        self._draw_entry(part.sardf_part)
        row = layout.row(align=True)
        row.operator("sardf.part_export", text="Export", icon="EXPORT")
        row.operator("sardf.part_check", text="Check", icon="CHECKMARK")
        if part_bake.is_baked(part):
            layout.prop(part.sardf_part, "show")
        status = part_status.status(part, context.evaluated_depsgraph_get())
        window.lines(layout, [status.error] if status.error else status.lines, bool(status.error))

    def _draw_entry(self, settings):
        entry = chosen(settings.entries, settings.entry_index)
        if entry is None:
            return
        column = self.layout.column()
        column.prop(entry, "operation")
        if entry.operation != "none":
            column.prop(entry, "blend")
            if entry.blend not in BLENDS_WITHOUT_RADIUS:
                column.prop(entry, "radius")
        if entry.object is None:
            column.prop(entry, "text")
            return
        column.prop(entry, "object")
        if entry.object.type in ("CURVE", "MESH"):
            if entry.object.sardf_primitive.kind == part_properties.NO_KIND:
                column.prop(entry, "as_feature")
            else:
                draw_primitive(column, entry.object.sardf_primitive)


class SARDF_PT_materials(ListPanel, bpy.types.Panel):
    bl_idname = "SARDF_PT_materials"
    bl_label = "Materials"

    def draw_part(self, _context, part):
        layout, settings = self.layout, part.sardf_part
        draw_list(layout, "SARDF_UL_materials", part, "materials")
        material = chosen(settings.materials, settings.material_index)
        if material is None:
            return
        column = layout.column()
        column.prop(material, "source")
        for key in ("roughness", "metallic", "emission", "density", "index_of_refraction"):
            column.prop(material, key)


class SARDF_PT_features(ListPanel, bpy.types.Panel):
    bl_idname = "SARDF_PT_features"
    bl_label = "Features"

    def draw_part(self, _context, part):
        layout, settings = self.layout, part.sardf_part
        layout.operator_menu_enum("sardf.preset", "choice", text="Preset", icon="PRESET")
        layout.prop(settings, "rule")
        if settings.rule == "text":
            layout.prop(settings, "rule_text")
            return
        draw_list(layout, "SARDF_UL_named", part, "features")
        feature = chosen(settings.features, settings.feature_index)
        if feature is None:
            return
        column = layout.column()
        column.prop(feature, "object")
        if feature.object is None:
            column.prop(feature, "text")
        elif settings.rule != "partition":
            column.prop(feature, "surface")
            column.prop(feature, "faces")
        if settings.rule == "ramp":
            column.prop(feature, "distance")
        if feature.fractions:
            column.prop(feature, "fractions")
            return
        column.prop_search(feature, "material", settings, "materials")
        column.prop(feature, "function")
        if feature.function:
            column.prop_search(feature, "other", settings, "materials")
        if settings.rule == "inverse_distance":
            column.prop(feature, "exponent")
            column.prop(feature, "influence")


class SARDF_MT_add(bpy.types.Menu):
    bl_idname = "SARDF_MT_add"
    bl_label = "sardf"

    def draw(self, _context):
        layout = self.layout
        layout.operator_context = "EXEC_REGION_WIN"
        for kind in primitives.KINDS:
            title = part_properties.title_of(kind)
            made = layout.operator("sardf.primitive_add", text=title, icon=SHAPE_ICONS[kind])
            made.kind = kind
        layout.separator()
        for kind, icon in (("plane", "MESH_PLANE"), ("box", "MESH_CUBE")):
            text = f"Section {part_properties.title_of(kind)}"
            layout.operator("sardf.section_add", text=text, icon=icon).kind = kind
        layout.separator()
        layout.operator("sardf.part_new", text="Part from Selection", icon="EMPTY_AXIS")


def draw_primitive(layout, settings):
    """The parameters of a primitive."""
    layout.prop(settings, "kind")
    for each in primitives.KINDS.get(settings.kind, ()):
        layout.prop(settings, primitives.property_name(settings.kind, each.word))
    if settings.kind == "cylinder":
        layout.prop(settings, "infinite")
    if settings.kind == "formula":
        layout.prop(settings, "formula")


def chosen(items, index):
    return items[index] if 0 <= index < len(items) else None


def draw_list(layout, kind, part, which, rows=3):
    index = {"entries": "entry_index", "materials": "material_index",
             "features": "feature_index", "sections": "section_index"}[which]  # fmt: skip
    row = layout.row()
    row.template_list(kind, which, part.sardf_part, which, part.sardf_part, index, rows=rows)
    column = row.column(align=True)
    actions = [("add", "ADD"), ("remove", "REMOVE"), ("up", "TRIA_UP"), ("down", "TRIA_DOWN")]
    if which == "entries":
        actions += [("show", "RESTRICT_SELECT_OFF"), ("restore", "LOOP_BACK")]
    for action, icon in actions:
        button = column.operator("sardf.list", text="", icon=icon)
        button.which, button.action = which, action


def _add_menu(self, _context):
    self.layout.menu("SARDF_MT_add", icon="OUTLINER_OB_META")


def _import_menu(self, _context):
    self.layout.operator("sardf.part_import", text="sardf Scene (.json)")


def _export_menu(self, _context):
    self.layout.operator("sardf.part_export", text="sardf Scene (.json)")


CLASSES = (
    SARDF_UL_entries,
    SARDF_UL_materials,
    SARDF_UL_named,
    SARDF_PT_part,
    SARDF_PT_materials,
    SARDF_PT_features,
    SARDF_MT_add,
)
MENUS = (
    ("VIEW3D_MT_add", _add_menu),
    ("TOPBAR_MT_file_import", _import_menu),
    ("TOPBAR_MT_file_export", _export_menu),
)


def register():
    for cls in CLASSES:
        bpy.utils.register_class(cls)
    for name, draw in MENUS:
        getattr(bpy.types, name).append(draw)


def unregister():
    for name, draw in MENUS:
        getattr(bpy.types, name).remove(draw)
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)

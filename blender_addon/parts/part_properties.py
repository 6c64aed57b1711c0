# SPDX-License-Identifier: GPL-3.0-or-later
"""What the .blend keeps of parts and primitives, as properties of ordinary objects.

A part is an Empty with `sardf_part.is_part`; its entries point to other objects. A primitive is an
object with `sardf_primitive.kind`. There is no other state. Tooltips of what the core knows are
the core's own.
"""

import bpy

from . import primitives, words

VERSION = 1  # of these properties; a part says with which it was made
OPERATIONS = ("union", "intersection", "difference")
RULES = ("inverse_distance", "blend_between", "ramp", "partition")
UNITS = ("um", "mm", "cm", "m", "in")
NO_KIND = "none"
HIDDEN = "sardf_hidden"  # custom property of a baked object: we hid it for the preview
SHOWN = (  # of a part: (choice, title, tooltip, number)
    ("newer", "What Is Newer", "The preview, unless the baked object is up to date and visible", 0),
    ("preview", "Preview", "The preview; choosing it hides the baked object in viewports", 1),
    ("baked", "Baked", "The baked object; choosing it makes it visible", 2),
)

_draw = None  # set by part_objects: draws a primitive's wireframe anew


def on_shape_change(draw):
    """`draw(object)` is called whenever a property of a primitive changes."""
    global _draw
    _draw = draw


def _shape_changed(primitive, context):
    _changed(primitive, context)
    if _draw is not None:
        _draw(primitive.id_data)


def _changed(group, _context):
    """Blender itself evaluates an object anew only after changes of properties that have an
    update function; then drivers see the change, too, and so do handlers."""
    group.id_data.update_tag()


def _shown_changed(settings, context):
    """Hides the baked object for the preview, and shows it again; what the user hid stays hidden
    until the baked object is asked for."""
    _changed(settings, context)
    baked = settings.baked
    if baked is None or baked.name not in context.view_layer.objects:
        return
    if settings.show == "preview" and not baked.hide_get():
        baked.hide_set(True)
        baked[HIDDEN] = True
    elif settings.show == "baked" or (settings.show == "newer" and HIDDEN in baked):
        baked.hide_set(False)
        baked.pop(HIDDEN, None)


def _group(name, properties):
    """A PropertyGroup class made of a dictionary, since its texts are found when it is made."""
    return type(name, (bpy.types.PropertyGroup,), {"__annotations__": properties})


def _text(name, description, **more):
    more = {"update": _changed} | more
    return bpy.props.StringProperty(name=name, description=description, **more)


def _flag(name, description, default=False, **more):
    more = {"update": _changed} | more
    return bpy.props.BoolProperty(name=name, description=description, default=default, **more)


def _object(name, description):
    return bpy.props.PointerProperty(
        type=bpy.types.Object, name=name, description=description, update=_changed
    )


def title_of(word):
    return word.replace("_", " ").title()


def _primitive():
    numbers = {
        primitives.property_name(kind, each.word): bpy.props.FloatProperty(
            name=title_of(each.word),
            description=words.about_parameter(kind, each.word)
            + ("" if each.absolute else "; in the object's own units, scaled with it"),
            default=each.default,
            min=each.least,
            update=_shape_changed,
        )
        for kind, parameters in primitives.KINDS.items()
        for each in parameters
    }
    return numbers | {
        "kind": bpy.props.EnumProperty(
            name="Shape",
            description="Which field the object stands for",
            items=[(NO_KIND, "None", "An ordinary object", 0)]
            + [
                (kind, title_of(kind), kind_text(kind), 1 + number)
                for kind, number in primitives.NUMBERS.items()
            ],
            update=_shape_changed,
        ),  # fmt: skip
        "infinite": _flag(
            "Infinite", words.about_parameter("cylinder", "height"), update=_shape_changed
        ),
        "formula": _text(
            "Formula",
            "A function of x, y and z in the object's own frame, positive inside: 1 - x^2 - y^2",
            default="1 - x^2 - y^2 - z^2",
        ),
    }


def kind_text(kind):
    """The tooltip of a primitive."""
    if kind == "formula":
        return "A solid by a formula of x, y and z in the object's own frame, positive inside"
    return words.about(kind)


def _entry():
    operations = [
        (name, title_of(name), words.about(name), number) for number, name in enumerate(OPERATIONS)
    ]
    none = ("none", "Field Only", "No part of the solid, but features and formulas may name it", 9)
    return {
        "object": _object("Object", "The object that the entry reads"),
        "field": _text("Name in Scene", "The entry's name in scene files and formulas"),
        "text": _text("Field", "A field's name, a formula that starts with =, or a field as JSON"),
        "operation": bpy.props.EnumProperty(
            name="Operation",
            description="How the entry joins the entries above it",
            items=[*operations, none],
            update=_changed,
        ),
        "blend": bpy.props.EnumProperty(
            name="Blend",
            description="How the entry and what is above it are joined where they meet",
            items=[(name, name, text, number) for name, text, number in words.blends()],
            default="min_max",
            update=_changed,
        ),
        "radius": bpy.props.FloatProperty(
            name="Radius",
            description=words.about_parameter_of_blend("sardf") + "; 0 joins as min_max does",
            default=0.5,
            min=0.0,
            soft_max=10.0,
            update=_changed,
        ),
        "mute": _flag("Mute", "Leave the entry out of the solid"),
        "as_feature": _flag(
            "As Feature",
            "The distance to the curve or to the mesh's surface, instead of a solid",
        ),
        "inline": _flag("Inline", "Written where it is used, without a name", options={"HIDDEN"}),
    }


def _material():
    def number(name, key, default, **limits):
        text = words.about_material(key) or key
        return bpy.props.FloatProperty(
            name=name, description=text, default=default, update=_changed, **limits
        )

    return {
        "color": bpy.props.FloatVectorProperty(
            name="Color", description="Linear colour of the pure material", size=3,
            subtype="COLOR", default=(0.6, 0.6, 0.6), min=0.0, max=1.0,
            update=_changed,
        ),
        "source": bpy.props.PointerProperty(
            type=bpy.types.Material, name="Blender Material",
            description="A Blender material whose base colour this one follows", update=_changed,
        ),
        "roughness": number("Roughness", "roughness", 0.5, min=0.0, max=1.0),
        "metallic": number("Metallic", "metallic", 0.0, min=0.0, max=1.0),
        "emission": bpy.props.FloatVectorProperty(
            name="Emission", description="Linear colour that it gives off", size=3,
            subtype="COLOR", default=(0.0, 0.0, 0.0), min=0.0, soft_max=1.0,
            update=_changed,
        ),
        "density": number("Density", "density", 0.0, min=0.0),
        "index_of_refraction": number(
            "Index of Refraction", "index_of_refraction", 0.0, min=0.0
        ),
    }  # fmt: skip


def _feature():
    return {
        "object": _object("Object", words.about_feature("at")),
        "text": _text("Field", "A field's name or a formula that starts with =; " + "where no "
                      "object is chosen"),
        "surface": _flag("Surface", words.about("boundary"), default=True),
        "faces": _text("Faces", words.about_parameter("boundary", "faces")),
        "material": _text("Material", words.about_feature("material")),
        "other": _text("Rest", "The material that fills what the function leaves"),
        "function": _text(
            "Function",
            "The material's share as a formula of u, the distance to the feature: exp(-u^2)",
        ),
        "exponent": bpy.props.FloatProperty(
            name="Exponent", description=words.about_feature("exponent"), default=1.0, min=1e-3,
            update=_changed,
        ),
        "influence": _text("Influence", words.about_feature("influence")),
        "distance": bpy.props.FloatProperty(
            name="Distance", description="Where along the first feature's field the stop lies",
            update=_changed,
        ),
        "fractions": _text("Fractions", "A rule as JSON, in place of a material"),
    }  # fmt: skip


def _section():
    return {
        "object": _object("Object", "What it covers is removed; an Empty removes what +z sees"),
        "operation": bpy.props.EnumProperty(
            name="Cuts",
            description="How the section cuts together with the one above it",
            items=[
                ("union", "By Itself", "What it covers is removed", 0),
                ("intersection", "With Above", "Only what the one above covers too is removed", 1),
            ],
            update=_changed,
        ),
        "keep": _text("Keep", "Names of fields that stay whole, separated by commas"),
        "text": _text("Section", "A section as JSON, where no object is chosen"),
        "mute": _flag("Mute", "Do not cut"),
    }


def _section_object():
    return {
        "is_section": _flag("Is a Section", "Whether the object was made to cut parts",
                            options={"HIDDEN"}),
        "everywhere": _flag("All Parts", "Cut all parts of the scene, not only those that list it"),
        "mute": _flag("Mute", "Do not cut"),
        "spread": bpy.props.FloatProperty(
            name="Spread",
            description=(
                "How far the piece that it takes off is moved along its z axis, in scene units, "
                "when pieces are baked"
            ),
            default=0.0, update=_changed,
        ),
    }  # fmt: skip


def _part(entry, material, feature, section):
    def items(of, name, description):
        return bpy.props.CollectionProperty(type=of, name=name, description=description)

    def index(name):
        return bpy.props.IntProperty(name=name, description=f"The chosen one of the {name}", min=0)

    rules = [("none", "First Material", "The first material everywhere", 0)]
    rules += [(name, title_of(name), words.about_rule(name), 1 + n) for n, name in enumerate(RULES)]
    rules += [("text", "As in File", "A rule as JSON text", 99)]
    hidden = {"HIDDEN"}
    return {
        "is_part": _flag("Is a Part", "Whether the object is a part", options=hidden),
        "version": bpy.props.IntProperty(
            name="Version", description="Of the add-on's properties", options=hidden
        ),
        "entries": items(entry, "Entries", "The objects that make the part, joined in this order"),
        "entry_index": index("entries"),
        "materials": items(material, "Materials", "What the part may be made of"),
        "material_index": index("materials"),
        "features": items(feature, "Features", "Where which material is, by distances to objects"),
        "feature_index": index("features"),
        "sections": items(section, "Sections", "The objects that cut this part"),
        "section_index": index("sections"),
        "scene_sections": _flag(
            "Sections of All Parts", "Whether section objects that cut all parts cut this one",
            default=True,
        ),
        "show": bpy.props.EnumProperty(
            name="Show",
            description="What is seen of a part that is previewed and baked at the same place",
            items=SHOWN, update=_shown_changed,
        ),
        "rule": bpy.props.EnumProperty(
            name="Rule", description="How the features make the fractions of the materials",
            items=rules, update=_changed,
        ),
        "rule_text": _text("Rule as Text", "A fraction rule of scene files, as JSON"),
        "units": bpy.props.EnumProperty(
            name="Unit", description="What one Blender unit stands for",
            items=[(unit, unit, f"One Blender unit is one {unit}", n)
                   for n, unit in enumerate(UNITS)],
            default="mm", update=_changed,
        ),
        "solid_field": _text("Solid", "The name of the solid's field in the file", options=hidden),
        "imported": _text("Imported", "The scene file's document", options=hidden),
        "generated": _text("Generated", "What the objects gave right then", options=hidden),
        "folder": _text("Folder", "What file names in the scene are relative to", options=hidden),
        "baked": _object("Baked", "The mesh object that the last bake made"),
    }  # fmt: skip


_registered = []


def register():
    def made(name, properties):
        cls = _group(name, properties)
        bpy.utils.register_class(cls)
        _registered.append(cls)
        return cls

    bpy.types.Object.sardf_section = bpy.props.PointerProperty(
        type=made("SardfSectionObject", _section_object())
    )
    bpy.types.Object.sardf_primitive = bpy.props.PointerProperty(
        type=made("SardfPrimitive", _primitive())
    )
    groups = (
        made("SardfEntry", _entry()),
        made("SardfMaterial", _material()),
        made("SardfFeature", _feature()),
        made("SardfSection", _section()),
    )
    bpy.types.Object.sardf_part = bpy.props.PointerProperty(type=made("SardfPart", _part(*groups)))


def unregister():
    del bpy.types.Object.sardf_part
    del bpy.types.Object.sardf_primitive
    del bpy.types.Object.sardf_section
    while _registered:
        bpy.utils.unregister_class(_registered.pop())

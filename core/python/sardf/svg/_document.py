"""The drawn elements of an SVG file with their lines, transforms and names."""

import re
from dataclasses import dataclass
from xml.parsers import expat

import numpy as np

from sardf._command import located_error
from sardf.svg._lengths import matrix_of, view_size

SVG = "http://www.w3.org/2000/svg"
LABEL = "http://www.inkscape.org/namespaces/inkscape label"
SHAPES = ("path", "rect", "circle", "ellipse", "polygon", "polyline", "line")
GROUPS = ("svg", "g", "a", "switch")
NO_CONTOURS = {
    "text": "text has no contour; turn it into paths (Inkscape: Path > Object to Path)",
    "image": "an image has no contour; trace it, or remove it",
    "use": "clones are not read; turn them into paths (Inkscape: Edit > Clone > Unlink Clone)",
    "foreignObject": "foreign objects have no contour; remove it",
    "svg": "drawings inside a drawing are not read; ungroup it",
}
CUTTING = ("clip-path", "mask")
# What a style sheet may say although only attributes are read here.
GEOMETRY = ("d", "x", "y", "cx", "cy", "r", "rx", "ry", "transform")


@dataclass
class Element:
    """One drawn element; `matrix` (3, 3) leads from its coordinates to those of the drawing."""

    file: str
    line: int
    tag: str
    attributes: dict
    matrix: np.ndarray
    name: str
    problem: str  # why it cannot be read, or ""
    view: tuple | None  # width and height of the viewBox

    @property
    def is_shape(self):
        return self.tag in SHAPES

    def check_kind(self):
        if self.problem:
            self.fail(self.problem)

    def fail(self, message):
        named = self.attributes.get("id") or self.attributes.get(LABEL)
        shown = f'<{self.tag} id="{named}">' if named else f"<{self.tag}>"
        raise located_error(message, self.file, self.line, shown)


@dataclass
class Place:
    """What holds inside an element: what its children inherit."""

    matrix: np.ndarray
    drawn: bool
    cut: str


def read_document(path):
    """Every drawn element in the order of the file, those that have no contour too."""
    try:
        with open(path, "rb") as file:
            text = file.read()
    except OSError as error:
        raise located_error(f"cannot be read: {error.strerror}", path) from None
    reader = Reader(str(path))
    try:
        reader.parser.Parse(text, True)
    except expat.ExpatError as error:
        said = expat.ErrorString(error.code)
        raise located_error(f"this is no XML: {said}", path, error.lineno) from None
    return reader.elements


class Reader:
    def __init__(self, file):
        self.file = file
        self.elements = []
        self.places = [Place(np.eye(3), True, "")]
        self.view = None
        self.unnamed = 0
        self.style = None  # text of the <style> that is being read
        self.parser = expat.ParserCreate(namespace_separator=" ")
        self.parser.StartElementHandler = self.start
        self.parser.EndElementHandler = self.end
        self.parser.CharacterDataHandler = self.text

    def start(self, full_name, attributes):
        namespace, _, tag = full_name.rpartition(" ")
        element = self.element(tag, attributes)
        outermost = len(self.places) == 1
        if outermost and (tag != "svg" or namespace not in (SVG, "")):
            element.fail("this is no SVG drawing; its outermost element must be <svg>")
        if outermost:
            self.view = view_size(attributes, element.fail)
        style = style_of(attributes)
        outside = self.places[-1]
        drawn = outside.drawn and namespace in (SVG, "") and style.get("display") != "none"
        readable = drawn and (tag in GROUPS or tag in SHAPES or tag in NO_CONTOURS)
        place = Place(outside.matrix, readable, outside.cut)
        if readable:
            place.matrix = outside.matrix @ matrix_of(attributes.get("transform"), element.fail)
            place.cut = outside.cut or cutting(tag, style)
            if tag not in GROUPS or (tag == "svg" and not outermost):
                self.add(element, place, style)
        elif drawn and tag == "style":
            self.style = ""
        self.places.append(place)

    def element(self, tag, attributes):
        line = self.parser.CurrentLineNumber
        return Element(self.file, line, tag, attributes, np.eye(3), "", "", self.view)

    def add(self, element, place, style):
        element.matrix = place.matrix
        element.problem = NO_CONTOURS.get(element.tag) or place.cut
        geometry = [key for key in GEOMETRY if key in style and key not in element.attributes]
        if not element.problem and geometry:
            element.problem = f"its style sets '{geometry[0]}'; only attributes are read for that"
        if element.is_shape:
            element.name = self.name_of(element.attributes)
        self.elements.append(element)
        place.drawn = False  # nothing inside a shape or a text is drawn by itself

    def name_of(self, attributes):
        given = attributes.get("id") or attributes.get(LABEL)
        if given:
            name = re.sub(r"[^A-Za-z0-9_]", "_", given)
            return f"_{name}" if name[0].isdigit() else name
        self.unnamed += 1
        return f"path_{self.unnamed}"

    def text(self, text):
        if self.style is not None:
            self.style += text

    def end(self, _):
        self.places.pop()
        if self.style is None:
            return
        found = re.search(r"(?:^|[{;\s])(clip-path|mask|transform|display|d)\s*:", self.style)
        self.style = None
        if found:
            self.element("style", {}).fail(
                f"a style sheet sets '{found[1]}'; only the elements' own attributes are read"
            )


def style_of(attributes):
    """Presentation attributes with those of the style attribute over them."""
    pairs = [rule.partition(":") for rule in attributes.get("style", "").split(";")]
    own = {key.strip(): value.strip() for key, colon, value in pairs if colon}
    given = {key: attributes[key] for key in ("display", *CUTTING) if key in attributes}
    return given | own


def cutting(tag, style):
    found = next((key for key in CUTTING if style.get(key, "none") != "none"), None)
    return f"<{tag}> has a {found}, which is not read; apply or release it" if found else ""

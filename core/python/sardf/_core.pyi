"""
Heterogeneous solids by distances: the compiled core.
"""
from __future__ import annotations
import collections.abc
import numpy
import numpy.typing
import typing
__all__: list[str] = ['Blend', 'Cancelled', 'Error', 'Field', 'Mesh', 'MinMax', 'RFunction', 'Sardf', 'SardfC1', 'Scene', 'Smooth', 'arc', 'bend', 'blend_error', 'boundary', 'box', 'box2d', 'capsule', 'circle', 'complement', 'cone', 'cylinder', 'difference', 'disc', 'ellipse', 'ellipsoid', 'extrude', 'formula', 'half_plane', 'half_space', 'implicit_polygon', 'intersection', 'load', 'loft', 'mirror', 'offset', 'point', 'points', 'polygon', 'polyline', 'quadric', 'repeat', 'revolve', 'rotate', 'rounded_box', 'scale', 'schema', 'segment', 'shell', 'sphere', 'torus', 'translate', 'twist', 'union', 'with_blend', 'x', 'y', 'z']
class Error(ValueError):
    """
    Bad input. file, line and pointer say where, message what and what is accepted.
    """
class Cancelled(Exception):
    pass
class Blend:
    """
    How two fields are joined.
    """
    def __repr__(self) -> str:
        ...
    @property
    def name(self) -> str:
        ...
    @property
    def parameters(self) -> list[float]:
        ...
class Field:
    """
    Scalar function of position; for solids positive inside. Between solids | & - join with the current blend; + - * / ** do arithmetic.
    """
    def __add__(self, arg0: typing.Any) -> Field:
        ...
    def __and__(self, arg0: Field) -> Field:
        ...
    def __call__(self, points: typing.Any) -> typing.Any:
        """
        Values at points (N, 3): float64 on the exact path, float32 on the SIMD path. (N,)
        """
    def __mul__(self, arg0: typing.Any) -> Field:
        ...
    def __neg__(self) -> Field:
        ...
    def __or__(self, arg0: Field) -> Field:
        ...
    def __pow__(self, arg0: typing.Any) -> Field:
        ...
    def __radd__(self, arg0: typing.Any) -> Field:
        ...
    def __rmul__(self, arg0: typing.Any) -> Field:
        ...
    def __rsub__(self, arg0: typing.Any) -> Field:
        ...
    def __rtruediv__(self, arg0: typing.Any) -> Field:
        ...
    def __sub__(self, arg0: typing.Any) -> Field:
        ...
    def __truediv__(self, arg0: typing.Any) -> Field:
        ...
    def error_bound(self) -> float:
        """
        Certified max |f - the same tree with min/max|; inf for r_function.
        """
    def gradient(self, points: typing.Any) -> typing.Any:
        """
        Gradients at points (N, 3). At a kink one branch's; NaN where no direction exists.
        """
    def interval(self, lo: typing.Annotated[collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex], "FixedSize(3)"], hi: typing.Annotated[collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex], "FixedSize(3)"]) -> tuple[float, float]:
        """
        Certified (low, high) of the values over the box.
        """
    def lipschitz(self, lo: typing.Annotated[collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex], "FixedSize(3)"], hi: typing.Annotated[collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex], "FixedSize(3)"]) -> float:
        """
        Certified bound of the gradient's length over the box; may be inf.
        """
    @property
    def exactness(self) -> tuple[str, str]:
        """
        ('exact' | 'bound' | 'estimate') inside and outside.
        """
class Mesh:
    """
    A closed surface of quads, wound counter-clockwise from outside.
    """
    def __init__(self) -> None:
        ...
    @property
    def creases(self) -> numpy.typing.NDArray[numpy.uint32]:
        """
        (C, 2) vertex pairs across which the normal jumps.
        """
    @property
    def faces(self) -> numpy.typing.NDArray[numpy.uint32]:
        """
        (F, 4) vertex indices; a triangle repeats its last one.
        """
    @faces.setter
    def faces(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.uint32]) -> None:
        ...
    @property
    def normals(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (4 F, 3) unit outward normals, one for each corner of each face.
        """
    @normals.setter
    def normals(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> None:
        ...
    @property
    def uv(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (4 F, 2) texture coordinates in [0, 1], v upwards.
        """
    @uv.setter
    def uv(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> None:
        ...
    @property
    def vertices(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (V, 3) scene units.
        """
    @vertices.setter
    def vertices(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> None:
        ...
class Scene:
    """
    A solid, what it is made of, and how it is shown.
    """
    @staticmethod
    def from_json(text: str, fields: collections.abc.Mapping[str, Field] = {}) -> Scene:
        """
        A scene from a scene file's text; `fields` are names it may use besides its own.
        """
    def bake(self, mesh: Mesh, size: typing.SupportsInt | typing.SupportsIndex = 2048, channels: collections.abc.Sequence[str] = ['base_color', 'fractions'], gutter: typing.SupportsInt | typing.SupportsIndex = 8, sections: bool = True, progress: typing.Any = None) -> dict:
        """
        {channel: float32 (size, size, components)}, row 0 at the top, linear. Channels: base_color, roughness, metallic, emission, fractions (as fractions_1, ... of three materials each), field, and attributes by name.
        """
    def camera(self, width: typing.SupportsInt | typing.SupportsIndex = 640, height: typing.SupportsInt | typing.SupportsIndex = 480) -> typing.Any:
        """
        A camera that frames the object: matrix_world, lens (mm), sensor_width, ...
        """
    def fractions(self, points: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], outside: str = 'extend') -> numpy.typing.NDArray[numpy.float64]:
        """
        Volume fractions at points (N, 3): (N, materials), rows sum to 1. outside='nan' marks points outside the solid.
        """
    def mesh(self, resolution: typing.SupportsInt | typing.SupportsIndex = 128, cell_size: typing.SupportsFloat | typing.SupportsIndex = 0.0, sections: bool = True, size: typing.SupportsInt | typing.SupportsIndex = 2048, gutter: typing.SupportsInt | typing.SupportsIndex = 8, progress: typing.Any = None) -> Mesh:
        """
        The surface with texture coordinates for a texture of `size`². resolution: cells along the longest side; cell_size (scene units) instead when > 0. progress(share) may return False to cancel, which raises Cancelled.
        """
    def povray(self, path: str, render: str = '', camera: typing.Any = None, look: str = 'shaded', width: typing.SupportsInt | typing.SupportsIndex = 640, height: typing.SupportsInt | typing.SupportsIndex = 480, progress: typing.Any = None) -> None:
        """
        Writes path (.pov) and the .inc beside it, for POV-Ray 3.7; renders them to `render` (.exr or .png) unless it is empty. camera: as camera() gives it; look: shaded, flat (the colours alone) or normals.
        """
    def save(self, path: str) -> None:
        """
        Writes a scene file.
        """
    def section(self, remove: Field, keep: collections.abc.Sequence[Field] = []) -> Scene:
        """
        The scene with one more cut: `remove` is taken away, the `keep` solids stay whole.
        """
    def to_json(self) -> str:
        """
        The scene as a scene file's text.
        """
    def with_blend(self, blend: Blend) -> Scene:
        """
        The scene with every union, intersection and difference joined by `blend` in place of its own.
        """
    @property
    def attributes(self) -> dict:
        """
        {name: function of points (N, 3)}.
        """
    @property
    def bounds(self) -> tuple[typing.Annotated[list[float], "FixedSize(3)"], typing.Annotated[list[float], "FixedSize(3)"]]:
        """
        Certified (lo, hi): outside them the solid is proven empty.
        """
    @property
    def drawn(self) -> Field:
        """
        The solid with its sections cut away.
        """
    @property
    def fields(self) -> dict:
        """
        {name: Field} of the scene's named fields.
        """
    @property
    def materials(self) -> list[str]:
        """
        Names, in order.
        """
    @property
    def metres_per_unit(self) -> float:
        ...
    @property
    def section_count(self) -> int:
        ...
    @property
    def solid(self) -> Field:
        ...
    @property
    def title(self) -> str:
        ...
    @property
    def units(self) -> str:
        ...
def MinMax() -> Blend:
    """
    MinMax()
    
    The smaller field: creases, the distance error is 0.
    """
def RFunction() -> Blend:
    """
    RFunction()
    
    x + y - sqrt(x² + y²): smooth off the edge, no distance.
    """
def Sardf(radius: float) -> Blend:
    """
    Sardf(radius)
    
    Rounded in the band |x - y| < R: zero set and sign of min/max, error at most 0.2929 R.
    
    radius: R, the largest radius of the rounded level lines (scene units); positive
    """
def SardfC1(radius: float) -> Blend:
    """
    SardfC1(radius)
    
    As sardf with a radius that grows smoothly: continuously differentiable off the edge.
    
    radius: R, the largest radius of the rounded level lines (scene units); positive
    """
def Smooth(k: float) -> Blend:
    """
    Smooth(k)
    
    min - max(k - |x - y|, 0)²/(4k): it moves the surface by up to k/4 near an edge.
    
    k: width of the band |x - y| < k that is blended (scene units); positive
    """
def _fail(arg0: str) -> None:
    ...
def _set_blend(blend: Blend) -> Blend:
    """
    Sets the blend that booleans take when none is given; the former one.
    """
def arc(center: typing.Sequence[float] = ..., radius: float = ..., start: float = ..., end: float = ...) -> Field:
    """
    arc(center=(0, 0, 0), radius, start, end)
    
    The distance to a circular arc parallel to the xy plane.
    
    center: the middle of its circle (scene units)
    radius: its radius (scene units); positive
    start: where it starts, counter-clockwise from +x (degrees)
    end: where it ends: more than start, by at most 360 (degrees)
    """
def bend(field: Field | float | str, radius: float) -> Field:
    """
    bend(field, radius)
    
    A field bent about an axis parallel to y, so that what lies along x at z = 0 becomes an arc towards +z of equal length. At d from the axis its slope is at most max(1, radius/d) times the field's; on the axis it is not bounded.
    
    field: what is bent; it should lie within half a turn of x = 0
    radius: of the arc that z = 0 becomes (scene units); positive
    """
def blend_error(field: Field | float | str) -> Field:
    """
    blend_error(field)
    
    How far blending moves a field: the field minus the same tree with minima and maxima. It is no distance.
    
    field: the field
    """
def boundary(solid: Field | float | str) -> Field:
    """
    boundary(solid)
    
    The distance to a solid's surface, from either side.
    
    solid: the solid
    """
def box(center: typing.Sequence[float] = ..., size: typing.Sequence[float] = ...) -> Field:
    """
    box(center=(0, 0, 0), size)
    
    A block with its edges along x, y and z.
    
    center: its middle (scene units)
    size: full edge lengths (scene units); positive
    """
def box2d(center: typing.Sequence[float] = ..., size: typing.Sequence[float] = ...) -> Field:
    """
    box2d(center=(0, 0), size)
    
    A rectangle in the xy plane.
    
    center: its middle (scene units)
    size: full edge lengths (scene units); positive
    """
def capsule(a: typing.Sequence[float], b: typing.Sequence[float], radius: float) -> Field:
    """
    capsule(a, b, radius)
    
    All points within a radius of a segment.
    
    a: one end of the segment (scene units)
    b: the other end (scene units)
    radius: its radius (scene units); positive
    """
def circle(center: typing.Sequence[float] = ..., radius: float = ..., axis: str | typing.Sequence[float] = ...) -> Field:
    """
    circle(center=(0, 0, 0), radius, axis=(0, 0, 1))
    
    The distance to a circular line.
    
    center: its middle (scene units)
    radius: its radius (scene units); positive
    axis: direction perpendicular to its plane
    """
def complement(field: Field | float | str) -> Field:
    """
    complement(field)
    
    All points outside the solid.
    
    field: the solid
    """
def cone(center: typing.Sequence[float] = ..., axis: str | typing.Sequence[float] = ..., radius_bottom: float = ..., radius_top: float = ..., height: float = ...) -> Field:
    """
    cone(center=(0, 0, 0), axis=(0, 0, 1), radius_bottom, radius_top=0, height)
    
    A cone or truncated cone with flat ends.
    
    center: the middle of its axis (scene units)
    axis: direction from the bottom to the top
    radius_bottom: radius of the lower end (scene units); not negative
    radius_top: radius of the upper end; 0: a tip (scene units); not negative
    height: full height (scene units); positive
    """
def cylinder(center: typing.Sequence[float] = ..., axis: str | typing.Sequence[float] = ..., radius: float = ..., height: float = ...) -> Field:
    """
    cylinder(center=(0, 0, 0), axis=(0, 0, 1), radius, height=None)
    
    A round bar, capped or, without a height, infinite.
    
    center: the middle of its axis (scene units)
    axis: direction of its axis
    radius: its radius (scene units); positive
    height: full height; none: infinite (scene units); positive
    """
def difference(*of: Field, blend: Blend = ...) -> Field:
    """
    difference(*of, blend=None)
    
    The first solid without the others, one after the other.
    
    of: the solid, then what is removed
    blend: how they are joined
    """
def disc(center: typing.Sequence[float] = ..., radius: float = ...) -> Field:
    """
    disc(center=(0, 0), radius)
    
    A disc in the xy plane.
    
    center: its middle (scene units)
    radius: its radius (scene units); positive
    """
def ellipse(center: typing.Sequence[float] = ..., radii: typing.Sequence[float] = ...) -> Field:
    """
    ellipse(center=(0, 0), radii)
    
    An ellipse in the xy plane with its axes along x and y.
    
    center: its middle (scene units)
    radii: its two radii, their ratio at most 200 (scene units); positive
    """
def ellipsoid(center: typing.Sequence[float] = ..., radii: typing.Sequence[float] = ...) -> Field:
    """
    ellipsoid(center=(0, 0, 0), radii)
    
    An ellipsoid with its axes along x, y and z.
    
    center: its middle (scene units)
    radii: its three radii, their ratio at most 200 (scene units); positive
    """
def extrude(field: Field | float | str, height: float) -> Field:
    """
    extrude(field, height)
    
    A plane field given a height along z, centred on z = 0.
    
    field: a field of x and y
    height: full height (scene units); positive
    """
def formula(text: str, **kwargs) -> Field:
    """
    formula(text, **names)
    
    A field from a formula over x, y, z, pi and the given fields or numbers, e.g. formula("sin(k*x) + part", k=2, part=box).
    """
def half_plane(point: typing.Sequence[float] = ..., normal: typing.Sequence[float] = ...) -> Field:
    """
    half_plane(point=(0, 0), normal)
    
    All of the xy plane on one side of a line.
    
    point: a point of the line (scene units)
    normal: perpendicular to the line, pointing inwards; of any length but 0
    """
def half_space(point: typing.Sequence[float] = ..., normal: str | typing.Sequence[float] = ...) -> Field:
    """
    half_space(point=(0, 0, 0), normal=(0, 0, 1))
    
    All points on one side of a plane: an unbounded solid.
    
    point: a point of the plane (scene units)
    normal: direction that points into the solid
    """
def implicit_polygon(vertices: typing.Sequence[typing.Sequence[float]] | numpy.ndarray, blend: Blend = ...) -> Field:
    """
    implicit_polygon(vertices, blend=None)
    
    The inside of a closed contour without self-intersections, as unions and intersections of its edges' lines. Its sign is the polygon's; its value is no distance, since edges are extended to lines.
    
    vertices: its corners in order, either way round (scene units)
    blend: how the lines are joined
    """
def intersection(*of: Field, blend: Blend = ...) -> Field:
    """
    intersection(*of, blend=None)
    
    All points common to the solids, joined from the left.
    
    of: the solids
    blend: how they are joined
    """
def load(path: str) -> Scene:
    """
    Reads a scene file. Raises Error with all that is wrong in it.
    """
def loft(sections: typing.Sequence[typing.Any], interpolation: str = ...) -> Field:
    """
    loft(sections, interpolation='smooth')
    
    A solid through plane fields at several heights, cut off at the lowest and the highest. Between them the fields are interpolated, which gives no distance.
    
    sections: plane fields and their heights, from the lowest to the highest (scene units)
    interpolation: 'smooth': the sides have no crease at a section; 'linear': straight in between
    """
def mirror(field: Field | float | str, point: typing.Sequence[float] = ..., normal: str | typing.Sequence[float] = ...) -> Field:
    """
    mirror(field, point=(0, 0, 0), normal=(1, 0, 0))
    
    The mirror image of a field in a plane.
    
    field: what is mirrored
    point: a point of the plane (scene units)
    normal: direction perpendicular to the plane
    """
def offset(field: Field | float | str, distance: float) -> Field:
    """
    offset(field, distance)
    
    The solid grown by a distance. It acts on the field: where that is no distance, nor is the result.
    
    field: the solid
    distance: how far the surface moves outwards; negative: inwards (scene units)
    """
def point(at: typing.Sequence[float]) -> Field:
    """
    point(at)
    
    The distance to a point.
    
    at: the point (scene units)
    """
def points(at: typing.Sequence[typing.Sequence[float]] | numpy.ndarray) -> Field:
    """
    points(at)
    
    The distance to the nearest of some points.
    
    at: the points (scene units)
    """
def polygon(vertices: typing.Sequence[typing.Sequence[float]] | numpy.ndarray) -> Field:
    """
    polygon(vertices)
    
    The inside of a closed contour without self-intersections, in the xy plane.
    
    vertices: its corners in order, either way round (scene units)
    """
def polyline(vertices: typing.Sequence[typing.Sequence[float]] | numpy.ndarray, closed: bool = ...) -> Field:
    """
    polyline(vertices, closed=False)
    
    The distance to a chain of straight segments.
    
    vertices: its corners in order (scene units)
    closed: whether the last corner is joined to the first
    """
def quadric(matrix: typing.Sequence[typing.Sequence[float]] | numpy.ndarray, vector: typing.Sequence[float] = ..., constant: float = ...) -> Field:
    """
    quadric(matrix, vector=(0, 0, 0), constant=1)
    
    Where the quadratic polynomial p · M p + v · p + c is not negative: ellipsoids, cones, paraboloids, hyperboloids. Its value is no distance.
    
    matrix: M, three rows of three numbers
    vector: v
    constant: c; with the unit ball's M, -1 on the diagonal, its radius squared
    """
def repeat(field: Field | float | str, spacing: typing.Sequence[float], counts: typing.Sequence[float] = ...) -> Field:
    """
    repeat(field, spacing, counts=None)
    
    Copies of a solid at equal steps along the axes, joined by their largest value. Without counts they go on for ever; then the nearest copies are evaluated, two along each axis, and the distance stays what it is outside if it is proven that a copy fits between its neighbours.
    
    field: what is repeated
    spacing: the step along x, y and z; 0 where nothing is repeated (scene units); not negative
    counts: whole numbers of copies along x, y and z, from the field itself in the positive direction; without end in both directions when not given
    """
def revolve(field: Field | float | str) -> Field:
    """
    revolve(field)
    
    A plane field turned about z: its x becomes the radius, its y the height.
    
    field: a field of x and y
    """
def rotate(field: Field | float | str, axis: str | typing.Sequence[float] = ..., angle: float = ..., quaternion: typing.Sequence[float] = ..., euler: typing.Sequence[float] = ..., center: typing.Sequence[float] = ...) -> Field:
    """
    rotate(field, axis=(0, 0, 1), angle=None, quaternion=None, euler=None, center=(0, 0, 0))
    
    A field turned about a point: by an angle about an axis, by a quaternion, or by Euler angles.
    
    field: what is turned
    axis: axis of the angle
    angle: counter-clockwise, seen against the axis (degrees)
    quaternion: [w, x, y, z] instead of an angle; it need not have unit length
    euler: angles about x, then y, then z instead of an angle (degrees)
    center: the point that stays (scene units)
    """
def rounded_box(center: typing.Sequence[float] = ..., size: typing.Sequence[float] = ..., radius: float = ...) -> Field:
    """
    rounded_box(center=(0, 0, 0), size, radius)
    
    A block whose edges and corners are rounded.
    
    center: its middle (scene units)
    size: full edge lengths, rounding included (scene units); positive
    radius: radius of the edges, at most half the shortest edge length (scene units); positive
    """
def scale(field: Field | float | str, factor: float, center: typing.Sequence[float] = ...) -> Field:
    """
    scale(field, factor, center=(0, 0, 0))
    
    A field scaled evenly; distances are scaled with it.
    
    field: what is scaled
    factor: the scale; positive
    center: the point that stays (scene units)
    """
def schema() -> str:
    """
    The JSON Schema of scene files, as text.
    """
def segment(a: typing.Sequence[float], b: typing.Sequence[float]) -> Field:
    """
    segment(a, b)
    
    The distance to a straight segment.
    
    a: one end (scene units)
    b: the other end (scene units)
    """
def shell(field: Field | float | str, thickness: float, side: str = ...) -> Field:
    """
    shell(field, thickness, side='inside')
    
    A wall along the solid's surface. It acts on the field, as offset does.
    
    field: the solid
    thickness: thickness of the wall (scene units); positive
    side: where the wall lies: 'inside', 'outside' or 'centred' on the surface
    """
def sphere(center: typing.Sequence[float] = ..., radius: float = ...) -> Field:
    """
    sphere(center=(0, 0, 0), radius)
    
    A ball.
    
    center: its middle (scene units)
    radius: its radius (scene units); positive
    """
def torus(center: typing.Sequence[float] = ..., axis: str | typing.Sequence[float] = ..., major_radius: float = ..., minor_radius: float = ...) -> Field:
    """
    torus(center=(0, 0, 0), axis=(0, 0, 1), major_radius, minor_radius)
    
    A ring of round section.
    
    center: its middle (scene units)
    axis: direction of its axis
    major_radius: radius of the circle in the middle of the tube (scene units); positive
    minor_radius: radius of the tube, at most major_radius (scene units); positive
    """
def translate(field: Field | float | str, by: typing.Sequence[float]) -> Field:
    """
    translate(field, by)
    
    A field moved.
    
    field: what is moved
    by: the displacement (scene units)
    """
def twist(field: Field | float | str, rate: float, axis: str | typing.Sequence[float] = ..., center: typing.Sequence[float] = ...) -> Field:
    """
    twist(field, rate, axis=(0, 0, 1), center=(0, 0, 0))
    
    A field turned about an axis in proportion to the height along it. It stretches distances: at r from the axis its slope is at most (kr + sqrt(k²r² + 4)) / 2 times the field's, k being the rate in radians.
    
    field: what is twisted
    rate: degrees for each unit of height (degrees)
    axis: the axis of the turn
    center: a point of the axis, at which nothing turns (scene units)
    """
def union(*of: Field, blend: Blend = ...) -> Field:
    """
    union(*of, blend=None)
    
    All points of any of the solids, joined from the left.
    
    of: the solids
    blend: how they are joined
    """
def with_blend(field: Field | float | str, blend: Blend = ...) -> Field:
    """
    with_blend(field, blend=None)
    
    A field whose unions, intersections and differences, however deep, are all joined by another blend.
    
    field: the field
    blend: how they are joined
    """
__version__: str = '0.1.0'
_blends: dict
_constructors: dict
_signatures: dict
x: Field
y: Field
z: Field

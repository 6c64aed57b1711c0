"""
Heterogeneous solids by distances: the compiled core.
"""
from __future__ import annotations
import collections.abc
import numpy
import numpy.typing
import typing
__all__: list[str] = ['Blend', 'Cancelled', 'Error', 'Field', 'Mesh', 'MinMax', 'RFunction', 'Sardf', 'SardfC1', 'Scene', 'Smooth', 'arc', 'at', 'bend', 'blend_error', 'boundary', 'box', 'box2d', 'bspline_curve', 'bspline_surface', 'canonical_form', 'capsule', 'circle', 'compare_pictures', 'complement', 'conditioned', 'cone', 'cylinder', 'derivative', 'difference', 'disc', 'ellipse', 'ellipsoid', 'extrude', 'fitted', 'formula', 'gradient_length', 'half_plane', 'half_space', 'helix', 'implicit_polygon', 'intersection', 'is_color', 'load', 'loft', 'mesh_solid', 'mesh_surface', 'mirror', 'normal_derivative', 'normalized', 'offset', 'plane', 'point', 'points', 'polygon', 'polyline', 'povray_stage', 'quadric', 'r_equivalence', 'repeat', 'revolve', 'rotate', 'rounded_box', 'scale', 'schema', 'segment', 'shell', 'skeleton', 'sphere', 'spline_field', 'taylor', 'texels_per_unit', 'torus', 'translate', 'trimmed', 'trimmed_segment', 'twist', 'union', 'value_of', 'with_blend', 'x', 'y', 'z']
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
    @property
    def is_distance(self) -> bool:
        """
        Whether its values are distances in scene units, or estimates of them as blends make; not of formulas and functions.
        """
class Mesh:
    """
    A closed surface of quads, wound counter-clockwise from outside.
    """
    def __init__(self) -> None:
        ...
    def check_uv(self, size: typing.SupportsInt | typing.SupportsIndex = 2048, gutter: typing.SupportsInt | typing.SupportsIndex = 8, progress: typing.Any = None) -> dict:
        """
        What a bake would find of the UV map: texels on the mesh; overlapping, those on more than one triangle; faces, and how many reach outside [0, 1]; texels_per_unit, the root of texels per square scene unit.
        """
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
    def from_json(text: str, fields: collections.abc.Mapping[str, Field] = {}, progress: typing.Any = None) -> Scene:
        """
        A scene from a scene file's text; `fields` are names it may use besides its own. progress: as load() takes it.
        """
    def bake(self, mesh: Mesh, size: typing.SupportsInt | typing.SupportsIndex = 2048, channels: collections.abc.Sequence[str] = ['base_color', 'fractions'], gutter: typing.SupportsInt | typing.SupportsIndex = 8, sections: bool = True, progress: typing.Any = None) -> dict:
        """
        {channel: float32 (size, size, components)}, row 0 at the top, linear. Channels: base_color, roughness, metallic, emission, fractions (as fractions_1, ... of three materials each), field, normal (a tangent-space normal map, for which the mesh needs normals), density where every material states one, and attributes by name: see channels().
        """
    def camera(self, width: typing.SupportsInt | typing.SupportsIndex = 640, height: typing.SupportsInt | typing.SupportsIndex = 480) -> typing.Any:
        """
        A camera that frames the object: matrix_world, lens (mm), sensor_width, ...
        """
    def channels(self) -> dict:
        """
        {name: what it is} of all that bake() accepts for this scene.
        """
    def check_surface(self, mesh: Mesh, tolerance: typing.SupportsFloat | typing.SupportsIndex, sections: bool = True) -> dict:
        """
        How far the mesh's vertices lie off the solid's surface, by |f| / |grad f|: vertices, how many are off by more than the tolerance, and the farthest distance, in scene units.
        """
    def first_point(self, origin: typing.Annotated[collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex], "FixedSize(3)"], direction: typing.Annotated[collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex], "FixedSize(3)"], plane: typing.Annotated[collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex], "FixedSize(4)"] = [0.0, 0.0, 0.0, 0.0]) -> typing.Annotated[list[float], "FixedSize(3)"] | None:
        """
        The first point (x, y, z) of the drawn solid on a ray, or None. plane (a, b, c, d): what has a x + b y + c z + d > 0 is cut away, too. A wall thinner along the ray than a thousandth of the bounds may be missed.
        """
    def fractions(self, points: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], outside: str = 'extend') -> numpy.typing.NDArray[numpy.float64]:
        """
        Volume fractions at points (N, 3): (N, materials), rows sum to 1. outside='nan' marks points outside the solid.
        """
    def image_components(self, channels: collections.abc.Sequence[str]) -> dict:
        """
        {image: its number of components} of what bake() makes of the channels.
        """
    def mesh(self, resolution: typing.SupportsInt | typing.SupportsIndex = 128, cell_size: typing.SupportsFloat | typing.SupportsIndex = 0.0, sections: bool = True, size: typing.SupportsInt | typing.SupportsIndex = 2048, gutter: typing.SupportsInt | typing.SupportsIndex = 8, progress: typing.Any = None) -> Mesh:
        """
        The surface with texture coordinates for a texture of `size`². resolution: cells along the longest side; cell_size (scene units) instead when > 0. progress(share) may return False to cancel, which raises Cancelled.
        """
    def osl(self, channels: collections.abc.Sequence[str] = ['base_color'], name: str = 'sardf_part') -> tuple:
        """
        (text, {output: what it is}) of an OSL shader that computes the channels exactly where a ray hits; fractions are an output for each material. The object's space has to be the scene's frame. Raises Error for a field without a formula.
        """
    def povray(self, path: str, render: str = '', camera: typing.Any = None, look: str = 'shaded', width: typing.SupportsInt | typing.SupportsIndex = 640, height: typing.SupportsInt | typing.SupportsIndex = 480, samples: typing.SupportsInt | typing.SupportsIndex = 256, all_fields: bool = False, progress: typing.Any = None) -> None:
        """
        Writes path (.pov), the .inc beside it, and density files (.df3) of what has no formula, whose errors, and those of all that is computed from them, the .inc states, for POV-Ray 3.7; renders them to `render` (.exr or .png) unless it is empty. camera: as camera() gives it; look: shaded, flat (the colours alone) or normals; samples: the most of what has no formula, as the edge of a cube, 8 to 512; all_fields: also write the fields that need samples which the picture does not.
        """
    def render(self, width: typing.SupportsInt | typing.SupportsIndex = 640, height: typing.SupportsInt | typing.SupportsIndex = 480, look: str = 'shaded', camera: typing.Any = None, tolerance: typing.SupportsFloat | typing.SupportsIndex | None = None, background: typing.Annotated[collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex], "FixedSize(3)"] | None = None, depth: bool = False, normals: bool = False, samples: typing.SupportsInt | typing.SupportsIndex = 1, threads: typing.SupportsInt | typing.SupportsIndex = 0, progress: typing.Any = None) -> numpy.typing.NDArray[numpy.float32]:
        """
        A picture by certified ray casting: float32 (height, width, 4), row 0 at the top, linear colour times alpha, then alpha. look: shaded, flat (the colours alone) or normals (0.5 + 0.5 n). camera: as camera() gives it. tolerance (scene units): no stretch of the solid that is longer along a ray is missed; none: 1e-4 of the bounds' diagonal. background: linear (r, g, b); none: alpha is 0 there. depth: one channel more, the depth along the view in scene units, inf where nothing is. normals: three channels more, the outward unit normal. samples: rays along each side of a pixel, 1 to 8, more smooth edges. threads: at most so many, 0: all; the picture does not depend on it.
        """
    def sample_volume(self, lo: typing.Annotated[collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex], "FixedSize(3)"], hi: typing.Annotated[collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex], "FixedSize(3)"], counts: typing.Annotated[collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex], "FixedSize(3)"], sections: bool = True, colors: str = 'surface', channel: str = 'base_color', material: str = '', progress: typing.Any = None) -> dict:
        """
        Samples for 3-D textures, on a grid of counts = (nx, ny, nz) cells over the box from lo to hi (scene units), in the cells' middles. {'field': float32 (nz, ny, nx), of the drawn solid or, without sections, of the whole one, positive inside; 'color': float32 (nz, ny, nx, 4), linear, its last component 1 where there is a colour and all 0 elsewhere; 'steepness': the interpolated field's largest slope at most; 'range': least and largest first component, or None}. colors: 'surface', where interpolation on the surface needs them, 'inside', wherever a cut may show them, or 'none'. channel: base_color or another one that bake() knows, with 1 to 3 components; 'fractions' is that of `material`. progress(share) may return False to cancel, which raises Cancelled.
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
    def warnings(self, progress: typing.Any = None) -> list[str]:
        """
        What is accepted but may not be what is meant, as a list of sentences: features that touch with contradicting values, functions not proven to lie in [0, 1].
        """
    def with_blend(self, blend: Blend) -> Scene:
        """
        The scene with every union, intersection and difference joined by `blend` in place of its own.
        """
    @property
    def attributes(self) -> dict:
        """
        {name: function of points (N, 3)} that gives (N,), of a vector (N, components), and of named components {name: (N,)}.
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
    def material_colors(self) -> dict:
        """
        {name: (red, green, blue)}, linear, in order.
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
def at(field: Field | float | str, point: typing.Sequence[Field | float | str]) -> Field:
    """
    at(field, point)
    
    A field's values at another point, which three fields give: with ["=x", "=y", 0] a plane section of it.
    
    field: the field
    point: the coordinates x, y, z of the point that it is taken at
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
def boundary(solid: Field | float | str, where: Field | float | str = ..., faces: typing.Sequence[float] | numpy.ndarray = ...) -> Field:
    """
    boundary(solid, where=None, faces=())
    
    The distance to a solid's surface, from either side, or to a part of it.
    
    solid: the solid
    where: only the part of the surface where this field is not negative; the result is then an estimate of the distance, good to first order away from the part's rim
    faces: only these faces, exactly. Of a box 0 to 5 are -x, +x, -y, +y, -z, +z, and of a rounded box its flat parts; of a cylinder with a height and of a cone 0 is the bottom, 1 the top, 2 the side; edges of a box2d are -x, +x, -y, +y; edge i of a polygon goes from corner i to the next; what is extruded has its edges, then the bottom, then the top. Moved solids keep their numbers
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
def bspline_curve(control_points: typing.Sequence[typing.Sequence[float]] | numpy.ndarray, degree: float = ..., knots: typing.Sequence[float] | numpy.ndarray = ..., weights: typing.Sequence[float] | numpy.ndarray = ..., closed: bool = ...) -> Field:
    """
    bspline_curve(control_points, degree=3, knots=(), weights=(), closed=False)
    
    The distance to a B-spline curve of any degree, rational where weights are given. It starts and ends in its first and last control point unless knots say otherwise or it is closed.
    
    control_points: its control points in order, more than the degree (scene units)
    degree: degree of its pieces: a whole number from 1 to 12
    knots: its knots, which never fall, as many as control points and degree and 1; none: clamped and uniform
    weights: a weight for each control point; none: all 1; positive
    closed: whether it is closed, smoothly and with uniform knots
    """
def bspline_surface(control_points: typing.Sequence[typing.Any] | numpy.ndarray, degree_u: float = ..., degree_v: float = ..., knots_u: typing.Sequence[float] | numpy.ndarray = ..., knots_v: typing.Sequence[float] | numpy.ndarray = ..., weights: typing.Sequence[float] | numpy.ndarray = ..., closed_u: bool = ..., closed_v: bool = ...) -> Field:
    """
    bspline_surface(control_points, degree_u=3, degree_v=3, knots_u=(), knots_v=(), weights=(), closed_u=False, closed_v=False)
    
    The distance to a B-spline surface of any degrees, rational where weights are given, its edges included.
    
    control_points: rows of control points, all of one length: u counts the rows, v along them (scene units)
    degree_u: degree across the rows: a whole number from 1 to 12
    degree_v: degree along the rows: a whole number from 1 to 12
    knots_u: knots across the rows, which never fall, as many as rows and degree and 1; none: clamped and uniform
    knots_v: knots along the rows
    weights: a weight for each control point, row after row; none: all 1; positive
    closed_u: whether the last row joins the first, smoothly
    closed_v: whether the end of each row joins its start, smoothly
    """
def canonical_form(distance: Field | float | str, coefficients: typing.Sequence[Field | float | str], remainder: Field | float | str = ...) -> Field:
    """
    canonical_form(distance, coefficients, remainder=None)
    
    The distance canonical form: the sum of F_k u^k / k! over the coefficients F_0, F_1, ..., F_m, plus u^(m+1) times a remainder. F_k is the k-th normal derivative on the feature where the coefficients are numbers or conditioned.
    
    distance: the distance u to the feature
    coefficients: F_0, F_1, ...: the value on the feature and its normal derivatives
    remainder: the function that u^(m+1) is multiplied by
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
def compare_pictures(reference: typing.Annotated[numpy.typing.ArrayLike, numpy.float32], candidate: typing.Annotated[numpy.typing.ArrayLike, numpy.float32], factor: typing.SupportsFloat | typing.SupportsIndex = 16.0) -> dict:
    """
    How far two pictures of one scene agree: float32 (height, width, 4), linear, row 0 at the top; a solid is where alpha is at least 0.5. A dictionary: intersection_over_union and edge_within_half_pixel_share of the masks; median, quantile_99 and maximum of the largest difference of the three channels, in steps of 1/255, over compared_pixels, those away from edges; left_out_share of the others; non_finite_pixels; and difference, (height, width, 3), the absolute difference × factor in [0, 1]. Raises Error for other shapes and for pictures without any solid.
    """
def complement(field: Field | float | str) -> Field:
    """
    complement(field)
    
    All points outside the solid.
    
    field: the solid
    """
def conditioned(field: Field | float | str, distance: Field | float | str) -> Field:
    """
    conditioned(field, distance)
    
    A field F made constant along the normals of a feature: F(p - u grad u), for an exact distance u the value at the feature's nearest point. On the feature it is F.
    
    field: the field
    distance: the distance u to the feature
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
def derivative(field: Field | float | str, axis: str | typing.Sequence[float]) -> Field:
    """
    derivative(field, axis)
    
    The derivative of a field along a direction, per scene unit. At a kink it is that of the branch that gives the value; where a length vanishes there is none: NaN.
    
    field: the field
    axis: the direction
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
def fitted(start: Field | float | str, factor: Field | float | str = ..., lower: typing.Sequence[float] = ..., upper: typing.Sequence[float] = ..., splines: typing.Sequence[float] | numpy.ndarray = ..., degree: float = ..., solid: Field | float | str = ..., points: float = ..., values: Field | float | str = ..., values_weight: float = ..., slope: Field | float | str = ..., along: Field | float | str = ..., slope_weight: float = ..., smoothness: float = ..., mean: float = ..., at_least: float = ..., at_most: float = ..., coefficients: typing.Sequence[float] | numpy.ndarray = ..., fingerprint: str = ..., progress: typing.Callable[[float], bool | None] | None = ...) -> Field:
    """
    fitted(start, factor=None, lower, upper, splines, degree=3, solid=None, points=4, values=None, values_weight=1, slope=None, along=None, slope_weight=1, smoothness=0, mean=None, at_least=None, at_most=None, coefficients=(), fingerprint='', progress=None)
    
    start + factor * Phi, where Phi is a sum of uniform B-splines on a box that brings the function near to what is wanted: the sum of the weighted terms given is as small as can be.
    
    start: what the function is where factor is 0
    factor: what multiplies the splines: u^(m + 1) keeps the start's value and m derivatives where the distance u is 0; 1 where it is not given
    lower: the box's lowest corner (scene units)
    upper: the box's highest corner (scene units)
    splines: how many splines along x, y and z; two for a function of x and y, one for equal numbers along all three; positive
    degree: degree of the splines, 1 to 5
    solid: only where it is not negative do the terms count; else in all the box
    points: Gauss points for each span and axis, 1 to 16
    values: term: the square of the function minus this
    values_weight: weight of that term; not negative
    slope: term: the square of (gradient . gradient of along) minus this
    along: whose gradient is the direction of slope; most often a distance
    slope_weight: weight of that term; not negative
    smoothness: weight of the term: the gradient's squared length. Alone it makes the function harmonic; not negative
    mean: the function's mean over the solid is this
    at_least: the function is nowhere less
    at_most: the function is nowhere more
    coefficients: the solution, as `sardf solve` writes it; remove it after any change of the other parameters
    fingerprint: of the problem that the coefficients solve, as `sardf solve` writes it: another problem is an error; without one they are taken as they are
    progress: called with the share done; may return False to cancel, which raises Cancelled
    """
def formula(text: str, **kwargs) -> Field:
    """
    formula(text, **names)
    
    A field from a formula over x, y, z, pi and the given fields or numbers, e.g. formula("sin(k*x) + part", k=2, part=box).
    """
def gradient_length(field: Field | float | str) -> Field:
    """
    gradient_length(field)
    
    How steep a field is: the length of its gradient.
    
    field: the field
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
def helix(center: typing.Sequence[float] = ..., axis: str | typing.Sequence[float] = ..., radius: float = ..., pitch: float = ..., start: float = ..., end: float = ...) -> Field:
    """
    helix(center=(0, 0, 0), axis=(0, 0, 1), radius, pitch, start=None, end=None)
    
    The distance to a helical line, which passes the height of its center at angle 0. For the axis z, angle 0 is +x.
    
    center: a point of its axis (scene units)
    axis: direction of its axis
    radius: radius of its turns (scene units); positive
    pitch: rise along the axis in one turn, at least a millionth of the radius; negative: left-handed (scene units)
    start: the angle where it starts; none: endless (degrees)
    end: the angle where it ends, larger than start; none: endless (degrees)
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
def is_color(channel: str) -> bool:
    """
    Whether a channel holds linear colours; all others are data.
    """
def load(path: str, progress: typing.Any = None) -> Scene:
    """
    Reads a scene file, and solves for its fitted fields. Raises Error with all that is wrong in it. progress(share) may return False to cancel, which raises Cancelled.
    """
def loft(sections: typing.Sequence[typing.Any], interpolation: str = ...) -> Field:
    """
    loft(sections, interpolation='smooth')
    
    A solid through plane fields at several heights, cut off at the lowest and the highest. Between them the fields are interpolated, which gives no distance.
    
    sections: plane fields and their heights, from the lowest to the highest (scene units)
    interpolation: 'smooth': the sides have no crease at a section; 'linear': straight in between
    """
def mesh_solid(path: str | os.PathLike[str], sign: str = ...) -> Field:
    """
    mesh_solid(path, sign='auto')
    
    The solid inside a triangle mesh from a file (.ply, .obj or .stl), with its exact distance where the mesh is sound. A closed mesh may be oriented either way round. With holes the field jumps across them, and its slope is infinite near there.
    
    path: the file, relative to the scene file's folder
    sign: how the inside is found: 'normals' of a closed mesh without faults, 'winding' number of any mesh, or 'auto': the first where it is possible
    """
def mesh_surface(path: str | os.PathLike[str], faces: typing.Sequence[float] | numpy.ndarray = ...) -> Field:
    """
    mesh_surface(path, faces=())
    
    The distance to the triangles of a mesh from a file (.ply, .obj or .stl), or to some of its faces.
    
    path: the file, relative to the scene file's folder
    faces: the faces to take, counted from 0 as in the file; none: all
    """
def mirror(field: Field | float | str, point: typing.Sequence[float] = ..., normal: str | typing.Sequence[float] = ...) -> Field:
    """
    mirror(field, point=(0, 0, 0), normal=(1, 0, 0))
    
    The mirror image of a field in a plane.
    
    field: what is mirrored
    point: a point of the plane (scene units)
    normal: direction perpendicular to the plane
    """
def normal_derivative(field: Field | float | str, distance: Field | float | str) -> Field:
    """
    normal_derivative(field, distance)
    
    The product of two fields' gradients: for a distance the derivative of the field away from its feature.
    
    field: the field
    distance: the distance to the feature
    """
def normalized(field: Field | float | str, order: float = ...) -> Field:
    """
    normalized(field, order=1)
    
    A field with the same zeros, normalised: near them it is the distance, with an error of order distance^(order+1). The first order is f / sqrt(f^2 + |grad f|^2).
    
    field: the field f, smooth at its zeros
    order: how well, from 1 to 12; a whole number from 1
    """
def offset(field: Field | float | str, distance: float) -> Field:
    """
    offset(field, distance)
    
    The solid grown by a distance. It acts on the field: where that is no distance, nor is the result.
    
    field: the solid
    distance: how far the surface moves outwards; negative: inwards (scene units)
    """
def plane(point: typing.Sequence[float] = ..., normal: str | typing.Sequence[float] = ...) -> Field:
    """
    plane(point=(0, 0, 0), normal=(0, 0, 1))
    
    The distance to an infinite plane, from either side.
    
    point: a point of the plane (scene units)
    normal: direction perpendicular to it
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
def povray_stage(stage: str, path: str, render: str = '', look: str = 'lit', width: typing.SupportsInt | typing.SupportsIndex = 640, height: typing.SupportsInt | typing.SupportsIndex = 480, samples: typing.SupportsInt | typing.SupportsIndex = 256, light_samples: typing.SupportsInt | typing.SupportsIndex = 4, program: str = '', progress: typing.Any = None) -> list[str]:
    """
    Writes parts in their places under Blender's lights for POV-Ray 3.7: path (.pov), of each part an .inc beside it, and density files; renders them to `render` (.exr, linear, with alpha) unless it is empty. stage: JSON text with camera, world (radiance), lights and parts, as core/sardf/stage.hpp states. look: lit (matte surfaces, no interreflection), flat (the colours alone) or normals; samples: as Scene.povray takes it; light_samples: along each side of an area light and of soft shadows, 1 to 16; program: path of POV-Ray. Returns sentences of what has no formula. Raises Error, also where POV-Ray is missing; progress(share) may return False to cancel, which stops POV-Ray and raises Cancelled.
    """
def quadric(matrix: typing.Sequence[typing.Sequence[float]] | numpy.ndarray, vector: typing.Sequence[float] = ..., constant: float = ...) -> Field:
    """
    quadric(matrix, vector=(0, 0, 0), constant=1)
    
    Where the quadratic polynomial p · M p + v · p + c is not negative: ellipsoids, cones, paraboloids, hyperboloids. Its value is no distance.
    
    matrix: M, three rows of three numbers
    vector: v
    constant: c; with the unit ball's M, -1 on the diagonal, its radius squared
    """
def r_equivalence(*of: Field, order: float = ...) -> Field:
    """
    r_equivalence(*of, order=1)
    
    The union of features, smooth away from them: (sum of u_i^-order)^(-1/order), normalised to that order where the distances u_i are. It is never larger than the smallest.
    
    of: the distances
    order: the higher, the nearer to the smallest of them; positive
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
def skeleton(*of: Field) -> Field:
    """
    skeleton(*of)
    
    The distance to the nearest of several features.
    
    of: the features
    """
def sphere(center: typing.Sequence[float] = ..., radius: float = ...) -> Field:
    """
    sphere(center=(0, 0, 0), radius)
    
    A ball.
    
    center: its middle (scene units)
    radius: its radius (scene units); positive
    """
def spline_field(lower: typing.Sequence[float], upper: typing.Sequence[float], counts: typing.Sequence[float] | numpy.ndarray, coefficients: typing.Sequence[float] | numpy.ndarray, degree: float = ...) -> Field:
    """
    spline_field(lower, upper, counts, coefficients, degree=3)
    
    A smooth function on a box: a sum of uniform B-splines, each times a coefficient. Outside the box it has the value of the box's nearest point.
    
    lower: the box's lowest corner (scene units)
    upper: the box's highest corner (scene units)
    counts: how many splines along x, y and z; two for a function of x and y; on count - degree equal spans; positive
    coefficients: one for each spline; the last coordinate's number changes fastest
    degree: degree of the polynomials, 1 to 5
    """
def taylor(formula: str, distance: Field | float | str, terms: float, first_term: float = ...) -> Field:
    """
    taylor(formula, distance, terms, first_term=1)
    
    The first terms of the Taylor series, at u = 0, of a function of the distance u; or some of them, counted from 1.
    
    formula: the function of u, such as 'exp(-1.5*u)'
    distance: the distance u
    terms: how many terms, at most 32; a whole number from 1
    first_term: the first of them; term k is that of u^(k-1); a whole number from 1
    """
def texels_per_unit(mesh: Mesh, size: typing.SupportsInt | typing.SupportsIndex) -> float:
    """
    The root of texels per square scene unit over the whole mesh, for a texture of size².
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
def trimmed(field: Field | float | str, by: Field | float | str) -> Field:
    """
    trimmed(field, by)
    
    The part of where a field is 0 that lies in a solid, as a feature normalised to the first order if both fields are: sqrt(f^2 + (sqrt(t^2 + f^4) - t)^2 / 4) for a solid t.
    
    field: the field f
    by: the solid t that it is kept in
    """
def trimmed_segment(a: typing.Sequence[float], b: typing.Sequence[float]) -> Field:
    """
    trimmed_segment(a, b)
    
    A straight segment as a line that is trimmed by the ball around it: smooth away from it, normalised to the first order.
    
    a: one end (scene units)
    b: the other end (scene units)
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
def value_of(rule: typing.Any, scale: float = ...) -> Field:
    """
    value_of(rule, scale=1)
    
    The number that a rule gives, as a field: values on features, interpolated between them. It is no distance.
    
    rule: a rule with values, as an attribute has it
    scale: the size of what is modelled: a point counts as on a feature within 1e-12 of it (scene units); positive
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

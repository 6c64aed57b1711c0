"""Pictures of scenes as arrays and files."""

from sardf import _core

SHADED_BACKGROUND = (0.9, 0.92, 0.95)
CHANNELS = ("R", "G", "B", "A")


def render(scene, path=None, size=(640, 480), look="shaded", *, bits=16, **options):
    """Renders a scene by certified ray casting, as the command `sardf render` does.

    scene: a Scene, or the path of a scene file.
    path: writes the picture there, .png (sRGB) or .exr (linear); none: it is only returned.
    size: (width, height) in pixels.
    look: "shaded", "flat" (the colours alone, unlit) or "normals" (0.5 + 0.5 n).
    bits: of each channel in the file: 8 or 16 of .png, 16 or 32 of .exr.
    options: camera, tolerance, background, depth, normals, samples, threads and progress, as
        Scene.render takes them. A lit picture has a background unless `background=None` is
        given. A .png has no place for depth and normals: they are in the array alone.

    Returns float32 (height, width, channels), row 0 at the top, linear: colour times alpha, alpha,
    then depth (1) and normals (3) where they are asked for. Raises Error for arguments that are not
    accepted, and Cancelled.
    """
    if not isinstance(scene, _core.Scene):
        scene = _core.load(str(scene))
    if look == "shaded":
        options.setdefault("background", SHADED_BACKGROUND)
    ending = None if path is None else str(path).rpartition(".")[2]
    accepted = {None: (bits,), "png": (8, 16), "exr": (16, 32)}
    if ending not in accepted:
        _core._fail(f"the picture ends in '.{ending}'; .png and .exr are accepted")
    if bits not in accepted[ending]:
        _core._fail(f"bits is {bits}; {accepted[ending][0]} and {accepted[ending][1]} are accepted")
    width, height = size
    picture = scene.render(width=width, height=height, look=look, **options)
    if path is not None:
        _write(str(path), picture, look, bits, options)
    return picture


def _write(path, picture, look, bits, options):
    # It carries an image library that Blender, which has its own, must not load.
    from sardf import _image

    names = list(CHANNELS)
    if path.endswith(".exr"):
        names += ["Z"] if options.get("depth") else []
        names += ["NX", "NY", "NZ"] if options.get("normals") else []
    _image.write(path, picture[..., : len(names)], look != "normals", bits, names)

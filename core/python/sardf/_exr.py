"""OpenEXR files of float images, where there is no image library: inside Blender.

The layout is that of "OpenEXR File Layout" and the compression of its "ZIP": blocks of 16 rows, low
and high bytes apart, differences of neighbours, deflate.
"""

import os
import struct
import zlib
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np

from sardf import _core

MAGIC, VERSION = 20000630, 2
FLOAT, ZIP, INCREASING = 2, 3, 0
ROWS = 16  # in a block of ZIP
NAMES = {1: ("Y",), 2: ("R", "G", "B"), 3: ("R", "G", "B")}


def write_exr(path, array, progress=None):
    """Writes a float32 array (height, width, components), row 0 at the top, unchanged.

    1 component is written as Y, 2 and 3 as R, G, B, where a missing one is 0. The file appears
    under its name when it is complete. progress(share) may return False to cancel, which raises
    Cancelled. Raises Error for another shape and OSError where the file cannot be written.
    """
    array = np.asarray(array, dtype="<f4")
    if array.ndim != 3 or 0 in array.shape or array.shape[2] not in NAMES:
        _core._fail(f"an array has the shape {array.shape}; (height, width, 1 to 3) is accepted")
    path = Path(path)
    partial = path.with_name(f".{path.name}.{os.getpid()}")
    try:
        with open(partial, "wb") as file:
            _write(file, array, progress or (lambda share: True))
        os.replace(partial, path)
    finally:
        partial.unlink(missing_ok=True)


def _write(file, array, progress):
    height, width, components = array.shape
    header = _header(width, height, NAMES[components])
    starts = range(0, height, ROWS)
    place = len(header) + 8 * len(starts)
    file.write(header)
    file.write(bytes(8 * len(starts)))
    places = []
    with ThreadPoolExecutor(_processors()) as pool:
        made = pool.map(lambda start: _block(array[start : start + ROWS]), starts)
        try:
            for start, data in zip(starts, made, strict=True):
                if progress(start / height) is False:
                    raise _core.Cancelled
                places.append(place)
                file.write(struct.pack("<ii", start, len(data)))
                file.write(data)
                place += 8 + len(data)
        except BaseException:
            pool.shutdown(wait=False, cancel_futures=True)
            raise
    file.seek(len(header))
    file.write(struct.pack(f"<{len(places)}Q", *places))


def _processors():
    """How many this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count()


def _header(width, height, names):
    channels = b"".join(
        name.encode() + b"\0" + struct.pack("<iiii", FLOAT, 0, 1, 1) for name in sorted(names)
    )
    window = struct.pack("<iiii", 0, 0, width - 1, height - 1)
    attributes = (
        ("channels", "chlist", channels + b"\0"),
        ("compression", "compression", bytes([ZIP])),
        ("dataWindow", "box2i", window),
        ("displayWindow", "box2i", window),
        ("lineOrder", "lineOrder", bytes([INCREASING])),
        ("pixelAspectRatio", "float", struct.pack("<f", 1)),
        ("screenWindowCenter", "v2f", struct.pack("<ff", 0, 0)),
        ("screenWindowWidth", "float", struct.pack("<f", 1)),
    )
    text = b"".join(
        name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(value)) + value
        for name, kind, value in attributes
    )
    return struct.pack("<ii", MAGIC, VERSION) + text + b"\0"


def _block(rows):
    """The compressed bytes of some rows: of each row one channel after the other, by name."""
    height, width, components = rows.shape
    planes = np.zeros((height, len(NAMES[components]), width), dtype="<f4")
    planes[:, :components] = rows.transpose(0, 2, 1)
    raw = np.ascontiguousarray(planes[:, ::-1]).view(np.uint8).reshape(-1)  # B, G, R
    apart = np.concatenate([raw[0::2], raw[1::2]])
    apart[1:] = np.diff(apart) + np.uint8(128)  # modulo 256
    # Runs only: mantissas have nothing to find, and looking for it takes four times as long.
    deflate = zlib.compressobj(level=1, strategy=zlib.Z_RLE)
    packed = deflate.compress(apart.tobytes()) + deflate.flush()
    return packed if len(packed) < len(raw) else raw.tobytes()

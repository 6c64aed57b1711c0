"""Pictures of the documentation, kept small."""

import numpy as np
from PIL import Image

# Pictures have the first of these numbers of colours with which at most FEW of the pixels change by
# more than CHANGE of 255, or the last.
COLORS = (32, 64, 96, 128, 192, 256)
CHANGE, FEW = 8, 0.01


def reduced(picture: Image.Image) -> Image.Image:
    """The picture with few colours."""
    pixels = np.asarray(picture, int)
    for count in COLORS:
        made = picture.quantize(count, dither=Image.Dither.NONE)
        changes = np.abs(np.asarray(made.convert("RGB"), int) - pixels).max(axis=2)
        if (changes > CHANGE).mean() <= FEW:
            break
    return made

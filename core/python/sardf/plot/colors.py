"""Linear and sRGB colours, and colours that remain apart for colour-blind readers."""

import numpy as np

# Okabe and Ito's colours, without the black that the solid's outline has.
APART = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9")
DASHES = ("solid", (0, (6, 2)), (0, (2, 1.5)), (0, (6, 2, 1.5, 2)))


def linear_from(written) -> np.ndarray:
    """A linear colour (3,) from what a scene file says: "#rrggbb" (sRGB), three linear numbers or
    nothing."""
    if written is None:
        return np.full(3, 0.8)
    if not isinstance(written, str):
        return np.array(written, float)
    encoded = np.array([int(written[i : i + 2], 16) / 255 for i in (1, 3, 5)])
    return np.where(encoded <= 0.04045, encoded / 12.92, ((encoded + 0.055) / 1.055) ** 2.4)


def encoded(linear) -> np.ndarray:
    """sRGB from linear colours of any shape, clipped to 0..1."""
    linear = np.clip(linear, 0, 1)
    return np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)

# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws the volumes of the preview into a 3-D view, between and behind the other objects."""

import gpu
from gpu_extras.batch import batch_for_shader

from . import preview_shader

# Corners of a box numbered by their bits (x, y, z), and its sides wound outwards.
SIDES = (
    (0, 2, 1), (1, 2, 3), (4, 5, 6), (5, 7, 6), (0, 1, 4), (1, 5, 4),
    (2, 6, 3), (3, 6, 7), (0, 4, 2), (2, 4, 6), (1, 3, 5), (3, 7, 5),
)  # fmt: skip


class Textures:
    """A Volume on the graphics card."""

    def __init__(self, volume, shader):
        self.volume = volume
        # Half floats: every card interpolates them.
        self.field = _texture(volume.counts, "R16F", volume.field)
        self.color = _texture(volume.counts, "RGBA16F", volume.color)
        lo, hi = volume.lo, volume.hi
        corners = [tuple((lo, hi)[i >> axis & 1][axis] for axis in range(3)) for i in range(8)]
        self.box = batch_for_shader(shader, "TRIS", {"position": corners}, indices=SIDES)


def _texture(counts, form, values):
    # The buffer's size is checked against the texture's.
    return gpu.types.GPUTexture(
        counts, format=form, data=gpu.types.Buffer("FLOAT", values.size, values)
    )


class Painter:
    """The shader, and what it was given last. Everything here needs a view that is being drawn."""

    def __init__(self):
        self._shader = preview_shader.create()

    def upload(self, volume):
        return Textures(volume, self._shader)

    def draw(self, textures, matrix, cuts, value_range, line_spacing, height):
        """Draw one part.

        matrix: from the part's coordinates to the world's. cuts: as preview.Shown has them.
        value_range: what the colour map begins and ends with; (0, 0): samples are colours.
        line_spacing: of lines of equal distance, scene units, and the colour map is striped; 0:
        none. height: of the region, in pixels.
        """
        view = gpu.matrix.get_model_view_matrix()
        projection = gpu.matrix.get_projection_matrix()
        to_view = view @ matrix
        to_clip = projection @ to_view
        shader, volume = self._shader, textures.volume
        # Of a pixel at clip coordinate w = 1, in the part's units.
        size = max(matrix.median_scale, 1e-12) * abs(projection[1][1]) * height
        # Keeps gradients at right angles to surfaces under any matrix.
        to_view_normal = to_view.to_3x3().inverted_safe().transposed().to_4x4()
        uniforms = preview_shader.block(
            {
                "to_clip": to_clip.transposed(),
                "from_clip": to_clip.inverted_safe().transposed(),
                "to_view_normal": to_view_normal.transposed(),
                "cuts": preview_shader.planes_of(cuts),
                "cut_count": len(cuts),
                "low": volume.lo,
                "unit": volume.unit,
                "per_size": 1 / (volume.hi - volume.lo),
                "line_spacing": line_spacing,
                "cell": volume.cell,
                "pixel": 2 / size,
                "value_range": value_range,
            }
        )
        shader.bind()
        shader.uniform_block("part", uniforms)
        shader.uniform_sampler("field_samples", textures.field)
        shader.uniform_sampler("color_samples", textures.color)
        gpu.state.depth_test_set("LESS_EQUAL")
        gpu.state.depth_mask_set(True)
        # The box's back: it is seen from inside, too. A mirrored part has its faces turned.
        gpu.state.face_culling_set("BACK" if to_view.determinant() < 0 else "FRONT")
        try:
            textures.box.draw(shader)
        finally:
            gpu.state.face_culling_set("NONE")
            gpu.state.depth_mask_set(False)
            gpu.state.depth_test_set("NONE")

# SPDX-License-Identifier: GPL-3.0-or-later
"""What is wrong with a part, in one sentence that names the object."""


class PartError(Exception):
    """A part that stands for no scene, or data of it that cannot be used."""

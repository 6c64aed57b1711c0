# SPDX-License-Identifier: GPL-3.0-or-later
"""Progress of work that is part of other work. No bpy here."""


def between(progress, start, stop):
    """What a part of the work calls as progress(share), where it is the whole's from `start` to
    `stop`; None where nobody listens."""
    if progress is None:
        return None
    return lambda share: progress(start + (stop - start) * share)

# SPDX-License-Identifier: GPL-3.0-or-later
"""How long a bake will go on, and how times, sizes and shares are said. No bpy here."""

import time

TRUSTED = 0.3  # share done from which on the estimate made before counts no more
BAR = 12  # characters


class Clock:
    """Time left of work of which a share is done; `expected` seconds in all, None: unknown."""

    def __init__(self, expected=None, now=time.monotonic):
        self._expected = expected
        self._now = now
        self._begun = now()

    def elapsed(self):
        return self._now() - self._begun

    def left(self, share):
        """Seconds left when `share` in [0, 1] is done; None while nothing is known.

        What was expected counts at first, how fast it went later.
        """
        elapsed = self.elapsed()
        guess = None if self._expected is None else max(0.0, self._expected - elapsed)
        if share <= 0:
            return guess
        going = elapsed * (1 - share) / share
        if guess is None:
            return going if share > 0.02 else None
        trust = min(1.0, share / TRUSTED)
        return trust * going + (1 - trust) * guess


def bar(share):
    """A bar of characters, for the status bar, which shows text alone."""
    full = round(BAR * min(1.0, max(0.0, share)))
    return "█" * full + "░" * (BAR - full)


def seconds_text(seconds):
    """About so long: "under a second", "8 s", "3 min", "2 h"."""
    if seconds < 1:
        return "under a second"
    if seconds < 90:
        return f"{seconds:.0f} s"
    if seconds < 5400:
        return f"{seconds / 60:.0f} min"
    return f"{seconds / 3600:.0f} h"


def bytes_text(count):
    """About so much memory: "3 MB", "1.5 GB"."""
    megabytes = count / 2**20
    return f"{megabytes / 1024:.1f} GB" if megabytes >= 1000 else f"{max(1, megabytes):.0f} MB"


def progress_text(share, left):
    """ "43 %, 12 s left"."""
    text = f"{100 * share:.0f} %"
    return text if left is None else f"{text}, {seconds_text(left)} left"

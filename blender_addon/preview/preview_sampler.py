# SPDX-License-Identifier: GPL-3.0-or-later
"""The preview's worker thread; no bpy here.

`Sampler` takes wishes, makes a coarse volume of each at once and the fine one when no newer wish
has come for a while; whoever shows them polls `take`.
"""

import threading
import time

from .preview_volume import check, make_stand_in, make_volume, read

COARSE = 32  # samples along the longest side of the first picture
QUIET = 0.15  # seconds without a wish before the fine picture is made


class _Task:
    """What is still to be made for one key."""

    def __init__(self, wish):
        self.wish = wish
        self.scene = None
        self.is_fine = False  # the coarse volume was made
        self.dropped = False  # nobody waits for it any more

    @property
    def resolution(self):
        return self.wish.resolution if self.is_fine else min(COARSE, self.wish.resolution)


class Sampler:
    """Makes the volumes of some parts, each named by a key, in one worker thread."""

    def __init__(self, sardf):
        self._sardf = sardf
        self._changed = threading.Condition()
        self._open = {}  # key -> _Task; guarded, as all below
        self._scenes = {}  # key -> ((source, stamp), scene) that was read last
        self._results = []
        self._running = None
        self._last_wish = 0.0
        self._stopped = False
        self._thread = threading.Thread(target=self._run, name="sardf preview", daemon=True)
        self._thread.start()

    @property
    def busy(self):
        """Whether anything is still to be made or taken."""
        with self._changed:
            return bool(self._open or self._results)

    @property
    def running(self):
        """Whether the thread lives."""
        return self._thread.is_alive()

    def request(self, key, wish):
        """Replace what was wished for a key. A coarse volume at work is finished first, so that
        something is seen however fast wishes follow one another."""
        with self._changed:
            self._last_wish = time.monotonic()
            self._open[key] = _Task(wish)
            if self._running is not None and self._running.is_fine:
                self._running.dropped = True
            self._changed.notify_all()

    def forget(self, key):
        """Make nothing more for a key."""
        with self._changed:
            task = self._open.pop(key, None)
            self._scenes.pop(key, None)
            if task is not None:
                task.dropped = True
            self._results = [result for result in self._results if result[0] != key]

    def wait(self, limit=0.1):
        """Until there is something to take, or for `limit` seconds."""
        with self._changed:
            self._changed.wait_for(lambda: self._results, limit)

    def take(self):
        """[(key, Volume or Exception), ...] made since the last call, oldest first."""
        with self._changed:
            results, self._results = self._results, []
        return results

    def stop(self, limit=1.0):
        """End the thread; waits for it, `limit` seconds at most."""
        with self._changed:
            self._stopped = True
            self._open.clear()
            self._results.clear()
            if self._running is not None:
                self._running.dropped = True
            self._changed.notify_all()
        self._thread.join(limit)

    def _run(self):
        while True:
            found = self._next()
            if found is None:
                return
            key, task = found
            try:
                result = self._make(key, task)
            except self._sardf.Cancelled:
                with self._changed:
                    self._running = None
                continue
            except Exception as error:  # handed to whoever polls: nothing is swallowed
                result = error
            self._finish(key, task, result)

    def _next(self):
        """(key, task) to work on, coarse ones first; None: the end."""
        with self._changed:
            while not self._stopped:
                coarse = [item for item in self._open.items() if not item[1].is_fine]
                quiet = self._last_wish + QUIET - time.monotonic()
                if coarse or (self._open and quiet <= 0):
                    key, task = coarse[0] if coarse else next(iter(self._open.items()))
                    task.dropped = False
                    self._running = task
                    return key, task
                self._changed.wait(quiet if self._open else None)
            return None

    def _make(self, key, task):
        def go_on(_share):
            return not task.dropped

        with self._changed:
            known = self._scenes.get(key)
        origin = (task.wish.source, task.wish.stamp)
        if known is not None and known[0] == origin:
            task.scene = known[1]
        if task.scene is None:
            task.scene = read(self._sardf, task.wish.source, go_on)
            with self._changed:
                if key in self._open:  # not forgotten meanwhile
                    self._scenes[key] = (origin, task.scene)
        check(task.scene, task.wish)
        if task.wish.stand_in is not None:
            task.is_fine = True
            return make_stand_in(self._sardf, task.scene, task.wish, go_on)
        return make_volume(task.scene, task.wish, task.resolution, go_on)

    def _finish(self, key, task, result):
        with self._changed:
            self._running = None
            if self._stopped or task.dropped:
                return
            self._results = [old for old in self._results if old[0] != key] + [(key, result)]
            self._changed.notify_all()
            if self._open.get(key) is not task:  # a newer wish came
                return
            failed = isinstance(result, Exception)
            if failed or task.resolution >= task.wish.resolution:
                del self._open[key]
            else:
                task.is_fine = True

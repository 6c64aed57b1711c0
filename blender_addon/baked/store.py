# SPDX-License-Identifier: GPL-3.0-or-later
"""Where a bake's textures are written, so that they appear whole or not at all. No bpy here."""

import errno
import re
import shutil
from pathlib import Path

from .. import outputs
from ..arguments import Stop

SUFFIX = ".exr"


class StoreError(Exception):
    """The textures cannot be written: one sentence."""


class Store:
    """Files NAME_channel.exr in a folder; without a name channel.exr.

    They are written into a hidden folder inside of it, beside which `publish` moves them under
    their names; `discard` removes what is not published, and the folder if it was made for them.
    """

    def __init__(self, folder, name="", replace=False):
        self.folder = Path(folder)
        self._stem = f"{file_name(name)}_" if name else ""
        self._replace = replace
        self._made = None  # the topmost folder that was not there before
        self._workplace = None

    def open(self):
        """Make the hidden folder. Raises StoreError."""
        if self.folder.is_file():
            raise StoreError(f"{self.folder} is a file; textures need a folder")
        above = [self.folder, *self.folder.parents]
        self._made = next((each for each in reversed(above) if not each.exists()), None)
        try:
            self._workplace = outputs.make_workplace(self.folder)
        except Stop as stop:
            self.discard()
            raise StoreError(str(stop)) from stop

    def probe(self, channels):
        """Whether these files can and may be written; leaves nothing. Raises StoreError."""
        self.open()
        self.discard()
        self.check(channels)

    def check(self, channels):
        """Whether the files of these channels may be written. Raises StoreError."""
        for channel in channels:
            target = self.folder / self._name(channel)
            if target.is_dir():
                raise StoreError(f"{target} is a folder; a texture cannot be written there")
            if target.exists() and not self._replace:
                raise StoreError(
                    f"{target} is there already; tick Replace Files or choose another folder"
                )

    def path(self, channel):
        """The file to write a channel to before it is published."""
        return self._workplace / self._name(channel)

    def publish(self, channels):
        """Give the files their names; {channel: path}. Raises StoreError, and nothing is left."""
        self.check(channels)  # one may have appeared meanwhile
        try:
            outputs.publish(self._workplace, self.folder)
        except OSError as error:
            raise failure(self.folder, error) from error
        finally:
            shutil.rmtree(self._workplace, ignore_errors=True)
        self._workplace = self._made = None
        return {channel: self.folder / self._name(channel) for channel in channels}

    def discard(self):
        """Remove what was not published."""
        if self._workplace is not None:
            shutil.rmtree(self._workplace, ignore_errors=True)
            self._workplace = None
        if self._made is not None:
            remove_if_empty(self.folder, self._made)
            self._made = None

    def _name(self, channel):
        return f"{self._stem}{file_name(channel)}{SUFFIX}"


def file_name(text):
    """A name as a file's: letters, digits, blanks, "_", "-" and "." stay."""
    return re.sub(r"[^\w .-]", "_", text).strip(" .") or "part"


def failure(place, error):
    """The StoreError of an OSError."""
    if error.errno == errno.ENOSPC:
        return StoreError(f"{place}: there is no space left for the textures")
    return StoreError(f"{place}: the textures cannot be written: {error.strerror or error}")


def remove_if_empty(folder, top):
    """Remove a folder and those above it up to `top`, as far as nothing is in them."""
    for each in (folder, *folder.parents):
        try:
            each.rmdir()
        except OSError:  # something is in it, or it was never made
            return
        if each == top:
            return

# SPDX-License-Identifier: GPL-3.0-or-later
"""The add-on of a checkout, as if it were installed."""

import importlib.util
import sys
from pathlib import Path

NAME = "sardf_blender"


def load(folder, before=lambda: None):
    """Import and register it as sardf_blender; `before` is called between the two."""
    spec = importlib.util.spec_from_file_location(
        NAME, Path(folder) / "__init__.py", submodule_search_locations=[folder]
    )
    sys.modules[NAME] = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(sys.modules[NAME])
    before()
    sys.modules[NAME].register()

# SPDX-License-Identifier: GPL-3.0-or-later
"""Find and import the compiled package `sardf` for the Python that runs Blender."""

import importlib
import importlib.machinery
import importlib.util
import os
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent


class MissingCore(Exception):
    """`sardf` cannot be imported; the text names the expected and the found Python."""


def python_tag():
    """The tag of compiled modules that this Python can import, such as "cp311"."""
    return f"cp{sys.version_info.major}{sys.version_info.minor}"


def load():
    """The imported package `sardf`. Raises MissingCore.

    Looked for in this order: the copy inside the add-on (Blender 3.4), the folder named by the
    environment variable SARDF_PYTHON, the modules this Python has already (extension wheels, the
    bpy module of a virtual environment), and the .venv of the checkout around this file. From a
    folder only `sardf` itself is taken, so that Blender keeps its own numpy.
    """
    if "sardf" in sys.modules:
        return sys.modules["sardf"]
    if importlib.util.find_spec("numpy") is None:
        raise MissingCore(
            f"sardf needs numpy, which Blender's Python {sys.version.split()[0]} does not have "
            "(on Debian: apt install python3-numpy)"
        )
    reasons = []
    for folder in _folders():
        reason = _reason_against(folder)
        if reason:
            reasons.append(reason)
            continue
        try:
            return importlib.import_module("sardf") if folder is None else _load_from(folder)
        except ImportError as error:  # a missing or older shared library of the system
            place = "Blender's Python" if folder is None else folder
            raise MissingCore(f"the module 'sardf' in {place} does not load: {error}") from error
    brought = brought_tags()
    if brought and python_tag() not in brought:
        reasons.insert(0, f"this zip of the add-on brought it for {', '.join(brought)} only")
    raise MissingCore(
        f"the Python module 'sardf' built for {python_tag()} (this is Python "
        f"{sys.version_info.major}.{sys.version_info.minor}) was not found: {'; '.join(reasons)}; "
        f"use a zip that has it for {python_tag()}, install it for this Python, or set "
        "SARDF_PYTHON to the folder that holds it"
    )


def brought_tags():
    """The Pythons, such as cp311, for which this copy of the add-on brought the module."""
    wheels = [path.name.split("-")[2] for path in (HERE / "wheels").glob("sardf-*-*-*-*.whl")]
    return sorted({*wheels, *_tags(HERE / "vendor" / "sardf")})


def _folders():
    """Folders that may hold the package, first choice first; None: wherever Python looks."""
    site_packages = f"lib/python{sys.version_info.major}.{sys.version_info.minor}/site-packages"
    # An extension's wheels are what Blender 4.2 and later install for us; the vendored copy is
    # for older versions, and Blender reports an extension that brings modules in by other ways.
    as_extension = __package__.startswith("bl_ext.")
    yield from [None] if as_extension else [HERE / "vendor"]
    if os.environ.get("SARDF_PYTHON"):
        yield Path(os.environ["SARDF_PYTHON"])
    if not as_extension:
        yield None
        yield HERE.parent / ".venv" / site_packages


def _reason_against(folder):
    """Why `sardf` cannot come from `folder`, or "" when it can."""
    if folder is None:
        spec = importlib.util.find_spec("sardf")
        if spec is None or not spec.submodule_search_locations:
            return "not installed in Blender's Python"
        places = [Path(place) for place in spec.submodule_search_locations]
    else:
        places = [folder / "sardf"]
        if not (places[0] / "__init__.py").is_file():
            return f"not in {folder}"
    found = sorted(file.name for place in places for file in place.glob("_core.*"))
    suffixes = tuple(importlib.machinery.EXTENSION_SUFFIXES)
    if any(name[len("_core") :] in suffixes for name in found):
        return ""
    tags = _tags(*places)
    return f"{places[0]} is built for {', '.join(tags) if tags else 'no Python at all'}"


def _tags(*places):
    """Of the compiled modules in folders: _core.cpython-311-x86_64-linux-gnu.so -> cp311."""
    names = [file.name.split(".")[1] for place in places for file in place.glob("_core.*.*")]
    return sorted({name.split("-x86")[0].replace("cpython-", "cp") for name in names})


def _load_from(folder):
    package = folder / "sardf"
    spec = importlib.util.spec_from_file_location(
        "sardf", package / "__init__.py", submodule_search_locations=[str(package)]
    )
    module = importlib.util.module_from_spec(spec)
    sys.modules["sardf"] = module
    try:
        spec.loader.exec_module(module)
    except BaseException:
        for name in [n for n in sys.modules if n == "sardf" or n.startswith("sardf.")]:
            del sys.modules[name]
        raise
    return module

"""Fixtures that several files use."""

import pytest
from blender_runs import INSTALLED_VERSIONS, MODULES, build_zips
from blender_runs import run_check as run_check_of
from repository import ROOT


@pytest.fixture(scope="session")
def zips(tmp_path_factory):
    """Of the wheel that scripts/setup built: {Blender's version: the zip that it wants}."""
    wheels = list((ROOT / "build/dist").glob("sardf-*.whl"))
    assert len(wheels) == 1, "scripts/setup builds one wheel"
    extension, legacy = build_zips(wheels[0], tmp_path_factory.mktemp("dist"))
    return {"3.4.1": legacy} | dict.fromkeys(MODULES, extension)


@pytest.fixture(scope="session")
def run_check(zips):
    """blender_runs.run_check with the zip that the version wants: (version, folder, check, ...)."""

    def run(version, *arguments, **keywords):
        return run_check_of(zips[version], version, *arguments, **keywords)

    return run


@pytest.fixture(scope="module", params=INSTALLED_VERSIONS)
def version(request):
    """Each Blender in which the zips are installed and used without a window."""
    return request.param


def pytest_collection_modifyitems(items):
    """`-m window` chooses the tests that look at a window which a fixture of that name drives."""
    for item in items:
        if "window" in getattr(item, "fixturenames", ()):
            item.add_marker(pytest.mark.window)

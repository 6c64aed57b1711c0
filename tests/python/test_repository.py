"""The rules of the repository that a machine can check: sizes, directions, versions, tests."""

import ast
import importlib.metadata
import re
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest
from repository import ROOT, files, imported_modules, includes, name_of

CPP = (".hpp", ".cpp")
VERSION = re.search(r"project\(sardf VERSION ([0-9.]+)", (ROOT / "CMakeLists.txt").read_text())[1]


def code_files() -> list[Path]:
    scripts = [path for path in files("scripts") if path.suffix in ("", ".sh")]
    return scripts + files(".", ".hpp", ".cpp", ".py", ".pyi", ".cmake", ".html", ".js", ".css")


def test_the_checks_see_the_repository():
    names = {name_of(path) for path in files()}
    assert {"README.md", "core/sardf/error.cpp", ".ci/run", "scripts/setup"} <= names
    assert not any(name.startswith(("build/", ".venv")) for name in names)


def test_no_code_file_is_longer_than_500_lines():
    written = [path for path in code_files() if path.suffix != ".pyi"]  # stubs are generated
    lengths = {name_of(path): len(path.read_text().splitlines()) for path in written}
    too_long = {name: lines for name, lines in lengths.items() if lines > 500}
    assert lengths
    assert not too_long


def test_no_file_names_a_folder_of_one_machine():
    one_machine = re.compile(r"(?<![\w.\-}*/])/(?:work|home|tmp|root|Users)/\w|[A-Z]:\\\\?Users")
    found = []
    for path in code_files() + files(".", ".md", ".toml", ".json", ".txt"):
        for number, line in enumerate(path.read_text().splitlines(), 1):
            if one_machine.search(line):
                found.append(f"{name_of(path)}:{number}: {line.strip()}")
    assert not found


def test_nothing_is_left_for_later():
    later = re.compile(r"\b(TODO|FIXME|XXX|HACK)\b")
    this = Path(__file__)
    found = [
        name_of(path) for path in code_files() if path != this and later.search(path.read_text())
    ]
    assert not found


def test_blender_is_imported_only_by_its_addon_tests_and_benchmarks():
    blender = ("bpy", "bmesh", "mathutils", "gpu", "bl_operators")
    importing = {
        name_of(path).split("/")[0]
        for path in files(".", ".py")
        if any(module.split(".")[0] in blender for module in imported_modules(path))
    }
    assert importing <= {"blender_addon", "tests", "bench"}


def test_blender_addon_holds_no_mathematics():
    """numpy only carries buffers there, and math only constants and angle units: formulas belong
    to the core, where they are tested."""
    allowed_of_math = {"pi", "inf", "nan", "isfinite", "radians", "degrees"}
    formulas_of_numpy = re.compile(
        "linalg|a?(sin|cos|tan)h?|arc.*|sqrt|exp|log|power|cross|dot|matmul|einsum|interp"
    )
    found = []
    for path in files("blender_addon", ".py"):
        modules = {module.split(".")[0] for module in imported_modules(path)}
        found += [f"{name_of(path)} imports {m}" for m in modules & {"cmath", "scipy", "sympy"}]
        for node in ast.walk(ast.parse(path.read_text())):
            if not (isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name)):
                continue
            module = node.value.id
            if (module == "math" and node.attr not in allowed_of_math) or (
                module in ("np", "numpy") and formulas_of_numpy.fullmatch(node.attr)
            ):
                found.append(f"{name_of(path)}:{node.lineno}: {module}.{node.attr}")
        from_math = {m for m in imported_modules(path) if m.startswith("math.")}
        wrong = from_math - {f"math.{name}" for name in allowed_of_math}
        found += [f"{name_of(path)} imports {module}" for module in sorted(wrong)]
    assert not found


# Folder, and what its files may include besides the standard library and their own folder.
DIRECTIONS = {
    "core/sardf": ("sardf/", "OpenImageIO/", "tbb/", "oneapi/", "Eigen/", "nlohmann/"),
    "povray_gen": ("sardf/", "povray_gen/"),
    "core/cli": ("cli/", "sardf/", "povray_gen/", "CLI/", "nlohmann/", "tbb/", "oneapi/"),
    "core/python": ("sardf/", "povray_gen/", "pybind11/", "nlohmann/"),
}


@pytest.mark.parametrize("folder", DIRECTIONS)
def test_includes_point_one_way(folder):
    wrong = []
    for path in files(folder, *CPP):
        for _, include in includes(path):
            beside = "/" not in include  # the standard library, or a file of the same folder
            system = include.startswith(("sys/", "x86"))
            if not (beside or system or include.startswith(DIRECTIONS[folder])):
                wrong.append(f"{name_of(path)} includes {include}")
    assert not wrong


def test_only_image_file_includes_openimageio():
    including = {
        name_of(path)
        for path in files(".", *CPP)
        if any(include.startswith("OpenImageIO/") for _, include in includes(path))
    }
    assert including == {"core/sardf/image_file.cpp"}


def test_public_headers_ask_users_for_no_library():
    heavy = ("OpenImageIO/", "Eigen/", "CLI/", "pybind11/", "nlohmann/")
    wrong = [
        f"{name_of(path)} includes {include}"
        for path in files("core/sardf", ".hpp")
        for _, include in includes(path)
        if include.startswith(heavy)
    ]
    assert not wrong


def test_quoted_includes_exist_and_headers_make_no_circle():
    edges: dict[Path, set[Path]] = {}
    for path in [p for top in ("core", "povray_gen", "tests", "bench") for p in files(top, *CPP)]:
        for mark, include in includes(path):
            if mark == "<":
                continue
            places = [base / include for base in (path.parent, ROOT / "core", ROOT)]
            target = next((place for place in places if place.exists()), None)
            assert target, f"{name_of(path)} includes {include}, which does not exist"
            if path.suffix == ".hpp":
                edges.setdefault(path, set()).add(target.resolve())

    finished: set[Path] = set()

    def visit(header: Path, trail: tuple[Path, ...]) -> None:
        assert header not in trail, f"circle: {[name_of(step) for step in (*trail, header)]}"
        if header not in finished:
            for target in edges.get(header, ()):
                visit(target, (*trail, header))
            finished.add(header)

    for header in edges:
        visit(header, ())


def test_versions_agree():
    import sardf

    manifests = [p for p in files("blender_addon") if p.name == "blender_manifest.toml"]
    tuples = []
    for path in files("blender_addon", ".py"):
        for node in ast.parse(path.read_text()).body:
            if isinstance(node, ast.Assign) and ast.unparse(node.targets[0]) == "bl_info":
                tuples.append(ast.literal_eval(node.value)["version"])
    command = subprocess.run(
        [Path(sys.executable).with_name("sardf"), "--version"],
        capture_output=True, text=True, check=True,
    )  # fmt: skip
    assert importlib.metadata.version("sardf") == VERSION
    assert sardf.__version__ == VERSION
    assert VERSION in command.stdout.split()
    assert [tomllib.loads(path.read_text())["version"] for path in manifests] == [VERSION]
    assert tuples == [tuple(int(part) for part in VERSION.split("."))]
    assert f"## {VERSION}" in (ROOT / "CHANGELOG.md").read_text()


def test_every_requirement_is_pinned():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())
    groups = [project["build-system"]["requires"]]
    groups += project["project"]["optional-dependencies"].values()
    assert all("==" in requirement for group in groups for requirement in group)


def test_every_python_test_asserts():
    """A test asserts itself, expects an exception, or calls a helper named check_* or assert_*."""
    silent = []
    for path in files("tests/python", ".py"):
        for node in ast.walk(ast.parse(path.read_text())):
            if not (isinstance(node, ast.FunctionDef) and node.name.startswith("test_")):
                continue
            body = [
                n for n in ast.walk(node) if not (isinstance(n, ast.Assert) and is_true(n.test))
            ]
            calls = [ast.unparse(n.func).split(".")[-1] for n in body if isinstance(n, ast.Call)]
            if not (
                any(isinstance(n, ast.Assert) for n in body)
                or any(re.match(r"_?(check|assert)_|raises$|warns$", call) for call in calls)
            ):
                silent.append(f"{name_of(path)}: {node.name}")
    assert not silent


def is_true(test: ast.expr) -> bool:
    return isinstance(test, ast.Constant) and bool(test.value)


def test_every_cpp_test_asserts():
    """A test expects something itself or calls a helper named check* or expect*."""
    start = re.compile(r"^(?:TYPED_)?TEST(?:_F|_P)?\(([^)]*)\)", re.MULTILINE)
    silent = []
    for path in files("tests/cpp", ".cpp"):
        text = re.sub(r"EXPECT_TRUE\(true\)|SUCCEED\(\)", "", path.read_text())
        tests = list(start.finditer(text))
        ends = [t.start() for t in tests[1:]] + [len(text)]
        for test, end in zip(tests, ends, strict=False):
            if not re.search(r"\b(EXPECT|ASSERT|FAIL|check|expect)", text[test.end() : end]):
                silent.append(f"{name_of(path)}: {test[1]}")
    assert not silent


def test_ci_runs_the_tests_and_nothing_of_its_own():
    lines = (ROOT / ".ci/run").read_text().splitlines()
    assert lines == ["#!/bin/sh", 'exec "$(dirname "$0")/../scripts/test"']


def test_licences():
    apache = (ROOT / "LICENSE").read_text()
    gpl = (ROOT / "blender_addon/LICENSE").read_text()
    assert "Apache License" in apache
    assert "END OF TERMS AND CONDITIONS" in apache
    assert "GNU GENERAL PUBLIC LICENSE" in gpl
    assert "Version 3, 29 June 2007" in gpl

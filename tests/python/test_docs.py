"""The documents are true: their links lead somewhere, their commands and snippets run."""

import json
import os
import re
import shlex
import subprocess
import sys
from pathlib import Path

import pytest
from repository import ROOT, files, name_of

DOCUMENTS = [path for path in files(".", ".md") if not name_of(path).startswith("tests/")]
# test_papers.py runs the commands of these at lower cost.
PAPERS = [ROOT / f"docs/papers/{name}.md" for name in ("sardf", "biswas")]
# test_blender_documents.py runs the Python of this in Blender.
BLENDER = ROOT / "docs/blender.md"
FENCE = re.compile(r"^```(\w*)[^\n]*\n(.*?)^```", re.MULTILINE | re.DOTALL)
PRESETS = json.loads((ROOT / "CMakePresets.json").read_text())["configurePresets"]


def blocks(*languages: str) -> list:
    """One pytest parameter for each fenced block of one of the languages."""
    return [
        pytest.param(
            match[2], id=f"{name_of(path)}:{path.read_text()[: match.start()].count(chr(10)) + 1}"
        )
        for path in DOCUMENTS
        if not (path in PAPERS and "console" in languages)
        and not (path == BLENDER and "python" in languages)
        for match in FENCE.finditer(path.read_text())
        if match[1] in languages
    ]


def commands(block: str) -> list[list[str]]:
    """The words of each line that a reader would type: after `$ ` where some lines have it."""
    text = block.replace("\\\n", " ")
    lines = [line.strip() for line in text.splitlines() if line.strip()]
    if any(line.startswith("$ ") for line in lines):
        lines = [line[2:] for line in lines if line.startswith("$ ")]
    split = [shlex.split(line, comments=True) for line in lines]
    return [words for words in split if words]


@pytest.fixture
def workplace(tmp_path: Path) -> Path:
    """A folder that looks like the repository to a reader's command, where results may be left."""
    for folder in ("scenes", "examples", "blender_addon", "docs", "scripts"):
        (tmp_path / folder).symlink_to(ROOT / folder)
    return tmp_path


def run(command: list[str], folder: Path) -> None:
    path = os.pathsep.join((str(Path(sys.executable).parent), os.environ["PATH"]))
    done = subprocess.run(
        command, cwd=folder, env=os.environ | {"PATH": path}, capture_output=True, text=True,
        stdin=subprocess.DEVNULL,
    )  # fmt: skip
    assert done.returncode == 0, f"{shlex.join(command)}\n{done.stdout}{done.stderr}"


@pytest.mark.parametrize("snippet", blocks("python"))
def test_python_snippets_run(snippet, workplace):
    run([sys.executable, "-W", "error", "-c", snippet], workplace)
    assert not re.search(r"^\s*(pass|\.\.\.)$", snippet, re.MULTILINE)


@pytest.mark.parametrize("example", sorted((ROOT / "examples").glob("*.py")), ids=name_of)
def test_examples_run(example, workplace):
    before = set(workplace.iterdir())
    run([sys.executable, "-W", "error", str(example)], workplace)
    written = set(workplace.iterdir()) - before
    assert written
    assert all(path.stat().st_size > 0 for path in written)


@pytest.mark.parametrize("block", blocks("bash", "console", "sh"))
def test_commands_run(block, workplace):
    """Runs sardf and python; of the rest it checks that what is named exists."""
    assert commands(block)
    for words in commands(block):
        program = words[0].removeprefix(".venv/bin/")
        if program in ("sardf", "python"):
            run([program, *words[1:]], workplace)
        elif program.startswith("scripts/"):
            assert os.access(ROOT / program, os.X_OK), program
        elif program == "cmake" and "--preset" in words:
            wanted = words[words.index("--preset") + 1]
            assert wanted in [preset["name"] for preset in PRESETS], wanted
        else:
            assert re.match(r"blender|povray|git|ruff|pytest|build/|cmake$", program), program
        for word in words[1:]:
            if re.match(r"(blender_addon|scenes|scripts|examples|tests)/", word):
                assert (ROOT / word).exists() or list(ROOT.glob(word)), word


@pytest.mark.parametrize("path", DOCUMENTS, ids=name_of)
def test_links_lead_somewhere(path):
    text = FENCE.sub("", path.read_text())
    targets = re.findall(r"\]\(([^)#\s]+)", text)
    broken = [
        target
        for target in targets
        if not re.match(r"https?:|mailto:", target) and not (path.parent / target).exists()
    ]
    assert not broken


def test_folder_map_of_the_readme_is_true():
    text = (ROOT / "README.md").read_text()
    rows = re.findall(r"^\| (`[^|]+) \|", text, re.MULTILINE)
    named = {folder for row in rows for folder in re.findall(r"`([\w/]+)`", row)}
    tops = {
        path.relative_to(ROOT).parts[0] for path in files() if len(path.relative_to(ROOT).parts) > 1
    }
    assert all((ROOT / folder).is_dir() for folder in named), named
    assert {top for top in tops if not top.startswith(".")} == {f.split("/")[0] for f in named}

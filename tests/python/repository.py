"""What the checks of the repository itself share: where it is and which files are its own."""

import ast
import re
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
MADE_BY_TOOLS = re.compile(r"build|dist|output|\.git|\.venv.*|\..*_cache")


def files(folder: str = ".", *suffixes: str) -> list[Path]:
    """Our own files below `folder`, with one of the suffixes if any are given."""
    found = []
    for path in sorted((ROOT / folder).rglob("*")):
        parts = path.relative_to(ROOT).parts
        if MADE_BY_TOOLS.fullmatch(parts[0]) or "__pycache__" in parts or not path.is_file():
            continue
        if not suffixes or path.suffix in suffixes:
            found.append(path)
    return found


def name_of(path: Path) -> str:
    return path.relative_to(ROOT).as_posix()


def imported_modules(path: Path) -> set[str]:
    """Names of all absolute imports of a Python file, wherever in it they stand."""
    modules = set()
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.Import):
            modules |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.level == 0:
            modules |= {f"{node.module}.{alias.name}" for alias in node.names}
    return modules


def includes(path: Path) -> list[tuple[str, str]]:
    """(`<` or `"`, name) of every #include of a C++ file."""
    return re.findall(r'^\s*#\s*include\s*([<"])([^>"]+)', path.read_text(), re.MULTILINE)

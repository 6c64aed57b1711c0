"""Figures and numbers as files that appear under their names only when they are complete."""

import csv
import sys
from pathlib import Path

from sardf._command import completed
from sardf._words import choose, fail
from sardf.plot import parts

FIGURES = ("png", "svg", "pdf")
FORMATS = (*FIGURES, "csv")
# No dates: the same call writes the same bytes.
METADATA = {
    "png": {"Software": None},
    "svg": {"Date": None, "Creator": None},
    "pdf": {"CreationDate": None, "Producer": None, "Creator": None},
}


def format_of(path) -> str:
    """The format by the ending of the path: png, svg, pdf or csv, which "-" is too; or Error."""
    if str(path) == "-":
        return "csv"
    ending = Path(path).suffix.lower().removeprefix(".")
    if not ending:
        fail(f"{path}: the output has no ending; accepted are .{', .'.join(FORMATS)}")
    return choose("format for a figure or its numbers", ending, list(FORMATS))


def save(figure, path, dpi: int = 150) -> None:
    """Writes a figure as .png, .svg or .pdf. Raises Failure where that is not possible."""
    kind = format_of(path)
    if kind not in FIGURES:
        fail(f"{path}: a figure is written as .{', .'.join(FIGURES)}")
    with parts.settings(), completed(path) as temporary:
        figure.savefig(temporary, format=kind, dpi=dpi, metadata=METADATA[kind])


def write_csv(header, rows, path) -> None:
    """Writes numbers as CSV, each with the digits that give it back exactly; "-": standard output.

    header: names of columns; rows: (N, columns), as table() gives them.
    """
    if str(path) == "-":
        _write_rows(sys.stdout, header, rows)
        return
    with completed(path) as temporary, open(temporary, "w", newline="", encoding="utf-8") as file:
        _write_rows(file, header, rows)


def _write_rows(file, header, rows) -> None:
    writer = csv.writer(file, lineterminator="\n")
    writer.writerow(header)
    writer.writerows(rows.tolist())

"""A paper: its figures beside ours, the commands that draw these, and the page that shows them."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from papers.page import paragraph, pictures, words_of

ROOT = Path(__file__).resolve().parents[2]
FOLDER = ROOT / "docs/papers"


@dataclass(frozen=True)
class Figure:
    """One figure of a paper. shows: what it shows, in our words. plots: the arguments of
    sardf.plot for each of our pictures. chosen: what is not printed and what we chose. text: more,
    as Markdown, after the pictures."""

    name: str
    shows: str
    plots: tuple[str, ...] = ()
    chosen: str = ""
    text: str = ""


@dataclass(frozen=True)
class Part:
    """A part of the paper with its figures."""

    title: str
    words: str
    figures: tuple[Figure, ...]


@dataclass(frozen=True)
class Drawing:
    """A picture's file name, and the module and its arguments that draw it."""

    image: str
    module: str
    words: list[str]


@dataclass(frozen=True)
class Paper:
    """name: of the page, NAME.md, of its pictures, NAME_*.png, and of its words, NAME_words.txt
        beside this file, in which {key} stands for what `parts` or `values` have under that key and
        {parts} for all parts.
    parts: in the order of the paper. extra: figures of our own. others: what is not drawn by
        sardf.plot. values: more to be put into the words.
    folder: holds the page, and its pictures in images/.
    """

    name: str
    parts: dict[str, Part]
    extra: tuple[Figure, ...] = ()
    others: tuple[Drawing, ...] = ()
    values: Callable[[], dict[str, str]] = dict
    folder: Path = FOLDER

    @property
    def page(self) -> Path:
        return self.folder / f"{self.name}.md"

    @property
    def pictures_folder(self) -> Path:
        return self.folder / "images"

    def figures(self) -> list[Figure]:
        return [figure for part in self.parts.values() for figure in part.figures] + [*self.extra]

    def images(self, figure: Figure) -> list[str]:
        """The names of the files of a figure's pictures."""
        word, _, number = figure.name.partition(" ")
        stem = f"{self.name}_fig{int(number):02}" if number else f"{self.name}_{word}_"
        letters = "abcdef" if len(figure.plots) > 1 else [""]
        return [f"{stem}{letter}.png" for letter in letters[: len(figure.plots)]]

    def drawings(self) -> list[Drawing]:
        """Every picture of the page."""
        plots = [
            Drawing(image, "sardf.plot", words_of(plot, image))
            for figure in self.figures()
            for image, plot in zip(self.images(figure), figure.plots, strict=True)
        ]
        return [*plots, *self.others]

    def generated(self) -> str:
        """The whole page."""
        words = Path(__file__).with_name(f"{self.name}_words.txt").read_text()
        parts = {key: self.part_text(part) for key, part in self.parts.items()}
        return words.format(**parts, parts="\n\n".join(parts.values()), **self.values())

    def part_text(self, part: Part) -> str:
        blocks = [f"## {part.title}", paragraph(part.words)]
        blocks += [self.figure_text(figure) for figure in part.figures]
        return "\n\n".join(blocks)

    def figure_text(self, figure: Figure) -> str:
        blocks = [
            f"### {figure.name}",
            paragraph(f"**In the paper:** {figure.shows}"),
            self.pictures_of(figure, f"{figure.name}, drawn by sardf"),
            figure.text.strip(),
            figure.chosen and paragraph(f"**Not printed, chosen here:** {figure.chosen}"),
        ]
        return "\n\n".join(block for block in blocks if block)

    def pictures_of(self, figure: Figure, alternative: str) -> str:
        return pictures(self.images(figure), alternative, figure.plots)

"""What every page of a paper is made of: paragraphs, tables, commands under pictures."""

import re
import shlex
import textwrap

WIDTH = 120
TOGETHER = "\0"  # for a space that stays within its line


def paragraph(text: str) -> str:
    kept = re.sub(r"\{[^}]*\}", lambda found: found[0].replace(" ", TOGETHER), text)
    filled = textwrap.fill(kept, WIDTH, break_long_words=False, break_on_hyphens=False)
    return filled.replace(TOGETHER, " ")


def table(head, rows) -> str:
    """A Markdown table; columns of numbers stand at the right, but for the first."""
    rows = [[str(cell) for cell in row] for row in rows]
    columns = list(zip(*rows, strict=True))
    rules = ["---:" if all(is_number(cell) for cell in column) else "---" for column in columns]
    rules[0] = "---"
    return "\n".join(f"| {' | '.join(row)} |" for row in [head, rules, *rows])


def is_number(cell: str) -> bool:
    return bool(re.match(r"-?[\d.]+(e-?\d+)?( mm)?$", cell))


def command_of(arguments: str, image: str) -> str:
    """The line that a reader types for a picture, folded where it is long, before an option if
    possible."""
    lines, line = [], "$ python -m sardf.plot"
    for option in by_option([*quoted(arguments), "--dpi 100", f"-o {image}"]):
        whole = len(" ".join(option)) < WIDTH - 8
        for words in [option] if whole else [[word] for word in option]:
            added = " ".join(words)
            if len(line) + 1 + len(added) > WIDTH - 2:
                lines.append(line + " \\")
                line = "   "
            line += " " + added
    return "\n".join([*lines, line])


def by_option(words) -> list[list[str]]:
    """Options together with their values."""
    groups: list[list[str]] = [[]]
    for word in words:
        if word.startswith("-"):
            groups.append([])
        groups[-1].append(word)
    return groups


def quoted(arguments: str) -> list[str]:
    """The words of the arguments, with double quotes where a shell needs them."""
    needs = re.compile(r"[ <>()]|^=|^-?[\d.]+,|^$")
    return [f'"{word}"' if needs.search(word) else word for word in shlex.split(arguments)]


def words_of(arguments: str, image) -> list[str]:
    """What that line gives to the program."""
    return [*shlex.split(arguments), "--dpi", "100", "-o", str(image)]


def pictures(images, alternative: str, plots) -> str:
    """Pictures, and below them the commands that draw them."""
    shown = "\n".join(
        f"![{alternative}{f', picture {place}' if len(images) > 1 else ''}](images/{image})"
        for place, image in enumerate(images, 1)
    )
    typed = "\n".join(command_of(plot, image) for plot, image in zip(plots, images, strict=True))
    return f"{shown}\n\n```console\n{typed}\n```"

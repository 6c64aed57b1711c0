"""python -m sardf.plot: figures from one command."""

import sys

import sardf
from sardf import _command, plot
from sardf._words import fail
from sardf.plot.arguments import parse
from sardf.plot.look import Look, bands_from, lines_from
from sardf.plot.output import format_of


def main(words=None) -> int:
    """Runs the command line; the exit code."""
    return _command.run("sardf.plot", run, parse(sys.argv[1:] if words is None else words))


def run(options) -> None:
    """Computes what the options ask for and writes every output."""
    formats = [format_of(path) for path in options.output]
    if not 10 <= options.dpi <= 2400:
        fail(f"dpi is {options.dpi}; 10 to 2400 is accepted")
    look = _look(options)
    scene = sardf.load(options.scene)
    chosen = plot.quantities(
        scene, options.field, options.fraction, options.attribute, options.materials,
        options.blend, options.show,
    )  # fmt: skip
    kinds = {"surface": _surfaces, "segment": _segment, "section": _section}
    kind = "surface" if options.isosurface else "segment" if options.segment else "section"
    draw, numbers = kinds[kind](scene, chosen, options, look)
    figure = draw() if any(name != "csv" for name in formats) else None
    for path, name in zip(options.output, formats, strict=True):
        if name == "csv":
            plot.write_csv(*numbers(), path)
        else:
            plot.save(figure, path, options.dpi)


def _look(options) -> Look:
    return Look(
        bands=None if options.bands is None else bands_from(options.bands),
        lines=None if options.lines is None else lines_from(options.lines),
        stripes=options.stripes, label_lines=options.label_lines, outline=options.outline,
        blank=options.blank or _only_vectors(options), separate_scales=options.separate_scales,
        limits=options.limits, colors=options.colors, scale_bar=options.scale_bar,
        arrow_lengths=options.arrow_lengths, columns=options.columns, size=options.size,
        title=options.title,
    )  # fmt: skip


def _only_vectors(options) -> bool:
    """Whether vectors are to be drawn and nothing behind them."""
    behind = options.field or options.fraction or options.attribute or options.materials
    return bool(options.arrows or options.streamlines) and not (behind or options.segment)


def _plane(options):
    return plot.plane(options.section if options.section is not None else options.plane)


def _make_section(scene, chosen, options):
    resolution = 400 if options.resolution is None else options.resolution
    return plot.section(
        scene, _plane(options), chosen, window=options.window, resolution=resolution,
        only=options.only, outlines=options.outlines, arrows=options.arrows,
        streamlines=options.streamlines, arrow_count=options.arrow_count,
    )  # fmt: skip


def _section(scene, chosen, options, look):
    section = _make_section(scene, chosen, options)
    return lambda: plot.draw_sections(section, look), section.table


def _segment(scene, chosen, options, look):
    segment = plot.segment(
        scene, *options.segment, chosen, samples=options.samples, only=options.only
    )
    section = None
    if options.section is not None or options.plane is not None:
        above = [quantity for quantity in chosen if quantity.kind == "colors"] or chosen
        section = _make_section(scene, above[:1], options)
    return lambda: plot.draw_segment(segment, section, look), segment.table


def _surfaces(scene, chosen, options, look):
    if options.through == "povray":
        return (
            lambda: plot.draw_pictures(
                chosen, options.level, options.view, look, options.dpi, _report("POV-Ray")
            ),
            lambda: fail("a picture through POV-Ray has no numbers; leave out --through povray"),
        )
    resolution = 128 if options.resolution is None else options.resolution
    surfaces = plot.surfaces(
        scene, chosen, level=options.level, resolution=resolution, progress=_report("meshing")
    )
    return lambda: plot.draw_surfaces(surfaces, options.view, look), lambda: _only(surfaces).table()


def _report(what: str):
    """Progress on a terminal's last line."""
    if not sys.stderr.isatty():
        return None

    def say(share: float) -> bool:
        end = "\n" if share >= 1 else "\r"
        print(f"{what}: {share:.0%}", end=end, file=sys.stderr, flush=True)
        return True

    return say


def _only(surfaces):
    if len(surfaces) > 1:
        fail(f"{len(surfaces)} surfaces do not fit into one CSV file; choose one")
    return surfaces[0]


if __name__ == "__main__":
    sys.exit(main())

"""fdvv library."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from fdvv.cli import ui
from fdvv.cli.options import Workers, executor_options, jnds_option, opened_jnds
from fdvv.force_text import force_name

COUNT = ui.option("-n", "--count", type=click.IntRange(1), default=10, help="Show so many.")
CSV = ui.option("-o", "--output", type=ui.PATH, help="Write every hit into this .csv too.")
FIGURES = ("travel_mm", "peak_cN", "drop_cN")
NAME, PLACE = 28, 14
"""Letters of a name and of a folder in a table."""


@click.group(invoke_without_command=True)
@ui.json_option
@click.pass_context
def library(ctx: click.Context, as_json: bool) -> None:
    """List the built-in buttons; build and search libraries of measured ones.

    Without a subcommand the built-in buttons are listed.
    """
    if ctx.invoked_subcommand is None:
        ctx.invoke(list_, as_json=as_json)


@library.command(name="list")
@ui.json_option
def list_(as_json: bool) -> None:
    """List the built-in buttons."""
    from fdvv.model.file import builtin_names, load_builtin
    from fdvv.model.landmarks import landmarks

    models = [load_builtin(name) for name in builtin_names()]
    marks = [landmarks(model).to_dict() for model in models]
    if as_json:
        entries = [
            {"name": m.name, "source": m.provenance.source, "licence": m.provenance.licence, "landmarks": k}
            for m, k in zip(models, marks, strict=True)
        ]
        ui.print_json({"buttons": entries})
        return
    columns = ("travel_mm", "peak_cN", "snap_ratio", "bottom_out_cN")
    rows = [
        [m.name, m.provenance.source.partition(",")[0], *(k[c] for c in columns)]
        for m, k in zip(models, marks, strict=True)
    ]
    ui.print_table(["button", "source", *map(force_name, columns)], rows, left=2)


@library.command()
@click.argument("folders", nargs=-1, required=True, type=ui.FOLDER)
@ui.option(
    "-o", "--output", type=ui.NEW_FOLDER, required=True, help="The library's folder, new or of these folders."
)
@executor_options
@ui.json_option
def build(folders: tuple[Path, ...], output: Path, where: Workers, as_json: bool) -> None:
    """Read every measured file below folders into a library that can be searched.

    Files of any layout that fdvv reads, thousands of them: landmarks, type and curves of each go into one
    Parquet file (docs/reference/library-files.md); a file that cannot be used is kept with its reason.
    Whatever ended a build, the same command goes on; files that did not change are not read again.
    """
    from fdvv_studio.library.build import build_library

    ui.check_folder(output)
    with where.at_work(output, "files", 1) as (executor, tell):
        summary = build_library(folders, output, executor, tell)
    if as_json:
        ui.print_json(summary.to_dict())
        return
    click.echo(f"{output}: {ui.counted(summary.buttons, 'button')} of {ui.counted(summary.files, 'file')}")
    click.echo(f"read {summary.read}, not changed {summary.kept}, no longer there {summary.gone}")
    if summary.refused:
        click.echo(f"refused {summary.refused}; why: fdvv library refused {output}")


@library.command()
@click.argument("folder", metavar="LIBRARY", type=ui.FOLDER)
@click.argument("words", nargs=-1)
@ui.option("--sort", default="match", help="match, name, kind, date, or a figure's column.")
@ui.option("--descending", is_flag=True, help="Largest first.")
@COUNT
@CSV
@ui.json_option
def search(
    folder: Path, words: tuple[str, ...], count: int, output: Path | None, as_json: bool, **order: Any
) -> None:
    """Find buttons of a library by words and conditions.

    WORDS must all match name, folder or what the maker states; a condition is a column with a bound, quoted
    for the shell: 'peak_cN>=50' 'travel_mm=3..3.5' kind=tactile,dome. Without words all are found.
    """
    from fdvv_studio.library.library import Library, library_query

    ui.check_output(output, ".csv")
    query = library_query(" ".join(words), **order)
    opened = Library(folder)
    hits, mended = opened.find(query)
    ui.print_warnings([f"nothing is called {word}; the nearest words were taken" for word in mended])
    document = {"library": str(folder), "buttons": len(opened.rows), "found": len(hits)}
    _print_hits(hits, count, output, as_json, document)


@library.command()
@click.argument("folder", metavar="LIBRARY", type=ui.FOLDER)
@click.argument("button")
@ui.choice_option("--by", ("all", "curve", "landmarks"), help="Compare force and shape, landmarks, or all.")
@COUNT
@CSV
@jnds_option
@ui.json_option
def like(
    folder: Path, button: str, by: str, count: int, output: Path | None, jnds_from: Path | None, as_json: bool
) -> None:
    """Find the buttons of a library that feel most like one.

    BUTTON is a built-in, a *.fdvv.json file, a measured file, or the id of one of the library. Distances are
    in just noticeable differences (docs/explanation/library.md); they are an estimate, not tried on people.
    """
    from fdvv_studio.library.library import Library

    ui.check_output(output, ".csv")
    opened, jnds = Library(folder), opened_jnds(jnds_from)
    hits = opened.like(button, by, len(opened.rows), jnds)  # type: ignore[arg-type]
    document = {"library": str(folder), "like": button, "by": by, "found": len(hits)}
    _print_hits(hits, count, output, as_json, {**document, "jnds": jnds.to_dict()})
    if not as_json:
        ui.print_wrapped(f"counted in {jnds.origin}")


@library.command()
@click.argument("folder", metavar="LIBRARY", type=ui.FOLDER)
@ui.json_option
def refused(folder: Path, as_json: bool) -> None:
    """List the files of a library's folders that could not be used, and why."""
    from fdvv_studio.library.library import Library

    problems = list(Library(folder).refused())
    if as_json:
        ui.print_json({"refused": [{"place": place, "reason": reason} for place, reason in problems]})
        return
    for place, reason in problems:
        click.echo(ui.one_line(f"{place}: {reason}"))


def _print_hits(
    hits: list[Any], count: int, output: Path | None, as_json: bool, document: dict[str, Any]
) -> None:
    from fdvv_studio.library.library import write_hits

    if output:
        write_hits(output, hits)
    if as_json:
        ui.print_json({**document, "hits": [hit.to_dict() for hit in hits[:count]]})
        return
    near = any(hit.distance_JND is not None for hit in hits)
    rows = [
        [
            ui.one_line(hit.row.name, NAME), ui.one_line(hit.row.collection, PLACE), hit.row.kind,
            *([hit.distance_JND] if near else []), *(getattr(hit.row, c) for c in FIGURES), hit.row.id,
        ]
        for hit in hits[:count]
    ]  # fmt: skip
    ui.print_table(
        ["button", "folder", "type", *(["JND"] if near else []), *map(force_name, FIGURES), "id"],
        rows,
        left=3,
    )
    more = f", {len(hits) - count} more with -n" if len(hits) > count else ""
    click.echo(f"{len(hits)} found{more}")
    ui.print_written(output)

"""fdvv hardware: what to print, check and export; bill, circuit and selftest come from beside."""

from __future__ import annotations

from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from fdvv.cli import ui
from fdvv_rig.cli.circuit import bill, circuit
from fdvv_rig.cli.selftest import selftest

if TYPE_CHECKING:
    from fdvv_rig.dimensions import Dimensions
    from fdvv_rig.exported import FolderCheck
    from fdvv_rig.parts import Part

GAPS_SHOWN = 10
"""Clearances in the table; --json gives all."""

dimensions_option = ui.option(
    "--from", "source", type=ui.PATH, help="Dimensions from a TOML file; see parts --dimensions."
)
set_option = ui.option(
    "--set",
    "words",
    multiple=True,
    metavar="NAME=VALUE",
    help="One dimension, over those of the file; repeatable.",
)


@click.group()
def hardware() -> None:
    """Build a rig: what to print and to buy, how to wire it, and which part is wrong.

    Dimensions of bought parts are assumed unless you measured yours; everything printed follows from them.
    """


@hardware.command()
@ui.option("--dimensions", "as_toml", is_flag=True, help="Print every dimension as TOML instead.")
@dimensions_option
@set_option
@ui.json_option
def parts(as_toml: bool, source: Path | None, words: tuple[str, ...], as_json: bool) -> None:
    """List the printed parts, or the dimensions they follow from.

    Masses and times are estimates for the default dimensions: three lines about every face, a quarter of
    infill.
    """
    from fdvv_rig.dimension_file import dimensions_toml, load_dimensions
    from fdvv_rig.parts import PARTS

    if as_toml:
        d = load_dimensions(source, words)
        if as_json:
            ui.print_json({"dimensions": _described(d)})
        else:
            click.echo(dimensions_toml(d), nl=False)
        return
    if source or words:
        raise click.UsageError("--from and --set change dimensions: add --dimensions, or use export")
    if as_json:
        ui.print_json({"parts": [_part(part) for part in PARTS]})
        return
    rows = [
        [p.name, p.use, str(p.count), ui.number(p.mass_g, 1), ui.number(p.print_h, 1), _size(p.made.box_mm)]
        for p in PARTS
    ]
    ui.print_table(["part", "count", "g", "h", "mm"], [[row[0], *row[2:]] for row in rows])
    click.echo("")
    for name, use, *_ in rows:
        ui.print_wrapped(f"{name}: {use}")


def _part(part: Part) -> dict[str, Any]:
    named = ("name", "title", "use", "lies", "material", "count", "mass_g", "print_h")
    made = {"volume_cm3": part.made.volume_cm3, "box_mm": part.made.box_mm}
    return {name: getattr(part, name) for name in named} | made


def _described(d: Dimensions) -> dict[str, Any]:
    from fdvv_rig.dimensions import meaning_of, source_of

    return {
        name: {"value": value, "meaning": meaning_of(name), "source": source_of(name)}
        for name, value in asdict(d).items()
    }


def _size(box_mm: tuple[float, float, float]) -> str:
    return " x ".join(f"{side:.0f}" for side in box_mm)


@hardware.command()
@click.argument("folder", type=ui.NEW_FOLDER)
@dimensions_option
@set_option
@ui.json_option
def export(folder: Path, source: Path | None, words: tuple[str, ...], as_json: bool) -> None:
    """Make every printed part anew: STL, STEP and drawing into FOLDER.

    Equal dimensions give equal bytes. Needs the extra cad; the parts of the default dimensions lie ready in
    the source's hardware/.
    """  # fmt: skip
    from fdvv_rig.cad.export import export_parts
    from fdvv_rig.dimension_file import load_dimensions

    d = load_dimensions(source, words)
    ui.check_folder(folder)
    with ui.stages() as tell:
        manifest = export_parts(folder, d, lambda name, done, total: tell(f"making {name}", done, total))
    files = [name for made in manifest.parts.values() for name in made.files]
    if as_json:
        ui.print_json({"folder": str(folder), "digest": manifest.digest, "files": files})
        return
    click.echo(f"{len(files)} files of {len(manifest.parts)} parts in {folder}; dimensions {manifest.digest}")


@hardware.command()
@click.argument("folder", type=ui.NEW_FOLDER, default="hardware")
@ui.json_option
@click.pass_context
def check(context: click.Context, folder: Path, as_json: bool) -> None:
    """Check exported parts in FOLDER: closed, printable, and nothing meets in the rig at any travel.

    Tells the smallest clearances, the limiter's reach, step and play, and what tolerances the sensor's mount
    takes up. Exit status 1 where a part is wrong or two collide.
    """  # fmt: skip
    from fdvv_rig.exported import check_exported

    with ui.stages() as tell:
        found = check_exported(folder, tell)
    if as_json:
        ui.print_json(_document(found))
    else:
        _print(found)
    context.exit(0 if found.good else 1)


def _document(found: FolderCheck) -> dict[str, Any]:
    return {
        "good": found.good,
        "parts": [asdict(part) for part in found.parts],
        "meetings": [asdict(meeting) for meeting in found.meetings],
        "clearances": [asdict(clearance) for clearance in found.clearances],
        "limiter": _limiter(found.dimensions),
        "slider": _slider(found.dimensions),
        "sensor_mount": _mount(found.dimensions),
    }


def _limiter(d: Dimensions) -> dict[str, float]:
    from fdvv_rig.limiter import Limiter

    limiter = Limiter(d)
    low_mm, high_mm = limiter.range_mm
    return {
        "from_mm": low_mm,
        "to_mm": high_mm,
        "step_mm_per_deg": limiter.mm_per_deg,
        "play_mm": limiter.play_mm,
        "torque_N_mm": limiter.torque_N_mm,
        "torque_ratio": limiter.torque_ratio,
    }


def _slider(d: Dimensions) -> dict[str, float]:
    from fdvv_rig.layout import Layout
    from fdvv_rig.tolerance import tilt_deg, turn_deg

    return {"turn_deg": turn_deg(d, Layout(d).tongue_out_mm), "tilt_deg": tilt_deg(d)}


def _mount(d: Dimensions) -> dict[str, Any]:
    from fdvv_rig.tolerance import core_stack

    stack = core_stack(d)
    return {
        "causes_mm": {cause.name: cause.either_way_mm for cause in stack.causes},
        "worst_mm": stack.worst_mm,
        "likely_mm": stack.likely_mm,
        "room_mm": (d.lvdt_bore_mm - d.lvdt_core_diameter_mm) / 2,
        "float_mm": d.float_mm,
    }


def _print(found: FolderCheck) -> None:
    rows = []
    for p in found.parts:
        surface = f"{p.open_edges} open edges" if p.open_edges else "closed"
        rows.append([p.name, ui.number(p.volume_cm3), _size(p.box_mm), surface])
    ui.print_table(["part", "cm³", "mm", "surface"], rows)
    for part in found.parts:
        for wrong in part.wrong:
            click.echo(ui.one_line(f"{part.name}: {wrong}"))
    for m in found.meetings:
        click.echo(f"{m.one} meets {m.other} at travel {m.travel_mm:.2f} mm: {m.shared_mm3:.2f} mm³")
    if found.clearances:
        click.echo("")
        shown = found.clearances[:GAPS_SHOWN]
        ui.print_table(
            ["closest, moving", "beside", "mm", "at travel mm"],
            [[c.one, c.other, ui.number(c.gap_mm), ui.number(c.travel_mm)] for c in shown],
            left=2,
        )
    _print_figures(found.dimensions)
    verdict = "every part is whole and nothing meets" if found.good else "the parts are not good"
    click.echo(f"\n{verdict}; {len(found.parts)} parts")


def _print_figures(d: Dimensions) -> None:
    limiter, mount = _limiter(d), _mount(d)
    click.echo("")
    ui.print_wrapped(
        f"limiter: stops from {limiter['from_mm']:.2f} to {limiter['to_mm']:.2f} mm, "
        f"{limiter['step_mm_per_deg']:.3f} mm a degree, play {limiter['play_mm']:.2f} mm, "
        f"{100 * limiter['torque_ratio']:.0f} % of the stall torque under {d.finger_force_N:g} N"
    )
    turn_deg, tilt_deg = _slider(d).values()
    ui.print_wrapped(f"slider: turns {turn_deg:.2f}° and tilts {tilt_deg:.2f}° at most, either way")
    ui.print_wrapped(
        f"sensor's mount: tolerances {mount['worst_mm']:.2f} mm at worst, {mount['likely_mm']:.2f} mm likely"
        f"; the core has {mount['room_mm']:.2f} mm, the mount moves {mount['float_mm']:.2f} mm"
    )


for command in (bill, circuit, selftest):
    hardware.add_command(command)

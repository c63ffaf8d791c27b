"""fdvv tune: a person at a rig rates or compares vibrations, and the best are kept."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from fdvv.cli._exciter_options import exciter_option, opened_exciter
from fdvv.cli._output import Finite, check_output, counted, json_option, number, print_json, print_table
from fdvv.cli._session_options import beside, open_session, session_options
from fdvv.cli._tune_view import TuneView

if TYPE_CHECKING:
    from fdvv.vibration import Comparing, Rating


@click.command()
@click.argument("button")
@click.argument("actuation", required=False, type=click.Path(path_type=Path, exists=True, dir_okay=False))
@session_options
@click.option(
    "--compare/--rate", default=True, show_default=True,
    help="Two after another, which is closer to the real button; or each by itself, 1 to 7.",
)  # fmt: skip
@click.option("--comparisons", type=click.IntRange(1, 1000), help="Per velocity at most.  [default: 3 each]")
@click.option("--repeats", type=click.IntRange(2, 20), default=3, show_default=True, help="Of each rating.")
@click.option(
    "--frequency-ratio", "frequency_ratios", type=Finite(min=0.1, max=10), multiple=True, default=(1.0,),
    show_default=True, help="Of the measured frequency; repeatable.",
)  # fmt: skip
@click.option(
    "--gain-ratio", "gain_ratios", type=Finite(min=0.05, max=20), multiple=True, default=(1.0, 2.0),
    show_default=True, help="Of the measured strength; repeatable.",
)  # fmt: skip
@exciter_option
@click.option(
    "--simulated-observer", "simulated", is_flag=True,
    help="Answers come from a made-up preference: a trial of the machinery, evidence of nothing.",
)  # fmt: skip
@click.option("-o", "--output", type=click.Path(path_type=Path), help="The *.fdvv.json to write.")
@json_option
def tune(
    button: str,
    actuation: Path | None,
    device: str,
    rig: Path | None,
    finger: Path | None,
    seed: int,
    velocities_mm_s: tuple[float, ...],
    folder: Path | None,
    pace_ratio: float,
    compare: bool,
    comparisons: int | None,
    repeats: int,
    frequency_ratios: tuple[float, ...],
    gain_ratios: tuple[float, ...],
    exciter: Path | None,
    simulated: bool,
    output: Path | None,
    as_json: bool,
) -> None:
    """Tune the vibration of a button's press with a person.

    BUTTON is a built-in or a *.fdvv.json with a vibration; ACTUATION what fdvv compensate wrote. At every
    velocity the measured vibration and templates around it, decaying sines like the paper's, are pressed
    blind: only numbers are shown. The best are written into the model. Keep the real button beside the rig.

    Every answer is on file before the next question; the same command goes on where a session stopped.
    """
    from fdvv.model import SUFFIX, save_model
    from fdvv.vibration import TemplateGrid
    from fdvv.workflow import TuneSetup, candidates_for, load_actuation, open_model, simulated_observer
    from fdvv.workflow import tune_vibration as ask

    check_output(output, SUFFIX)
    _check_observer(device, simulated)
    model, known = open_model(button), opened_exciter(exciter)
    learned = load_actuation(actuation) if actuation else None
    grid = TemplateGrid(frequency_ratios, gain_ratios)
    setup = TuneSetup(
        learned.surface if learned else None, known, grid, "simulated observer" if simulated else "person"
    )
    default = beside(output, button, "tune-session")
    session = open_session(folder, device, (seed, rig, finger), pace_ratio, default)
    view = TuneView(not simulated, as_json)
    answer = view.answer
    if simulated:
        candidates = candidates_for(model, sorted(velocities_mm_s), grid, known)
        answer = simulated_observer(candidates, seed).answer
    method = _method(compare, comparisons, repeats, seed)
    found = session.open_device(device)
    try:
        result = ask(found, model, velocities_mm_s, method, answer, setup, session, view.guide)
    finally:
        if hasattr(found, "close"):
            found.close()
    if output:
        save_model(result.model, output)
    _print({**result.to_dict(), "receipt": result.receipt.to_dict()}, as_json)
    if output and not as_json:
        click.echo(f"written to {output}")


def _check_observer(device: str, simulated: bool) -> None:
    """Refuse an observer who cannot feel the device, or one who is not needed."""
    from fdvv.device import pressed_by_person
    from fdvv.errors import InputError

    if simulated and pressed_by_person(device):
        reason = "a person presses it, and nobody's answers would be kept"
        raise InputError("--simulated-observer", device, reason, "leave the option out")
    if not simulated and not pressed_by_person(device):
        reason = "nobody can feel a simulated device"
        raise InputError("--device", device, reason, "use serial:PORT, or add --simulated-observer")


def _method(compare: bool, comparisons: int | None, repeats: int, seed: int) -> Rating | Comparing:
    from fdvv.vibration import Comparing, Rating

    return Comparing(comparisons, seed=seed) if compare else Rating(repeats, seed)


def _print(document: dict[str, Any], as_json: bool) -> None:
    if as_json:
        print_json(document)
        return
    told = " (simulated)" if document["simulated"] else ""
    click.echo(f"{document['model']} on {document['device']}{told}, answers of a {document['observer']}")
    click.echo(f"{document['method']}, {counted(document['answers'], 'answer')}")
    for found in document["velocities"]:
        click.echo(f"{found['velocity_mm_s']:g} mm/s: {found['explanation']}")
        print_table(["vibration", "Hz", "m/s2", "score", "error", "spectrum", "ST-SIM"], _rows(found))


def _rows(found: dict[str, Any]) -> list[list[str]]:
    rows = []
    for i, candidate in enumerate(found["candidates"]):
        mode = max(candidate["vibration"]["modes"], key=lambda m: abs(m["amplitude_m_s2"]))
        name = "measured" if i == 0 else f"template {i}"
        mark = " *" if i == found["best"] else " =" if i in found["alike"] else ""
        scores = candidate["objective"]
        figures = (mode["frequency_Hz"], mode["amplitude_m_s2"], candidate["score"], candidate["error"])
        alike = (scores["spectral_similarity"], scores["st_sim"])
        rows.append([name + mark, *(number(v) for v in (*figures, *alike))])
    return rows

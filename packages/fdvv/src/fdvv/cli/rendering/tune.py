"""fdvv tune: a person at a rig rates or compares vibrations, and the best are kept."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from fdvv.cli import ui
from fdvv.cli.cue import show_cue
from fdvv.cli.options import closing, exciter_option, opened_exciter
from fdvv.cli.rendering.session import Pressing, beside, session_options
from fdvv.cli.settings import settings_options
from fdvv.errors import InputError
from fdvv.rendering.settings import TuneSettings

if TYPE_CHECKING:
    from fdvv.rendering.session_run import Guide, PressRequest
    from fdvv.vibration.tune import Preferred, Question

RATE = "how close to the real button, 1 (not at all) to 7 (the same); r presses again"

COMPARE = "which was closer to the real button: 1 the first, 2 the second, 0 neither; r presses again"


class TuneView:
    """Leads a person through a tuning, on standard error; quiet where nobody answers.

    Parameters
    ----------
    person : someone presses and is asked. as_json : tell only what must be known.
    """

    def __init__(self, person: bool, as_json: bool) -> None:
        self._person, self._as_json = person, as_json
        self._question_number, self._press = 0, 0

    @property
    def guide(self) -> Guide:
        from fdvv.rendering.session_run import Guide

        return Guide(self._ask, lambda text: ui.notice(text, self._as_json))

    def _ask(self, ask: PressRequest) -> None:
        if not self._person:
            return
        self._press = self._press + 1 if ask.number == self._question_number else 1
        self._question_number = ask.number
        ui.print_stderr(
            f"question {ask.number} of {ask.total} at most, press {self._press}: {ask.velocity_mm_s:g} mm/s, "
            "down to the stop and let go"
        )
        if sys.stderr.isatty():
            show_cue(
                ask.travel_mm / ask.velocity_mm_s, lambda cue: click.echo(f"\r{cue}", err=True, nl=False)
            )
            click.echo("", err=True)

    def answer(self, question: Question) -> int | Preferred | None:
        """Ask until the answer is one; None to press again."""
        from fdvv.vibration.tune import Preferred

        self._press = 0
        if len(question.templates) == 1:
            answer = _prompt(RATE, [*map(str, range(1, 8)), "r"])
            return None if answer == "r" else int(answer)
        meant = {"1": Preferred.FIRST, "2": Preferred.SECOND, "0": Preferred.NEITHER, "r": None}
        return meant[_prompt(COMPARE, list(meant))]


def _prompt(text: str, choices: list[str]) -> str:
    found: str = click.prompt(text, type=click.Choice(choices), show_choices=False, err=True)
    return found


@click.command()
@click.argument("button")
@click.argument("actuation", required=False, type=ui.FILE)
@session_options
@ui.option(
    "--compare/--rate",
    default=True,
    help="Which of two is closer to the real button, or each by itself, 1 to 7.",
)
@settings_options(TuneSettings, leave_out=("asking",))
@exciter_option
@ui.option(
    "--simulated-observer",
    "simulated",
    is_flag=True,
    help="Answers come from an invented preference: a test, evidence of nothing.",
)
@ui.option("-o", "--output", type=ui.PATH, help="The *.fdvv.json to write.")
@ui.json_option
def tune(
    button: str,
    actuation: Path | None,
    pressing: Pressing,
    settings: TuneSettings,
    compare: bool,
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
    from fdvv.button.open import open_button
    from fdvv.compensation.method import UNTUNED
    from fdvv.model.file import MODEL_SUFFIX, save_model
    from fdvv.rendering.actuation_file import load_actuation
    from fdvv.rendering.tune_candidates import candidates_for, simulated_observer
    from fdvv.rendering.tune_vibration import TuneSetup
    from fdvv.rendering.tune_vibration import tune_vibration as ask

    ui.check_output(output, MODEL_SUFFIX)
    _check_observer(pressing.device, simulated)
    model, known = open_button(button), opened_exciter(exciter)
    learned = load_actuation(actuation) if actuation else None
    grid, settings = settings.grid(), settings.replace(asking="compare" if compare else "rate")
    setup = TuneSetup(
        learned.surface if learned else None,
        known,
        grid,
        "simulated observer" if simulated else "person",
        learned.outcome.tuning if learned else UNTUNED,
    )
    pressing = pressing.on_recommended_rig()
    session, speeds = (
        pressing.session(settings, beside(output, button, "tune-session")),
        settings.velocities_mm_s,
    )
    view = TuneView(not simulated, as_json)
    answer = view.answer
    if simulated:
        candidates = candidates_for(model, sorted(speeds), grid, known)
        answer = simulated_observer(candidates, settings.seed).answer
    with closing(session.open_device(pressing.device)) as found:
        result = ask(found, model, speeds, settings.question(), answer, setup, session, view.guide)
    if output:
        save_model(result.model, output)
    _print({**result.to_dict(), "receipt": result.receipt.to_dict()}, as_json)
    if not as_json:
        ui.print_written(output)


def _check_observer(device: str, simulated: bool) -> None:
    from fdvv.device.open import is_manual

    if simulated and is_manual(device):
        reason = "a person presses it, and nobody's answers would be kept"
        raise InputError("--simulated-observer", device, reason, "leave the option out")
    if not simulated and not is_manual(device):
        reason = "nobody can feel a simulated device"
        raise InputError("--device", device, reason, "use serial:PORT, or add --simulated-observer")


def _print(document: dict[str, Any], as_json: bool) -> None:
    if as_json:
        ui.print_json(document)
        return
    click.echo(
        f"{document['model']} on {document['device']}{ui.simulated(document['simulated'])}, "
        f"answers of a {document['observer']}"
    )
    click.echo(f"{document['method']}, {ui.counted(document['answers'], 'answer')}")
    for found in document["velocities"]:
        click.echo(f"{found['velocity_mm_s']:g} mm/s: {found['explanation']}")
        ui.print_table(["vibration", "Hz", "m/s2", "score", "error", "spectrum", "ST-SIM"], _rows(found))


def _rows(found: dict[str, Any]) -> list[list[Any]]:
    rows = []
    for i, candidate in enumerate(found["candidates"]):
        mode = max(candidate["vibration"]["modes"], key=lambda m: abs(m["amplitude_m_s2"]))
        name = "measured" if i == 0 else f"template {i}"
        mark = " *" if i == found["best"] else " =" if i in found["alike"] else ""
        scores = candidate["objective"]
        figures = (mode["frequency_Hz"], mode["amplitude_m_s2"], candidate["score"], candidate["error"])
        alike = (scores["spectral_similarity"], scores["st_sim"])
        rows.append([name + mark, *figures, *alike])
    return rows

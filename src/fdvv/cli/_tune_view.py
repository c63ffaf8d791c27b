"""A tuning on the terminal: the cue, and questions that give nothing away."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

import click

from fdvv.cli._cue import show_cue
from fdvv.cli._output import one_line

if TYPE_CHECKING:
    from fdvv.vibration import Preferred, Question
    from fdvv.workflow import Ask, Guide

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
        self._asked, self._press = 0, 0

    @property
    def guide(self) -> Guide:
        """Give what the session calls before every press and with notices."""
        from fdvv.workflow import Guide

        return Guide(self._ask, self._notice)

    def _ask(self, ask: Ask) -> None:
        """Ask for a press, which of the question's it is, and show the pace."""
        if not self._person:
            return
        self._press = self._press + 1 if ask.number == self._asked else 1
        self._asked = ask.number
        click.echo(
            f"question {ask.number} of {ask.total} at most, press {self._press}: {ask.velocity_mm_s:g} mm/s, "
            "down to the stop and let go",
            err=True,
        )
        if sys.stderr.isatty():
            show_cue(
                ask.travel_mm / ask.velocity_mm_s, lambda cue: click.echo(f"\r{cue}", err=True, nl=False)
            )
            click.echo("", err=True)

    def _notice(self, text: str) -> None:
        if not self._as_json or text.startswith("warning: "):
            click.echo(one_line(text), err=True)

    def answer(self, question: Question) -> int | Preferred | None:
        """Ask until the answer is one; None to press again."""
        from fdvv.vibration import Preferred

        self._press = 0
        if len(question.templates) == 1:
            told = _prompt(RATE, [*map(str, range(1, 8)), "r"])
            return None if told == "r" else int(told)
        told = _prompt(COMPARE, ["1", "2", "0", "r"])
        meant = {"1": Preferred.FIRST, "2": Preferred.SECOND, "0": Preferred.NEITHER}
        return meant.get(told)


def _prompt(text: str, choices: list[str]) -> str:
    found: str = click.prompt(text, type=click.Choice(choices), show_choices=False, err=True)
    return found

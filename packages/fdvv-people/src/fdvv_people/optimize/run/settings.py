"""Settings of a run, the same in every door."""

from __future__ import annotations

from typing import Annotated

from msgspec import Meta

from fdvv.settings import Settings, about

Budget = Annotated[int, Meta(ge=1, le=100_000)]
"""Of trials that may be asked; `fdvv serve` plays for other programs, which try many."""
Presses = Annotated[int, Meta(ge=2, le=1000)]
"""Of a trial: one says nothing of how much its scores scatter."""
Retest = Annotated[int, Meta(ge=0, le=1000)]
"""Of blocks of trials at the end."""


class RunSettings(Settings):
    """How long a run lasts."""

    budget: Annotated[
        Budget, about("How many designs are tried, or comparisons made.", option="--trials")
    ] = 30
    presses: Annotated[Presses, about("Of a trial.", label="Score after")] = 20
    retest: Annotated[
        Retest | None,
        about(
            "Blocks of trials at the end: each has the start, the result and what --switch adds once. 16, or "
            "40 of start and result alone."
        ),
    ] = None

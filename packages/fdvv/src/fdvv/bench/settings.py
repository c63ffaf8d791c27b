"""Settings of a guided capture."""

from __future__ import annotations

from typing import Annotated

from msgspec import Meta

from fdvv.settings import Settings, about

PaceRatio = Annotated[float, Meta(ge=0.05, le=1)]
Pace = Annotated[float, Meta(ge=20, le=500)]
"""Mean speed of the stroke down, mm/s: slower ones are the probe's, faster ones no person keeps to."""


class CaptureSettings(Settings):
    """The procedure of a capture."""

    paces_mm_s: Annotated[
        tuple[Pace, ...],
        about(
            "Mean speeds of the stroke down.",
            min_length=1,
            max_length=12,
            option="--paces",
            label="Speeds",
            joined=True,
        ),
    ] = (50.0, 100.0, 150.0, 200.0)
    presses: Annotated[int, about("Per pace.", ge=1, le=200)] = 15
    probe: Annotated[bool, about("Lead the cap slowly down and back first.", option="--probe/--no-probe")] = (
        True
    )
    shuffled: Annotated[
        bool, about("Ask for the paces mixed instead of one after the other.", option="--shuffle")
    ] = False
    repeats: Annotated[
        int, about("How often a bad press is asked for again.", label="Retries of a bad press", ge=0, le=20)
    ] = 3
    pace_ratio: Annotated[
        PaceRatio,
        about("By which a press may miss its pace.", option="--pace-tolerance", label="Speed tolerance"),
    ] = 0.35
    travel_mm: Annotated[
        Annotated[float, Meta(ge=0.5, le=10)] | None,
        about("Of the button, mm; by default from the probe.", option="--travel"),
    ] = None
    seed: Annotated[
        int,
        about("Repeats the twin; order of --shuffle.", label="Seed of the simulation", ge=0, le=2**31),
    ] = 0

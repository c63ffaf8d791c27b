"""Logs of several instruments as one recording of a button."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import fields, replace
from pathlib import Path

from fdvv.errors import InputError, ModelError
from fdvv.recording.join import join, select
from fdvv.recording.read import read_log
from fdvv.recording.types import Bench, Recording


def join_logs(
    paths: Sequence[Path],
    name: str,
    markers: Sequence[str] = (),
    light: str = "",
    bench: Bench | None = None,
    licence: str = "",
    person: str = "",
    rate_Hz: float | None = None,
) -> Recording:
    """Read logs that were taken at once, motion capture beside force, and put them into one recording.

    markers, light : names of the markers on the cap and of the one that is the light, as for select.
    bench : what is known of the instruments; a number other than 0 holds against what a log says itself.
    rate_Hz : of a log of bare numbers, which has no times and whose name does not state it.

    Raises InputError on a log that cannot be used or does not belong to the others.
    """
    read = [read_log(path, name, rate_Hz) for path in paths]
    try:
        joined = select(join(read, name), markers, light)
    except ModelError as error:
        place, remedy = "logs together", "name logs of the same presses, one of each instrument"
        raise InputError(", ".join(path.name for path in paths), place, str(error), remedy) from error
    known = {f.name: getattr(bench, f.name) for f in fields(Bench) if bench and getattr(bench, f.name)}
    return replace(
        joined,
        bench=replace(joined.bench, **known),
        licence=licence or joined.licence,
        person=person or joined.person,
    )

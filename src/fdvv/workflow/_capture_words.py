"""What is said of a recorded model: its source, how it was made, what it takes for granted, what to mind."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

from fdvv.model import Stroke
from fdvv.preprocess import Judged, Processed, Settings
from fdvv.recording import Recording
from fdvv.workflow._fit import one_line

OFF_PACE_ratio = 0.15
"""A pace that was missed by more than this on the median is told."""

FEW_TAKES = 6
"""Takes that are named one by one; more are counted."""


def source_of(recording: Recording) -> str:
    """Say what was recorded and where it was read from."""
    files = ", ".join(f"{source.name} ({source.format})" for source in recording.sources)
    parts = [f"{len(recording.takes)} takes of {recording.name}", recording.person, files]
    return one_line("; ".join(part for part in parts if part))


def method_of(recording: Recording, processed: Processed) -> str:
    """Say the steps between the streams and the averaged curves, in their order."""
    clock, bench = processed.clock, recording.bench
    steps = []
    if clock.edges:
        refused = f", {clock.refused} refused" if clock.refused else ""
        doubt = f"doubt {1e6 * clock.doubt_s:.2g} µs"
        steps.append(f"clocks joined on {clock.edges} edges of a light ({doubt}{refused})")
    if bench.force_filter_ms:
        steps.append(f"the force filter of {bench.force_filter_ms:g} ms undone")
    if bench.force_play_cN:
        steps.append(f"the force sensor's play of {bench.force_play_cN:g} cN undone")
    steps.append("paths between frames found from frames and force together")
    steps.append(used_and_left_out(processed))
    if processed.probe:
        probes = "a slow probe" if processed.probe.probes == 1 else f"{processed.probe.probes} slow probes"
        steps.append(f"zero and slowest curves from {probes}")
    return "; ".join(steps)


def used_and_left_out(processed: Processed) -> str:
    """Count the presses that were averaged and those that were not, with the reasons."""
    left = [one for one in processed.judged if one.reason is not None]
    used = len(processed.judged) - len(left)
    told = f"{used} of {len(processed.judged)} presses averaged at their own samples on 50 µm"
    counts = Counter(str(one.reason) for one in left)
    reasons = [f"{reason} ({_takes(left, reason)})" for reason, _ in counts.most_common()]
    return f"{told}, left out: {', '.join(reasons)}" if reasons else told


def _takes(left: Sequence[Judged], reason: str) -> str:
    """Name takes by their numbers, each once."""
    numbers = list(dict.fromkeys(str(one.press.take) for one in left if one.reason == reason))
    more = len(numbers) - FEW_TAKES
    told = ", ".join(numbers[:FEW_TAKES]) + (f" and {more} more" if more > 0 else "")
    return f"take {told}" if len(numbers) == 1 else f"takes {told}"


def assumptions_of(recording: Recording, settings: Settings) -> tuple[str, ...]:
    """Say what no measurement of this recording backs."""
    bench = recording.bench
    told = [f"the cap, with stem, markers and a third of its spring, moves {settings.cap_g:g} g"]
    facts = [
        (bench.tip_mass_g, f"the force sensor's tip weighs {bench.tip_mass_g:g} g"),
        (bench.force_filter_ms, f"the filter before its converter has {bench.force_filter_ms:g} ms"),
        (bench.force_play_cN, f"it reads {bench.force_play_cN:g} cN more on the way back"),
        (bench.exposure_ms, f"the camera exposes for {bench.exposure_ms:g} ms"),
    ]
    told += [f"{sentence}, as the bench states" for value, sentence in facts if value]
    told.append("spreads are between presses of one recording; what all of them share is not in them")
    return tuple(told)


def pace_warnings(processed: Processed) -> list[str]:
    """Warn of paces that the presses missed."""
    return [
        f"presses asked at {curve.velocity_mm_s:g} mm/s were made at {curve.achieved_mm_s:.0f} mm/s"
        for curve in processed.curves
        if curve.stroke is Stroke.PRESS
        and curve.velocity_mm_s is not None
        and abs(curve.achieved_mm_s / curve.velocity_mm_s - 1) > OFF_PACE_ratio
    ]

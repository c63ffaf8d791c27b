"""The reference names every call, field and event, and nothing else."""

from __future__ import annotations

import re
from typing import get_args

import msgspec
import pytest

from fdvv_campaigns.serve import answers as a
from fdvv_campaigns.serve import messages as m
from fdvv_campaigns.serve.runs import ANSWERS
from tests.support.checkout import REPOSITORY

PAGE = (REPOSITORY / "docs" / "reference" / "serve-messages.md").read_text(encoding="utf-8")
RUN, DEVICE = "a run", "a device"
RESULTS: dict[str, tuple[type[msgspec.Struct], str]] = {
    "hello": (a.Welcome, ""),
    "clock": (a.HostClock, ""),
    "optimize.ask": (a.Suggestion, ""),
    "optimize.best": (a.Best, ""),
    "optimize.compare": (a.Pair, ""),
    "device.info": (a.DeviceInformation, DEVICE),
    **{f"optimize.{name}": (a.RunStatus, RUN) for name in ("begin", "resume", "tell", "prefer")},
}
"""What a call answers, and the words that stand for a part of it; the others answer a device."""


def _rows(heading: str) -> dict[str, list[str]]:
    part = PAGE.split(f"## {heading}\n")[1].split("\n## ")[0]
    cells = [[cell.strip() for cell in re.split(r"\s*\|\s*", line)[1:-1]] for line in part.splitlines()]
    return {row[0].strip("`"): row[1:] for row in cells if row and re.fullmatch(r"`[\w.]+`", row[0])}


def _names(cell: str) -> set[str]:
    return set(re.findall(r"`(\w+)`", cell))


def _tag(kind: type[msgspec.Struct]) -> str:
    return str(kind.__struct_config__.tag)


CALLS = {name: row for name, row in _rows("Calls").items() if len(row) == 2}


@pytest.mark.parametrize("kind", m.REQUESTS, ids=_tag)
def test_a_call_is_described_with_its_fields_and_result(kind: type[m.Request]) -> None:
    asked, answered = CALLS[_tag(kind)]
    values = {"done", "failed", "abandoned", "first", "second", "equal"}
    assert _names(asked) - values == {*kind.__struct_fields__} - {"id"}
    required = {f.name for f in msgspec.structs.fields(kind) if f.required} - {"id"}
    assert required <= _names(re.sub(r"\[.*?\]", "", asked))
    found, words = RESULTS.get(_tag(kind), (a.DeviceIs, DEVICE))
    common = {RUN: a.RunStatus, DEVICE: a.DeviceIs}.get(words)
    left = {*found.__struct_fields__} - ({*common.__struct_fields__} if common else set())
    assert left <= _names(answered)
    assert _names(answered) <= left
    assert words in answered or _tag(kind) == "device.close"


def test_no_call_is_described_that_is_none() -> None:
    assert {*CALLS} == {_tag(kind) for kind in m.REQUESTS}
    assert {*ANSWERS} == {*m.RUN_REQUESTS} - {m.BeginRun}


def test_runs_and_devices_are_described() -> None:
    text = PAGE.split("A **run** has")[1].split("\n\n")[0]
    run, device = text.split("A **device** has")
    assert _names(run) == {*a.RunStatus.__struct_fields__}
    assert _names(device) == {*a.DeviceIs.__struct_fields__}
    retest = next(line for line in PAGE.splitlines() if line.startswith("| `retest`"))
    assert {*a.RetestFound.__struct_fields__} <= _names(retest)


@pytest.mark.parametrize("kind", a.EVENTS, ids=_tag)
def test_an_event_is_described_with_its_fields(kind: type[msgspec.Struct]) -> None:
    (fields,) = _rows("Events")[_tag(kind)]
    if kind is a.StatusEvent:
        assert fields.startswith(DEVICE)
        return
    kinds = set(get_args(a.PressKind)) if kind is a.PressEvent else set()
    assert {*kind.__struct_fields__} <= _names(fields)
    assert _names(fields) <= {*kind.__struct_fields__} | kinds


def test_no_event_is_described_that_is_none() -> None:
    assert {*_rows("Events")} == {_tag(kind) for kind in a.EVENTS}

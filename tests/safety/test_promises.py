"""What the supervisor promises holds in every scene; test_supervisor.py has the C code play them."""

from __future__ import annotations

from functools import cache
from itertools import pairwise

import pytest

from fdvv.firmware.core import CoreRequest
from fdvv.protocol.tables import Fault, Mode, Refusal
from tests.safety import _scenes
from tests.safety._oracle import RULE_OF, VIBRATION, Inputs
from tests.safety._script import CALLS, STEP, Script

RENDERING = (Mode.ARMED, Mode.DERATED)
CALL, ARGUMENTS, GIVES, MODE, FAULT = (
    (STEP.names or ()).index(name) for name in ("call", "arguments", "gives", "mode", "fault")
)


@cache
def directed() -> Script:
    """Return all scenes in one script."""
    script = Script()
    for scene in _scenes.DIRECTED:
        scene(script)
    return script


def test_force_is_allowed_only_while_armed_or_derated() -> None:
    limits = [step for step in directed().steps if step[CALL] == CALLS["limit"]]
    assert {step[GIVES] > 0 for step in limits if step[MODE] in RENDERING} == {True, False}
    assert not any(step[GIVES] for step in limits if step[MODE] not in RENDERING)


def test_no_question_leads_from_fault_to_force() -> None:
    steps = directed().steps
    after = {
        (CoreRequest(step[ARGUMENTS][0]), Mode(step[MODE]))
        for before, step in pairwise(steps)
        if step[CALL] == CALLS["ask"] and before[MODE] == Mode.FAULT and step[ARGUMENTS][0] < len(CoreRequest)
    }
    assert {ask for ask, _ in after} == set(CoreRequest)
    assert {mode for _, mode in after} == {Mode.FAULT, Mode.IDLE}
    assert {ask for ask, mode in after if mode is Mode.IDLE} == {CoreRequest.CLEAR}


def test_disarming_is_never_refused() -> None:
    refusals = {
        (Mode(before[MODE]), Refusal(step[GIVES]))
        for before, step in pairwise(directed().steps)
        if step[CALL] == CALLS["ask"]
        and step[ARGUMENTS][0] == CoreRequest.DISARM
        and before[MODE] <= Mode.FAULT
    }
    assert refusals == {(mode, Refusal.NONE) for mode in Mode}


@pytest.mark.parametrize(
    "disturbance", list(_scenes.disturbances()), ids=lambda disturbance: str(disturbance[0].name)
)
@pytest.mark.parametrize("mode", [Mode.ARMED, Mode.DERATED])
def test_a_fault_takes_the_force_away_in_its_own_tick(mode: Mode, disturbance: tuple[Fault, Inputs]) -> None:
    fault, inputs = disturbance
    script = Script()
    _scenes.into(script, mode, _scenes.SENSED)
    assert script.limit(_scenes.SENSED) > 0
    script.check(_scenes.SENSED, inputs)
    assert script.oracle.fault is fault
    stops = RULE_OF[fault].stops
    assert (script.limit(_scenes.SENSED) == 0) is stops
    assert script.oracle.evidence.mode == mode
    assert script.play() == ""


def test_a_fault_is_never_without_its_reason() -> None:
    seen = {(step[MODE], step[FAULT]) for step in directed().steps if step[MODE] <= Mode.FAULT}
    assert (Mode.FAULT, Fault.NONE) not in seen
    assert {fault for mode, fault in seen if mode == Mode.FAULT} == {
        fault for fault, rule in RULE_OF.items() if rule.stops
    }


def test_the_vibration_board_warns_without_stopping_and_gives_way_to_a_fault() -> None:
    script = Script()
    _scenes.into(script, Mode.ARMED)
    quiet = Inputs(sum=1, board=VIBRATION)
    assert script.tick(_scenes.SENSED, quiet) > 0
    assert (script.oracle.mode, script.oracle.fault) == (Mode.ARMED, Fault.VIBRATION_BOARD)
    script.tick(_scenes.SENSED, Inputs(sum=2, board=VIBRATION, supply_mV=0))
    assert (script.oracle.mode, script.oracle.fault) == (Mode.FAULT, Fault.SUPPLY_LOW)
    assert script.play() == ""

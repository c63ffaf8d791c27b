"""The device: one owner, events of presses, and zero force when the owner goes, however it goes."""

from __future__ import annotations

import json
import signal
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from fdvv.device.open import person_of
from fdvv.device.plant import Inputs, Plant
from fdvv.device.serve import RigServer
from fdvv.model.file import load_builtin, model_to_json
from fdvv.program.file import program_to_json
from fdvv.program.library import load_shipped
from fdvv.protocol.tables import Mode
from fdvv_campaigns.serve.rig import Touch
from fdvv_studio.live.tick_bins import TickPiece
from tests.serve.running import Client, RefusedCall, RunningServer


@pytest.fixture
def twin(client: Client) -> Client:
    """A client that owns the twin, with a button on it."""
    client.call("device.open", device="twin")
    client.call("device.upload", button="mx-clear")
    return client


def test_a_press_is_four_events_and_their_times_are_those_of_the_button(twin: Client) -> None:
    twin.call("device.watch", rate_Hz=1000)
    twin.call("device.press", velocity_mm_s=100.0)
    twin.call("clock")
    assert twin.kinds() == ["down", "actuation", "reset", "up"]
    events = {e["kind"]: e for e in twin.events if e["event"] == "device.press"}
    assert all(e["simulated"] and 0 <= e["came_s"] - e["host_s"] < 5 for e in events.values())
    (frame,) = (e for e in twin.events if e["event"] == "device.telemetry")
    t_s = frame["bin_s"] * np.array(frame["bin"])
    at = int(np.searchsorted(t_s, events["actuation"]["device_s"]))
    assert frame["displacement_low_mm"][at] == pytest.approx(load_builtin("mx-clear").actuation_mm, abs=0.2)
    assert events["down"]["displacement_mm"] == pytest.approx(0.15, abs=0.02)


def test_telemetry_comes_at_the_rate_asked_for_with_every_peak(twin: Client) -> None:
    most: list[float] = []
    for rate_Hz in (20, 500):
        twin.call("device.close")
        twin.call("device.open", device="twin")
        twin.call("device.upload", button="mx-clear")
        twin.events.clear()
        twin.call("device.watch", rate_Hz=rate_Hz)
        twin.call("device.press")
        twin.call("clock")
        (frame,) = (e for e in twin.events if e["event"] == "device.telemetry")
        assert frame["bin_s"] == 1 / rate_Hz
        assert np.all(np.diff(frame["bin"]) >= 1)
        most.append(max(frame["displacement_high_mm"]))
    assert most[0] == most[1]
    twin.call("device.watch", rate_Hz=0)
    twin.events.clear()
    twin.call("device.press")
    twin.call("clock")
    assert {e["event"] for e in twin.events} == {"device.press"}


@pytest.mark.parametrize(
    "what",
    [
        {"button": "mx-blue"},
        {"button": json.loads(model_to_json(load_builtin("mx-red")))},
        {"program": "rapid-trigger"},
        {"program": json.loads(program_to_json(load_shipped("rapid-trigger")))},
    ],
)
def test_buttons_and_programs_are_uploaded_by_name_or_whole(client: Client, what: dict[str, Any]) -> None:
    client.call("device.open", device="host")
    assert client.call("device.upload", **what)["programmed"]
    assert client.call("device.info")["force_limit_cN"] > 0
    client.call("device.press")
    client.call("clock")
    assert client.kinds()[-4:] == ["down", "actuation", "reset", "up"] or "program" in what
    assert client.call("device.close")["device"] == ""


@pytest.mark.parametrize(
    ("call", "fields", "word"),
    [
        ("device.upload", {}, "either a button or a program"),
        ("device.upload", {"button": "mx-clear", "program": "rapid-trigger"}, "either a button or a program"),
        ("device.upload", {"program": "../x"}, "x"),
        ("device.upload", {"button": "mx-clear", "actuation": "../x"}, "there is none of this name"),
        ("device.upload", {"button": "/etc/passwd"}, "passwd"),
        ("device.open", {"device": "twin"}, "you own one already"),
        ("device.press", {"velocity_mm_s": 1e6}, "mm/s"),
        ("device.arm", {}, "no firmware"),
        ("device.watch", {"rate_Hz": -1}, ">= 0"),
    ],
)
def test_what_the_device_cannot_do_is_refused_in_one_line(
    twin: Client, call: str, fields: dict[str, Any], word: str
) -> None:
    with pytest.raises(RefusedCall, match=word) as refused:
        twin.call(call, **fields)
    assert "\n" not in str(refused.value)
    assert twin.call("device.press")["fault"] == ""


@pytest.mark.parametrize(
    "device", ["replay:/etc/passwd", "rig:/tmp/x.py:Rig", "serial:/etc/passwd", "emulated:x", ""]
)
def test_a_client_names_no_file_as_a_device(client: Client, device: str) -> None:
    with pytest.raises(RefusedCall, match="there is no"):
        client.call("device.open", device=device)


def test_one_client_owns_the_device_and_others_are_refused_until_it_goes(server: RunningServer) -> None:
    first, second = Client(server), Client(server)
    first.call("device.open", device="twin")
    for call, fields in (("device.open", {"device": "twin"}), ("device.press", {}), ("device.stop", {})):
        with pytest.raises(RefusedCall, match="another client owns the device"):
            second.call(call, **fields)
    first.vanish()
    _until(lambda: _accepts(second, "device.open", device="twin"))
    second.close()


def test_a_page_that_is_loaded_again_has_its_device_at_once(server: RunningServer) -> None:
    for _ in range(5):
        client = Client(server)
        client.call("device.open", device="host")
        client.close()


def _accepts(client: Client, call: str, **fields: str) -> bool:
    try:
        client.call(call, **fields)
    except RefusedCall:
        return False
    return True


def _until(done: Callable[[], bool], within_s: float = 10.0) -> float:
    began_s = time.monotonic()
    while not done():
        assert time.monotonic() < began_s + within_s
        time.sleep(0.01)
    return time.monotonic() - began_s


@pytest.fixture
def rig() -> Iterator[RigServer]:
    """A board in real time behind a terminal, as a real one; nobody presses it."""
    found = RigServer(person_of("twin"), presses=0)
    found.start()
    yield found
    if not found.over.is_set():
        found.end()


@pytest.mark.parametrize("how", ["vanishes", "closes", "server is killed"])
def test_an_armed_device_falls_to_zero_force_when_its_client_or_server_goes(
    rig: RigServer, tmp_path: Path, how: str
) -> None:
    pytest.importorskip("serialx")
    server = RunningServer(tmp_path / "project", more=("--device", f"serial:{rig.path}"))
    client = Client(server)
    client.call("device.open", device=f"serial:{rig.path}")
    client.call("device.upload", button="mx-clear")
    assert client.call("device.arm")["mode"] == "armed"
    _until(lambda: bool(rig.port.outputs.enable))
    time.sleep(0.3)  # it stays armed while its client is there
    assert rig.port.outputs.mode == Mode.ARMED
    if how == "vanishes":
        client.vanish()
    elif how == "closes":
        client.close()
    else:
        server.process.kill()
    # a killed server says nothing: the board's own watch of its host ends the force
    _until(lambda: not rig.port.outputs.enable and rig.port.outputs.duty_q15 == 0, 5.0)
    assert rig.port.outputs.mode in ((Mode.IDLE,) if how != "server is killed" else (Mode.IDLE, Mode.FAULT))
    server.stop(signal.SIGKILL)


class Dark:
    """A rig whose supply has failed, as long as it says so."""

    def __init__(self, plant: Plant) -> None:
        self._plant, self.fails = plant, True

    def step(self, *outputs: int) -> Inputs:
        found = self._plant.step(*outputs)
        return found._replace(supply_mV=0) if self.fails else found


def test_a_fault_and_a_rig_that_goes_are_events_and_what_follows_is_refused(
    rig: RigServer, tmp_path: Path
) -> None:
    pytest.importorskip("serialx")
    device = f"serial:{rig.path}"
    server = RunningServer(tmp_path / "project", more=("--device", device))
    client = Client(server)
    client.call("device.open", device=device)
    client.call("device.upload", button="mx-clear")
    client.call("device.arm")
    dark = Dark(rig.person.rest(rig.settings))
    rig.port.connect(dark)
    fault = _event(client, "device.fault")
    assert (fault["gone"], "supply" in fault["fault"]) == (False, True)
    with pytest.raises(RefusedCall, match=r"latched|fault"):
        client.call("device.arm")
    dark.fails = False
    _until(lambda: _accepts(client, "device.clear_fault"))
    assert client.call("device.info")["fault"] == ""
    rig.end()
    assert _event(client, "device.fault")["gone"]
    with pytest.raises(RefusedCall, match="no device is connected"):
        client.call("device.arm")
    client.call("device.close")
    client.close()
    assert "Traceback" not in server.stop()


def _event(client: Client, name: str) -> dict[str, Any]:
    while (message := client.receive()).get("event") != name:
        pass
    return message


def test_stop_does_not_wait_for_the_calls_before_it(client: Client, run: str) -> None:
    client.call("device.open", device="host")
    client.call("device.upload", button="mx-clear")
    client.call("device.arm")
    begun = [
        client.send("optimize.begin", run=f"{run[:50]}-{n}", button="mx-clear", engine="sobol", budget=3)
        for n in range(60)
    ]
    stop = client.send("device.stop")
    order: list[int] = []
    while len(order) < 61:
        message = client.receive()
        if message.get("id") in (*begun, stop):
            order.append(message["id"])
    assert order[-1] != stop


def _piece(x_mm: list[float], rendered: bool = True) -> TickPiece:
    n, x = len(x_mm), np.array(x_mm, dtype=np.float64)
    none = np.zeros(n)
    return TickPiece(
        np.arange(n, dtype=np.float64), x, none, none, np.zeros(n, np.int64), none > 0, np.full(n, rendered)
    )


@pytest.mark.parametrize(
    ("x_mm", "kinds"),
    [
        ([0.0, 0.2, 1.0, 0.12, 0.05], ["down", "up"]),
        ([0.0, 0.12, 0.05, 0.14], []),  # noise between the two bounds is no press
        ([4.0, 1.0, 0.0, 0.2, 0.0], ["down", "up"]),  # it had sunk, and came up when it was armed
        ([0.0, 0.2, 0.12, 0.2], ["down"]),
    ],
)
def test_a_press_begins_where_the_cap_leaves_its_rest(x_mm: list[float], kinds: list[str]) -> None:
    touch = Touch()
    whole = touch.changes(_piece(x_mm))
    touch = Touch()
    parts = [one for x in x_mm for one in touch.changes(_piece([x]))]
    assert [kind for kind, _, _ in whole] == [kind for kind, _, _ in parts] == kinds
    assert touch.changes(_piece([0.0, 1.0, 0.0], rendered=False)) == []

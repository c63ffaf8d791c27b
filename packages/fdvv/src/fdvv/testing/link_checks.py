"""What a board behind the link must honour, checked one by one; each failure says what to mend."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from fdvv.device.client import Client
from fdvv.device.remote import Remote, surface_image
from fdvv.device.telemetry import TickColumns
from fdvv.device.wire import RefusedError
from fdvv.errors import DeviceError
from fdvv.protocol.frame import Frame, FrameDecoder, encode
from fdvv.protocol.messages import REPLY, CN64_PER_cN, request_frame
from fdvv.protocol.tables import Fault, Message, Mode, PingRequest, Settings
from fdvv.testing.conformance import plain_surface

FORCE_cN, TRAVEL_mm, SPEED_mm_s = 40.0, 4.0, 100.0
LEAST_ratio = 0.4
"""Of the force limit, the most that the table begins with: it rises by 20 cN."""
PINGS = 100
STRANGER = 0x7D
"""No message has this number."""
CLOCK_ratio = 0.02
CLOCK_s, ANSWER_s = 0.5, 0.1
TABLE_cN = 8.0
"""Press and release of the table are 5 cN apart."""
TOP_mm, RISE_s, WATCH_s = 0.5, 0.5, 0.3
"""Where the cap is once it has come up, how long that may take, and how long telemetry is watched."""
GRACE_ticks = 4
SILENCE_s = 0.15
"""Beyond the host's timeout."""
REVERSED_mm, DEEP_RATIO, LEAST_cN = 1.0, 0.9, 8.0
"""Assumed, far from both cases: reversed, 4 mm read as -4; a sound press reaches the stop (conformance wants
0.98 of the travel); half pressed, the table asks for 50 cN."""


class Check(NamedTuple):
    """A rule. run : returns what is wrong, empty if nothing is; DeviceError if it could not go on."""

    name: str
    mend: str
    run: Callable[[Remote], str]


@dataclass(frozen=True)
class CheckResult:
    """What a check found.

    Attributes
    ----------
    name : of the rule. found : what is wrong, empty if it is kept. mend : where to look.
    """

    name: str
    found: str
    mend: str

    @property
    def passed(self) -> bool:
        return not self.found


def check_link(device: Remote, pressed: bool = True) -> Iterator[CheckResult]:
    """Check a device rule by rule; settings are put back, and it is left without force.

    pressed : somebody will press; without, the last rules are left out.
    Wherever a rule fails the others are still checked, unless the device does not answer at all.
    """
    before = device.settings()
    try:
        for check in CHECKS if pressed else tuple(one for one in CHECKS if one not in OF_A_PRESS):
            yield _result(check, device)
            _calm(device)
    finally:
        with suppress(DeviceError):
            device.configure(before)


def _result(check: Check, device: Remote) -> CheckResult:
    try:
        found = check.run(device)
    except DeviceError as error:
        found = str(error)
    return CheckResult(check.name, found, check.mend if found else "")


def _calm(device: Remote) -> None:
    """Leave no force, stream or fault to the next rule."""
    with suppress(DeviceError):
        device.stop()
    with suppress(DeviceError):
        if device.fault().fault is not Fault.NONE:
            device.clear_fault()


def _refused(what: str, ask: Callable[[], object]) -> str:
    """Return what is wrong if a request is carried out that must be refused."""
    try:
        ask()
    except RefusedError:
        return ""
    return f"it accepted {what}"


def _raw(client: Client, data: bytes) -> list[Frame]:
    """Put bytes on the line as they are and return the replies."""
    port, decoder, found = client.port, FrameDecoder(), []
    port.write(b"\0" + data)
    until_s = port.now_s() + ANSWER_s
    while piece := port.read(until_s):
        found += [frame for frame in decoder.feed(piece) if _is_reply(frame)]
    return found


def _is_reply(frame: Frame) -> bool:
    return REPLY <= frame.message < Message.RECORDS or frame.message == REPLY + Message.REFUSED


def _answers(device: Remote) -> str:
    for _ in range(PINGS):
        device.client.ping()
    repeated = device.client.repeated
    return f"{repeated} of {PINGS} requests had to be sent again" if repeated else ""


def _sequence(device: Remote) -> str:
    ping = request_frame(Message.PING, 201, PingRequest(host_us=7))
    replies = _raw(device.client, encode(ping))
    if len(replies) != 1:
        return f"a request was answered {len(replies)} times"
    if replies[0].sequence != ping.sequence:
        return f"the reply to request 201 has the number {replies[0].sequence}"
    return ""


def _damaged(device: Remote) -> str:
    good = bytearray(encode(request_frame(Message.PING, 202, PingRequest(host_us=7))))
    good[-2] ^= 0x40  # of the checksum
    return "it answered a frame whose checksum is wrong" if _raw(device.client, bytes(good)) else ""


def _unknown(device: Remote) -> str:
    replies = _raw(device.client, encode(Frame(STRANGER, 203)))
    if [frame.message for frame in replies] != [REPLY + Message.REFUSED]:
        return f"a message that does not exist was answered by {[hex(one.message) for one in replies]}"
    return ""


def _clock(device: Remote) -> str:
    client = device.client
    start_s, start_us = client.port.now_s(), client.ping().device_us
    client.listen(start_s + CLOCK_s)
    host_s, end_us = client.port.now_s() - start_s, client.ping().device_us
    device_s = (end_us - start_us) % 2**32 * 1e-6
    # a simulated board falls behind on a busy machine, and never runs ahead
    low = 0.0 if device.info().simulated else 1 - CLOCK_ratio
    if low * host_s <= device_s <= (1 + CLOCK_ratio) * host_s + ANSWER_s * CLOCK_ratio and device_s > 0:
        return ""
    return f"its clock counted {1e3 * device_s:.1f} ms in {1e3 * host_s:.1f} ms"


def _stored(device: Remote) -> str:
    asked = replace(device.settings(), lead_us=1234)
    device.configure(asked)
    held = device.client.read_settings()
    other = [name for name in Settings.LIMITS if getattr(held, name) != getattr(asked, name)]
    return f"read back, {', '.join(other)} differ from what was written" if other else ""


def _at_odds(device: Remote) -> str:
    wrong = replace(device.settings(), window_start_um16=9000, window_end_um16=8000)
    return _refused("a velocity window that ends before it starts", lambda: device.configure(wrong))


def _looser(device: Remote) -> str:
    limits = device.client.read_limits()
    if limits.full_duty_rise_K <= 1:
        return ""
    wrong = replace(device.settings(), full_duty_rise_K=limits.full_duty_rise_K - 1)
    return _refused("a cooler coil than it was built for", lambda: device.configure(wrong))


def _force_cN(device: Remote) -> float:
    """Return the force of the table that is pressed, less on a weak rig."""
    return min(FORCE_cN, LEAST_ratio * device.info().force_limit_cN)


def _travel_mm(device: Remote) -> float:
    return min(TRAVEL_mm, device.info().travel_limit_mm)


def _image(device: Remote, force_cN: float | None = None) -> bytes:
    travel_mm = _travel_mm(device)
    table = plain_surface(_force_cN(device) if force_cN is None else force_cN, travel_mm)
    return surface_image(table, travel_mm)


def _damaged_image(device: Remote) -> str:
    image = bytearray(_image(device))
    image[-1] ^= 1
    return _refused("a damaged program", lambda: device.upload_program(bytes(image)))


def _too_strong(device: Remote) -> str:
    beyond_cN = device.info().force_limit_cN + 5
    if beyond_cN + 30 > device.settings().LIMITS["force_limit_cN64"][1] / CN64_PER_cN:
        return ""  # no table of this format is beyond it
    return _refused(
        "a table beyond its force limit", lambda: device.upload_program(_image(device, beyond_cN))
    )


def _watched(device: Remote, duration_s: float) -> TickColumns:
    client = device.client
    client.telemetry.clear()
    client.stream(1)
    client.listen(client.port.now_s() + duration_s)
    client.stream(0)
    return client.telemetry.columns()


def _idle(device: Remote) -> str:
    columns = _watched(device, WATCH_s)
    if not columns.tick.size:
        return "no telemetry came"
    most_cN = float(np.abs(columns.commanded_cN).max())
    return f"it commands {most_cN:.1f} cN while nothing is armed" if most_cN else ""


def _ticks(device: Remote) -> str:
    client, tick_us = device.client, device.settings().tick_us
    start_us = client.ping().device_us
    columns = _watched(device, WATCH_s)
    span_us = (client.ping().device_us - start_us) % 2**32
    found = client.telemetry
    if columns.tick.size < 2:
        return "no telemetry came"
    for count, words in (
        (found.missing_frames, "frames of telemetry were lost"),
        (found.missing_ticks, "ticks are missing between records"),
        (found.late_ticks, "ticks came late"),
    ):
        if count:
            return f"{count} {words}"
    expected = span_us / tick_us
    if abs(columns.tick.size - expected) > 0.2 * expected:
        return (
            f"{columns.tick.size} ticks came in {span_us / 1e3:.0f} ms, {expected:.0f} at {tick_us} us each"
        )
    return ""


def _armed(device: Remote, duration_s: float) -> TickColumns:
    device.upload(plain_surface(_force_cN(device), _travel_mm(device)), _travel_mm(device))
    device.client.announce(SPEED_mm_s)
    device.client.arm()
    device.client.listen(device.client.port.now_s() + RISE_s)
    return _watched(device, duration_s)


def _renders(device: Remote) -> str:
    columns = _armed(device, WATCH_s)
    if not columns.tick.size:
        return "no telemetry came"
    expected = _force_cN(device) + 5 * np.clip(columns.displacement_mm, 0.0, _travel_mm(device))
    off_cN = float(np.median(np.abs(columns.commanded_cN - expected)))
    return f"it commands {off_cN:.1f} cN other than the table asks" if off_cN > TABLE_cN else ""


def _rests(device: Remote) -> str:
    rest_mm = _armed(device, WATCH_s).displacement_mm
    top_mm = float(np.percentile(rest_mm, 10)) if rest_mm.size else 0.0
    if abs(top_mm) > TOP_mm:
        return f"armed, the cap rests at {top_mm:.2f} mm, not at 0"
    return (
        "the position never changes, not by its noise either" if rest_mm.size and not np.ptp(rest_mm) else ""
    )


def _lets_go(device: Remote) -> str:
    _armed(device, 0.0)
    device.client.disarm()
    late = _watched(device, WATCH_s).commanded_cN[GRACE_ticks:]
    most_cN = float(np.abs(late).max()) if late.size else 0.0
    return f"disarmed, it still commands {most_cN:.1f} cN" if most_cN else ""


def _silence(device: Remote) -> str:
    _armed(device, 0.0)
    port, wait_s = device.client.port, device.settings().host_timeout_ms * 1e-3 + SILENCE_s
    until_s = port.now_s() + wait_s
    while port.now_s() < until_s:
        port.read(until_s)
    mode = Mode(device.client.ping().mode)
    if mode in (Mode.FAULT, Mode.IDLE):
        return ""
    return f"{wait_s:.2f} s without a word from its host, and it is still {mode.name.lower()}"


def _goes_down(device: Remote) -> str:
    device.upload(plain_surface(_force_cN(device), _travel_mm(device)), _travel_mm(device))
    try:
        press = device.press(SPEED_mm_s)
    except DeviceError as error:
        deepest = device.client.telemetry.columns().displacement_mm
        if deepest.size and deepest.min() < -REVERSED_mm:
            return f"pressed, its displacement falls to {deepest.min():.1f} mm instead of rising"
        return str(error)
    assert press.sensed_mm is not None
    low_mm, high_mm = float(press.sensed_mm.min()), float(press.sensed_mm.max())
    if low_mm < -REVERSED_mm:
        return f"pressed, its displacement falls to {low_mm:.1f} mm instead of rising"
    if high_mm < DEEP_RATIO * _travel_mm(device):
        return f"a press on a travel of {_travel_mm(device):g} mm went to {high_mm:.2f} mm only"
    return ""


def _force_sensor(device: Remote) -> str:
    if not device.settings().force_gain_q14:
        return ""
    device.upload(plain_surface(_force_cN(device), _travel_mm(device)), _travel_mm(device))
    press = device.press(SPEED_mm_s)
    assert press.sensed_cN is not None
    assert press.sensed_mm is not None
    travel_mm = _travel_mm(device)
    inside = (press.sensed_mm > 0.25 * travel_mm) & (press.sensed_mm < 0.75 * travel_mm)
    if not inside.any():
        return "no record of a press came"
    middle_cN = float(np.median(press.sensed_cN[inside]))
    if middle_cN < -LEAST_cN:
        return f"half pressed, it reads {middle_cN:.0f} cN: the finger would pull"
    return f"half pressed, it reads {middle_cN:.1f} cN only" if middle_cN < LEAST_cN else ""


LINE = "bytes are lost or damaged, or a reply takes longer than 0.1 s: look at the line and the link's loop"
OF_A_PRESS = (
    Check(
        "a press goes down and comes back",
        "look at the sign of position_gain_q14, at position_offset_um16, and at who presses",
        _goes_down,
    ),
    Check(
        "the force sensor feels the finger",
        "look at the sign of force_gain_q14, at the sensor's wires and at force_offset_counts",
        _force_sensor,
    ),
)
CHECKS = (
    Check("requests are answered", LINE, _answers),
    Check(
        "a reply has the number of its request",
        "copy the sequence byte of the request into the reply",
        _sequence,
    ),
    Check("a damaged frame is left out", "compare the CRC-16 (docs/reference/protocol.md)", _damaged),
    Check("an unknown message is refused", "answer it with REFUSED, UNKNOWN_MESSAGE", _unknown),
    Check("the clock counts microseconds", "look at the timer behind device_us", _clock),
    Check("settings are kept as written", "store the record whole and answer READ_SETTINGS with it", _stored),
    Check("settings at odds are refused", "check the record with fdvv_settings_check", _at_odds),
    Check("settings cannot loosen the board's limits", "check them against the board's limits", _looser),
    Check("a damaged program is refused", "check its CRC-32 at COMMIT", _damaged_image),
    Check("a program beyond the limits is refused", "check it with fdvv_image_check at COMMIT", _too_strong),
    Check("idle, it commands no force", "command duty only while armed", _idle),
    Check("every tick is reported", "look at the period of the loop and at the room for telemetry", _ticks),
    Check("armed, it commands what the table asks", "look up the table at the sensed displacement", _renders),
    Check(
        "armed, the cap comes up to 0 mm",
        "look at position_offset_um16, at the motor's direction (wires exchanged?) and the sensor's wires",
        _rests,
    ),
    Check("disarmed, it lets go at once", "take the duty to 0 in the tick of DISARM", _lets_go),
    Check("a silent host ends the force", "watch host_timeout_ms since the last request", _silence),
    *OF_A_PRESS,
)
"""In an order in which what a rule needs was checked before."""

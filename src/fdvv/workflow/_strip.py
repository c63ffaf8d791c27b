"""The pointing task on an LED strip: rounds there, scores here, and a trial of an optimisation between."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager

from fdvv.device import KeyLine, RefusedError, Remote, StripResult, StripRound, StripStart, StripTask
from fdvv.errors import DeviceError, InputError
from fdvv.optimize import TaskPress, TemporalPointing, Trial, TrialState
from fdvv.program import Limits, compile_button
from fdvv.protocol import Fault, StripLed
from fdvv.workflow._optimize_session import OptimizeSession

LATE_s = 0.002
"""A bullet so late is not where the task says: a fifth of the time it takes for a pixel at 100 px/s."""
LIGHTS = ((255, 0, 0), (0, 255, 0), (0, 0, 255))
LIGHT_PX = 3
LIGHT_s, GLANCE_s = 0.8, 0.1

Presser = Callable[[int, StripStart], None]
"""Told of a round's number and times as it begins; lets a key be pressed where no person does."""
Heard = Callable[[int, TaskPress], None]
"""Told of a round's number and press when it is over."""


def strip_round(task: TemporalPointing, led: StripLed = StripLed.EACH, brightness: int = 8) -> StripRound:
    """Give what a strip shows in a round of a task: its speed, length and zone, in whole pixels."""
    return StripRound(
        round(task.speed_px_s),
        pixels=round(task.strip_px),
        zone_px=round(task.target_px),
        zone_half_px=int(task.zone_px // 2),
        brightness=brightness,
        led=led,
    )


def play_on_strip(
    strip: StripTask,
    task: TemporalPointing,
    seed: int,
    *,
    order: StripRound | None = None,
    presser: Presser | None = None,
    meanwhile: Callable[[], None] | None = None,
    heard: Heard | None = None,
) -> tuple[TaskPress, ...]:
    """Play a task's rounds on a strip, and give its presses on the strip's clock.

    order : what a round shows, strip_round(task) unless told. Start delays are drawn from seed and the
        round's number. presser : presses in a person's place. meanwhile : called some times a second while a
        round goes on. DeviceError if the strip fails, or does not show the bullet in time.
    """
    order = order or strip_round(task)
    return tuple(
        _round(strip, order.drawn(seed, number), number, presser, meanwhile, heard)
        for number in range(task.rounds)
    )


def _round(
    strip: StripTask,
    order: StripRound,
    number: int,
    presser: Presser | None,
    meanwhile: Callable[[], None] | None,
    heard: Heard | None,
) -> TaskPress:
    start = strip.begin(order)
    if presser:
        presser(number, start)
    press = press_of(strip, strip.wait(start, meanwhile))
    if heard:
        heard(number, press)
    return press


def press_of(strip: StripTask, result: StripResult) -> TaskPress:
    """Turn a round into a press of a task. DeviceError if the round was not shown as the task says."""
    name = strip.port.name
    if not result.is_whole:
        raise DeviceError(f"{name}: the strip heard nothing for too long and went dark; play the round again")
    if result.late_s > LATE_s:
        late_ms = 1e3 * result.late_s
        raise DeviceError(f"{name}: the bullet was shown {late_ms:.1f} ms late; the round does not count")
    return TaskPress(result.target_s, result.activations_s)


def played_presser(line: KeyLine, presses: Sequence[TaskPress]) -> Presser:
    """Let a key line repeat presses that somebody made elsewhere, such as `play`'s; simulated.

    Each round's keys go down as long before or after its target as in the press of that number.
    """

    def press(number: int, start: StripStart) -> None:
        target_s = presses[number].target_s
        assert target_s is not None, "temporal pointing sets a time"
        for at_s in presses[number].activations_s:
            line.press_at(start.target_s + at_s - target_s)

    return press


def try_on_strip(
    session: OptimizeSession,
    trial: Trial,
    device: Remote,
    strip: StripTask,
    task: TemporalPointing,
    *,
    order: StripRound | None = None,
    presser: Presser | None = None,
    heard: Heard | None = None,
) -> Trial:
    """Have a trial's design rendered by a device and played on a strip; give the trial as it then stands.

    A design that the device does not take is failed. If one of the two fails, the trial is abandoned and the
    DeviceError raised. Start delays follow from the session's seed and the trial's number.
    """
    seed = session.setup.seed + trial.number
    try:
        image = compile_button(session.model(trial.design), limits=Limits(device.settings())).image
        device.upload_program(image)
    except (InputError, RefusedError) as error:
        return session.fail(trial.number, str(error))
    if trial.state is TrialState.SUGGESTED:  # or it was shown when a run before this one was killed
        session.show(trial.number)
    try:
        with rendering(device) as feed:
            presses = play_on_strip(
                strip, task, seed, order=order, presser=presser, meanwhile=feed, heard=heard
            )
    except DeviceError as error:
        session.abandon(trial.number, str(error))
        raise
    return session.done(trial.number, task.scores(presses))


@contextmanager
def rendering(device: Remote) -> Iterator[Callable[[], None]]:
    """Render a device's active program, and give what is to be called some times a second so that it goes on.

    That raises DeviceError where the device fell to zero force.
    """

    def feed() -> None:
        if device.client.ping().fault != Fault.NONE:
            raise DeviceError(
                f"{device.client.port.name}: fell to zero force, {device.fault()}; clear the fault"
            )

    device.client.arm()
    try:
        yield feed
    finally:
        device.stop()


def light_strip(
    strip: StripTask, pixels: int, brightness: int = 8, meanwhile: Callable[[], None] | None = None
) -> None:
    """Light the first pixels red, the middle ones green, the last ones blue, one after the other."""
    for at, colour in zip((0, pixels // 2, pixels - LIGHT_PX), LIGHTS, strict=True):
        strip.show(at, LIGHT_PX, colour, brightness)
        until_s = strip.port.now_s() + LIGHT_s
        while strip.port.now_s() < until_s:
            strip.status()  # or it goes dark
            if meanwhile:
                meanwhile()
            strip.port.read(strip.port.now_s() + GLANCE_s)
    strip.stop()

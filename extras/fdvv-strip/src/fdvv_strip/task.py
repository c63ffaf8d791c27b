"""The rounds of the pointing task: shown on an LED strip, returned as presses of a task."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from fdvv.errors import DeviceError
from fdvv_people.task.pointing import TemporalPointing
from fdvv_people.task.task import TaskPress
from fdvv_strip.board import KeyLine, LedPointingTask, StripResult, StripRound, StripStart
from fdvv_strip.tables import StripLed

LATE_s = 0.002
"""A bullet so late is not where the task says: a fifth of the time it takes for a pixel at 100 px/s."""
Presser = Callable[[int, StripStart], None]
"""Called with a round's number and times as it begins; lets a key be pressed where no person does."""
Heard = Callable[[int, TaskPress], None]
"""Called with a round's number and press when it is over."""


def strip_round(task: TemporalPointing, led: StripLed = StripLed.EACH, brightness: int = 8) -> StripRound:
    """Return what a strip shows in a round of a task: its speed, length and zone, in whole pixels."""
    return StripRound(
        round(task.speed_px_s),
        pixels=round(task.strip_px),
        zone_px=round(task.target_px),
        zone_half_px=int(task.zone_px // 2),
        brightness=brightness,
        led=led,
    )


def play_on_strip(
    strip: LedPointingTask,
    task: TemporalPointing,
    seed: int,
    *,
    order: StripRound | None = None,
    presser: Presser | None = None,
    meanwhile: Callable[[], None] | None = None,
    heard: Heard | None = None,
) -> tuple[TaskPress, ...]:
    """Run a task's rounds on a strip; return its presses on the strip's clock.

    order : what a round shows, strip_round(task) by default. Start delays are drawn from seed and the
        round's number. presser : presses in a person's place. meanwhile : called some times a second while a
        round goes on. DeviceError if the strip fails, or does not show the bullet in time.
    """
    order, presses = order or strip_round(task), list[TaskPress]()
    for number in range(task.rounds):
        start = strip.begin(order.drawn(seed, number))
        if presser:
            presser(number, start)
        presses.append(press_of(strip, strip.wait(start, meanwhile)))
        if heard:
            heard(number, presses[-1])
    return tuple(presses)


def press_of(strip: LedPointingTask, result: StripResult) -> TaskPress:
    """Turn a round into a press of a task. Raises DeviceError if the round was not shown as the task says."""
    name = strip.port.name
    if not result.is_whole:
        raise DeviceError(f"{name}: the strip heard nothing for too long and went dark; play the round again")
    if result.late_s > LATE_s:
        late_ms = 1e3 * result.late_s
        raise DeviceError(f"{name}: the bullet was shown {late_ms:.1f} ms late; the round does not count")
    return TaskPress(result.target_s, result.activations_s)


def played_presser(line: KeyLine, presses: Sequence[TaskPress]) -> Presser:
    """Return a presser that repeats presses made elsewhere, as by `simulate_task`; simulated.

    Each round's keys go down as long before or after its target as in the press of that number.
    """

    def press(number: int, start: StripStart) -> None:
        target_s = presses[number].target_s
        assert target_s is not None, "temporal pointing sets a time"
        for at_s in presses[number].activations_s:
            line.press_at(start.target_s + at_s - target_s)

    return press

"""A check of an LED strip: its lights, then rounds with the key."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from fdvv_people.task.pointing import TemporalPointing
from fdvv_people.task.task import TaskPress
from fdvv_strip.board import LedPointingTask
from fdvv_strip.library import LibraryStrip, strip_port
from fdvv_strip.tables import StripLed
from fdvv_strip.task import Heard, play_on_strip, played_presser, strip_round

LIGHTS = ((255, 0, 0), (0, 255, 0), (0, 0, 255))
LIGHT_PX = 3
LIGHT_s, GLANCE_s = 0.8, 0.1
SCRIPTED_LATE_s = 0.08
"""How late the key of a strip without hardware goes down: nobody is there to press it."""


@dataclass(frozen=True)
class StripCheck:
    """What a check found.

    Attributes
    ----------
    name : of the line. simulated : there is no strip, and a script pressed.
    firmware : version. was_reset : the board's watchdog had reset it.
    edges : of the key line since the check began. bad_frames : requests that arrived damaged.
    presses : by round. asynchrony_ms : mean of their first presses' distances from the target, None without.
    """

    name: str
    simulated: bool
    firmware: str
    was_reset: bool
    edges: int
    bad_frames: int
    presses: tuple[TaskPress, ...]
    asynchrony_ms: float | None


def light_strip(
    strip: LedPointingTask, pixels: int, brightness: int = 8, meanwhile: Callable[[], None] | None = None
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


def check_strip(
    spec: str,
    level: str = "easy",
    rounds: int = 3,
    seed: int = 0,
    led: str = "each",
    brightness: int = 8,
    heard: Heard | None = None,
    meanwhile: Callable[[], None] | None = None,
) -> StripCheck:
    """Light a strip's ends and middle, then play rounds at a level.

    spec : of the strip (fdvv_strip.library.STRIPS). led : "each" or "together". meanwhile : called
        some times a second. Raises InputError, DeviceError.
    """
    task, port = TemporalPointing(level, rounds, quantised=False), strip_port(spec)
    order = strip_round(task, StripLed[led.upper()], brightness)
    scripted = [TaskPress(0.0, (SCRIPTED_LATE_s,))] * rounds
    presser = played_presser(port, scripted) if isinstance(port, LibraryStrip) else None
    with LedPointingTask(port) as strip:
        before = strip.status()
        light_strip(strip, order.pixels, brightness, meanwhile)
        presses = play_on_strip(
            strip, task, seed, order=order, presser=presser, meanwhile=meanwhile, heard=heard
        )
        after = strip.status()
        pressed = [press for press in presses if press.activations_s]
        return StripCheck(
            port.name,
            presser is not None,
            strip.firmware,
            strip.was_reset,
            after.edges - before.edges,
            after.bad_frames - before.bad_frames,
            presses,
            task.scores(pressed)["asynchrony_ms"].value if pressed else None,
        )

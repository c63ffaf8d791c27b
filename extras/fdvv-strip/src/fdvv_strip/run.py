"""The pointing task on an LED strip: rounds there, scores here, and a trial of an optimisation between."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass

from fdvv.device.remote import Remote
from fdvv.device.wire import RefusedError
from fdvv.errors import DeviceError, InputError
from fdvv.optimize.people.simulate import simulate_task
from fdvv.optimize.problem import Trial, TrialState
from fdvv.optimize.run.player import POINTING, play_seed, player_of
from fdvv.optimize.run.session import Optimization
from fdvv.optimize.tasks import TaskPress, TemporalPointing
from fdvv.program.button import compile_button
from fdvv.program.surface import Limits
from fdvv.protocol.tables import Fault
from fdvv_strip.board import KeyLine, LedPointingTask, StripResult, StripRound, StripStart
from fdvv_strip.library import LibraryStrip, open_strip, strip_port
from fdvv_strip.tables import StripLed

LATE_s = 0.002
"""A bullet so late is not where the task says: a fifth of the time it takes for a pixel at 100 px/s."""
LIGHTS = ((255, 0, 0), (0, 255, 0), (0, 0, 255))
LIGHT_PX = 3
LIGHT_s, GLANCE_s = 0.8, 0.1
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


def try_on_strip(
    session: Optimization,
    trial: Trial,
    device: Remote,
    strip: LedPointingTask,
    task: TemporalPointing,
    presser: Presser | None = None,
) -> Trial:
    """Render a trial's design on a device, run its rounds on a strip and return the trial as recorded.

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
            presses = play_on_strip(strip, task, seed, presser=presser, meanwhile=feed)
    except DeviceError as error:
        session.abandon(trial.number, str(error))
        raise
    return session.done(trial.number, task.scores(presses))


@contextmanager
def rendering(device: Remote) -> Iterator[Callable[[], None]]:
    """Render a device's active program, and yield what keeps it rendering if called some times a second.

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


def run_on_strip(
    session: Optimization,
    device: Remote,
    strip: LedPointingTask,
    *,
    rounds: int = TemporalPointing.rounds,
    ready: Callable[[Trial], None] | None = None,
    presser: Presser | None = None,
) -> Iterator[Trial]:
    """Play trial after trial on rig and strip until the budget is spent; return each as it then stands.

    Stop between two, or kill the process at any moment: the session continues where it was. ready : called
    before each, such as to wait for the person. The strip's clock tells more than whole frames, so scores are
    not quantised. Raises InputError if the session is about another task, DeviceError if rig or strip fail.
    """
    task = _task(session, rounds)
    while asked := session.ask():
        (trial,) = asked
        if ready:
            ready(trial)
        yield try_on_strip(session, trial, device, strip, task, presser)


def run_on_any_strip(
    session: Optimization, device: Remote, strip: LedPointingTask, ready: Callable[[Trial], None]
) -> Iterator[Trial]:
    """Play trial after trial on a strip that is there, or on ``host``, see run_on_strip.

    On ``host`` nobody sees a bullet: the simulated person of the run presses, InputError where it names none.
    """
    port = strip.port
    if not isinstance(port, LibraryStrip):
        yield from run_on_strip(session, device, strip, rounds=session.setup.presses, ready=ready)
        return
    player = player_of(session.setup)
    task, presses = _task(session, player.task.rounds), list[TaskPress]()

    def sit_down(trial: Trial) -> None:
        # the presser reads the list at each round: it finds there the presses of the trial that goes on
        seed = play_seed(player.seed, trial.number)
        presses[:] = simulate_task(task, session.model(trial.design), player.user, seed)

    presser = played_presser(port, presses)
    yield from run_on_strip(session, device, strip, rounds=task.rounds, ready=sit_down, presser=presser)


@contextmanager
def present_on_strip(
    spec: str, device: Remote, ready: Callable[[Trial], None]
) -> Iterator[Callable[[Optimization], Iterator[Trial]]]:
    """Open the strip that spec names (STRIPS); yield what plays a session there, see run_on_any_strip.

    What ``fdvv optimize`` finds by its entry point. Raises InputError, DeviceError.
    """
    with open_strip(spec) as strip:
        yield lambda session: run_on_any_strip(session, device, strip, ready)


def _task(session: Optimization, rounds: int) -> TemporalPointing:
    setup = session.setup
    if setup.task != POINTING or setup.level is None:
        reason = f"{setup.task}, level {setup.level} is not for a strip"
        raise InputError(session.folder, "task", reason, f"begin one of {POINTING} with a level")
    return TemporalPointing(setup.level, rounds, quantised=False)


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

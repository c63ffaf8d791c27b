"""Trials of an optimisation: designs rendered on a rig, played on an LED strip."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager

from fdvv.device.remote import Remote
from fdvv.device.wire import RefusedError
from fdvv.errors import DeviceError, InputError
from fdvv.program.button import compile_button
from fdvv.program.surface import Limits
from fdvv.protocol.tables import Fault
from fdvv_people.optimize.people.simulate import simulate_task
from fdvv_people.optimize.problem import Trial, TrialState
from fdvv_people.optimize.run.player import POINTING, play_seed, player_of
from fdvv_people.optimize.run.session import Optimization
from fdvv_people.task.pointing import TemporalPointing
from fdvv_people.task.task import TaskPress
from fdvv_strip.board import LedPointingTask
from fdvv_strip.library import LibraryStrip, open_strip
from fdvv_strip.task import Presser, play_on_strip, played_presser


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
        image = compile_button(session.button(trial), limits=Limits(device.settings())).image
        device.upload_program(image)
    except (InputError, RefusedError) as error:
        return session.give_up(trial.number, str(error))
    if trial.state is TrialState.SUGGESTED:  # or it was shown when a run before this one was killed
        session.show(trial.number)
    try:
        with rendering(device) as feed:
            presses = play_on_strip(strip, task, seed, presser=presser, meanwhile=feed)
    except DeviceError as error:
        session.give_up(trial.number, str(error), failed=False)
        raise
    return session.answer(trial.number, task.scores(presses))


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


def run_on_strip(
    session: Optimization,
    device: Remote,
    strip: LedPointingTask,
    *,
    rounds: int = TemporalPointing.rounds,
    ready: Callable[[Trial], None] | None = None,
    presser: Presser | None = None,
) -> Iterator[Trial]:
    """Play trial after trial on rig and strip until the run is over; return each as it then stands.

    Stop between two, or kill the process at any moment: the session continues where it was. ready : called
    before each, such as to wait for the person. The strip's clock tells more than whole frames, so scores are
    not quantised. Raises InputError if the session is about another task, DeviceError if rig or strip fail.
    """
    task = _task(session, rounds)
    while trial := next(iter(session.ask()), None):
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
        presses[:] = simulate_task(task, session.button(trial), player.user, seed)

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
    return TemporalPointing(setup.level, rounds, quantised=False, also=setup.task_also)

"""An optimisation whose trials a person plays on an LED strip."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from fdvv.device import LibraryStrip, Remote, StripRound, StripStart, StripTask
from fdvv.errors import InputError
from fdvv.optimize import TaskPress, TemporalPointing, Trial
from fdvv.workflow._optimize_player import play_seed, player_of
from fdvv.workflow._optimize_session import OptimizeSession
from fdvv.workflow._play import play
from fdvv.workflow._strip import Heard, Presser, played_presser, try_on_strip

TASK = "temporal-pointing"


def run_on_strip(
    session: OptimizeSession,
    device: Remote,
    strip: StripTask,
    *,
    rounds: int = TemporalPointing.rounds,
    order: StripRound | None = None,
    ready: Callable[[Trial], None] | None = None,
    presser: Presser | None = None,
    heard: Heard | None = None,
) -> Iterator[Trial]:
    """Play trial after trial on rig and strip until the budget is spent; give each as it then stands.

    Stop between two, or kill the process at any moment: the session goes on where it was. ready : called
    before each, such as to wait for the person. The strip's clock tells more than whole frames, so scores are
    not quantised. Raises InputError if the session is about another task, DeviceError if rig or strip fail.
    """
    task = _task(session, rounds)
    while asked := session.ask():
        (trial,) = asked
        if ready:
            ready(trial)
        yield try_on_strip(session, trial, device, strip, task, order=order, presser=presser, heard=heard)


def run_on_any_strip(
    session: OptimizeSession, device: Remote, strip: StripTask, ready: Callable[[Trial], None]
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
        seed = play_seed(player.seed, trial.number)
        presses[:] = play(task, session.model(trial.design), player.user, seed)

    def press(number: int, start: StripStart) -> None:
        played_presser(port, presses)(number, start)

    yield from run_on_strip(session, device, strip, rounds=task.rounds, ready=sit_down, presser=press)


def _task(session: OptimizeSession, rounds: int) -> TemporalPointing:
    setup = session.setup
    if setup.task != TASK or setup.level is None:
        reason = f"{setup.task}, level {setup.level} is not for a strip"
        raise InputError(session.folder, "task", reason, f"begin one of {TASK} with a level")
    return TemporalPointing(setup.level, rounds, quantised=False)
